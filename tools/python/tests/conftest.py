"""What the tests share: made-up lists, and the command-line tool where it is built."""

import json
import os
import shutil
import subprocess

import pytest

BEGIN = 1_600_000_000_000_000_000
STEP = 100_000_000


def rock(identity=7, **more):
    return {
        "id": identity,
        "kind": "positive",
        "confidence": 0.9,
        "center": [5.0, 1.0, 0.25],
        "extent": [1.0, 0.8, 0.5],
        "yaw": 0.3,
        "height": 0.5,
        "velocity": [0, 0],
        "points": 50,
        **more,
    }


def line(number, obstacles, pose=None):
    pose = pose or {"p": [0.1 * number, 0, 0], "q": [1, 0, 0, 0]}
    return {"stamp_ns": BEGIN + number * STEP, "pose": pose, "obstacles": obstacles}


@pytest.fixture
def lists(tmp_path):
    """Ten lists with a rock, five with a hole too, one line of health."""
    hole = rock(
        9,
        kind="negative",
        height=-0.4,
        evidence="inside",
        velocity=[1.0, 0.0],
        footprint=[[2, 0], [3, 0], [3, 1]],
    )
    rows = [line(n, [rock(), hole] if n >= 5 else [rock()]) for n in range(10)]
    rows.insert(
        3,
        {
            "stamp_ns": BEGIN + 3 * STEP,
            "health": "ok",
            "reason": "",
            "stop": False,
            "lidar": {"state": "ok", "rate": 754.0, "lost": 2},
            "latency": {"p50_ms": 40.0, "p99_ms": 61.5},
        },
    )
    file = tmp_path / "lists.jsonl"
    file.write_text("".join(json.dumps(row) + "\n" for row in rows))
    return file


@pytest.fixture(scope="session")
def scree_program():
    program = shutil.which(os.environ.get("SCREE", "scree"))
    if program is None:
        pytest.skip("there is no program scree: set SCREE")
    return program


@pytest.fixture(scope="session")
def capture(scree_program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("drive") / "capture"
    subprocess.run([scree_program, "simulate", folder, "--seconds", "3", "--scene", "easy"], check=True)
    return folder
