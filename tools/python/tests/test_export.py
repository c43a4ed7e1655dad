import json

import pytest

from conftest import BEGIN, STEP
from scree.commands import main
from scree.read import read
from scree.records import Grid, ObstacleList

pytest.importorskip("foxglove")
mcap_reader = pytest.importorskip("mcap.reader")
pq = pytest.importorskip("pyarrow.parquet")


def messages_of(file):
    """By topic: schema, times, raw messages."""
    topics = {}
    with file.open("rb") as stream:
        for schema, channel, message in mcap_reader.make_reader(stream).iter_messages():
            topics.setdefault(channel.topic, (schema.name, [], []))
            topics[channel.topic][1].append(message.log_time)
            topics[channel.topic][2].append(message.data)
    return topics


def test_lists_become_scenes(lists, tmp_path, capsys):
    out = tmp_path / "drive.mcap"
    assert main(["export", str(lists), "--mcap", str(out)]) == 0
    assert "10 lists" in capsys.readouterr().out
    topics = messages_of(out)
    assert {topic: it[0] for topic, it in topics.items()} == {
        "/obstacles": "foxglove.SceneUpdate",
        "/tf": "foxglove.FrameTransforms",
        "/health": "scree.health",
    }
    assert topics["/obstacles"][1] == [BEGIN + n * STEP for n in range(10)]
    assert b"9: -0.40" in topics["/obstacles"][2][5]
    assert b"9: -0.40" not in topics["/obstacles"][2][4]
    assert json.loads(topics["/health"][2][0])["lidar"]["rate"] == 754


def test_a_capture_becomes_clouds_grids_and_poses(capture, scree_program, tmp_path):
    out = tmp_path / "drive.mcap"
    assert main(["export", str(capture), "--mcap", str(out), "--scree", scree_program]) == 0
    topics = messages_of(out)
    records = list(read(capture, scree_program))
    stamps = [it.stamp_ns for it in records if isinstance(it, ObstacleList)]
    assert topics["/obstacles"][1] == stamps
    assert topics["/lidar"][0] == "foxglove.PointCloud"
    assert topics["/lidar"][1] == stamps
    assert topics["/grid"][1] == [it.stamp_ns for it in records if isinstance(it, Grid)]
    # A turn of the simulated lidar has about 13,000 returns of 16 bytes.
    sizes = [len(data) for data in topics["/lidar"][2]]
    assert min(sizes[1:-1]) > 16 * 5_000
    assert len(topics["/tf"][1]) == len(stamps) + 1  # and the lidar's mount


def test_rerun_reads_it(capture, scree_program, tmp_path):
    rerun = pytest.importorskip("rerun")
    out, there = tmp_path / "drive.mcap", tmp_path / "drive.rrd"
    assert main(["export", str(capture), "--mcap", str(out), "--scree", scree_program]) == 0
    rerun.init("scree", spawn=False)
    rerun.save(str(there))
    rerun.log_file_from_path(str(out))
    rerun.disconnect()
    assert there.stat().st_size > 100_000


def test_tables_have_every_obstacle(lists, tmp_path):
    folder = tmp_path / "tables"
    assert main(["export", str(lists), "--parquet", str(folder)]) == 0
    table = {
        name: pq.read_table(folder / f"{name}.parquet").to_pylist()
        for name in ("lists", "obstacles", "tracks", "health")
    }
    assert [row["obstacles"] for row in table["lists"]] == [1] * 5 + [2] * 5
    assert len(table["obstacles"]) == 15
    rocks = [row for row in table["obstacles"] if row["id"] == 7]
    assert rocks[2]["distance"] == pytest.approx((4.8**2 + 1) ** 0.5)
    tracks = {row["id"]: row for row in table["tracks"]}
    assert (tracks[9]["lists"], tracks[9]["positive"], tracks[9]["moves"]) == (5, False, True)
    assert tracks[9]["first_ns"] == BEGIN + 5 * STEP
    assert tracks[7]["nearest"] == pytest.approx((4.1**2 + 1) ** 0.5)
    assert table["health"][0]["latency_p99_ms"] == 61.5


def test_nothing_is_overwritten_and_faults_are_one_sentence(lists, tmp_path, capsys):
    out = tmp_path / "drive.mcap"
    assert main(["export", str(lists), "--mcap", str(out)]) == 0
    assert main(["export", str(lists), "--mcap", str(out)]) == 1
    assert "--force" in capsys.readouterr().err
    assert main(["export", str(lists), "--mcap", str(out), "--force"]) == 0
    assert main(["export", str(lists)]) == 1
    empty = tmp_path / "empty.jsonl"
    empty.write_text("")
    assert main(["export", str(empty), "--parquet", str(tmp_path / "none")]) == 1
    assert "holds neither" in capsys.readouterr().err
