import json
import math

import pytest

from conftest import BEGIN, STEP, line, rock
from scree import Pose
from scree.read import ReadError, read
from scree.records import grid_of_json, list_of_json


def test_a_pose_is_applied_and_undone():
    half = math.sqrt(0.5)
    pose = Pose((10, 5, 1), (half, 0, 0, half))  # a quarter turn to the left
    assert pose.yaw == pytest.approx(math.pi / 2)
    assert pose.apply((2, 0, 0)) == pytest.approx((10, 7, 1))
    assert pose.unapply((10, 7, 1)) == pytest.approx((2, 0, 0))


def test_obstacles_are_seen_from_the_robot():
    half = math.sqrt(0.5)
    pose = {"p": [10, 5, 0], "q": [half, 0, 0, half]}
    walker = rock(center=[10, 8, 0.2], yaw=0.2, velocity=[0, 1], footprint=[[9, 8], [11, 8], [10, 9]])
    (seen,) = list_of_json(line(0, [walker], pose)).in_base()
    assert seen.center == pytest.approx((3, 0, 0.2))
    assert seen.velocity == pytest.approx((1, 0))
    assert seen.yaw == pytest.approx(0.2 - math.pi / 2)
    assert seen.footprint[0] == pytest.approx((3, 1))


def test_the_box_stands_for_a_missing_footprint():
    (it,) = list_of_json(line(0, [rock(yaw=0)])).obstacles
    assert sorted((round(x, 6), round(y, 6)) for x, y in it.outline()) == [
        (4.5, 0.6),
        (4.5, 1.4),
        (5.5, 0.6),
        (5.5, 1.4),
    ]


def test_a_grid_is_read_cell_by_cell():
    json_grid = {
        "stamp_ns": 1,
        "pose": {"p": [0, 0, 0], "q": [1, 0, 0, 0]},
        "origin": [0, 0],
        "cell_size": 0.2,
        "columns": 3,
        "rows": 2,
        "states": ["2?.", "#v?"],
        "ground": [5, -3, -40],
    }
    grid = grid_of_json(json_grid)
    assert grid.state == bytes([0, 0, 1, 2, 3, 0])
    assert grid.ground == (None, None, 5, -3, -40, None)
    with pytest.raises(ValueError, match="cells"):
        grid_of_json({**json_grid, "rows": 3})


def test_lines_are_read_in_order(lists):
    records = list(read(lists))
    assert [type(record).__name__ for record in records].count("ObstacleList") == 10
    assert records[3]["lidar"]["rate"] == 754
    assert records[-1].stamp_ns == BEGIN + 9 * STEP


def test_what_cannot_be_read_names_file_and_line(tmp_path):
    bad = tmp_path / "bad.jsonl"
    bad.write_text(json.dumps(line(0, [])) + "\n{\n")
    with pytest.raises(ReadError, match=r"bad\.jsonl:2"):
        list(read(bad))
    with pytest.raises(ReadError, match="there is no"):
        list(read(tmp_path / "gone.jsonl"))


def test_a_capture_is_run_through_the_pipeline(capture, scree_program):
    records = list(read(capture, scree_program))
    kinds = [type(record).__name__ for record in records]
    assert kinds.count("ObstacleList") >= 29
    assert kinds.count("Grid") >= 25
    assert [record.stamp_ns for record in records] == sorted(record.stamp_ns for record in records)
