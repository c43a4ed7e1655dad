import json
import shutil

import pytest

from conftest import BEGIN, STEP, line, rock
from scree.commands import main
from scree.read import read
from scree.records import Grid, ObstacleList

pytest.importorskip("foxglove")
mcap_reader = pytest.importorskip("mcap.reader")
from scree.mcap_export import mount_of  # noqa: E402

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
    with pytest.raises(SystemExit, match="2"):
        main(["export", str(lists)])
    empty = tmp_path / "empty.jsonl"
    empty.write_text("")
    assert main(["export", str(empty), "--parquet", str(tmp_path / "none")]) == 1
    assert "holds neither" in capsys.readouterr().err


@pytest.mark.parametrize(
    "wrong",
    [
        b"\xff",
        b"[]",
        b"7",
        b'{"health": "ok"}',
        b'{"health": "ok", "stamp_ns": -1}',
        json.dumps(line(0, [])).replace(str(BEGIN), "1e999").encode(),
        json.dumps(line(0, []) | {"stamp_ns": 2**62}).encode(),
        json.dumps(line(0, [rock(float("inf"))])).encode(),
        b'{"stamp_ns": 1, "states": ["#"], "columns": 1, "rows": 1, "ground": []}',
    ],
)
def test_a_wrong_line_is_named_and_leaves_nothing(wrong, lists, tmp_path, capsys):
    lists.write_bytes(lists.read_bytes() + wrong + b"\n")
    out = tmp_path / "out"
    out.mkdir()
    for target in (["--mcap", str(out / "drive.mcap")], ["--parquet", str(out / "tables")]):
        assert main(["export", str(lists), *target]) == 1
        assert f"{lists}:12: neither list" in capsys.readouterr().err
    assert list(out.iterdir()) == []


def test_what_no_file_takes_is_one_sentence(tmp_path, capsys):
    lists = tmp_path / "lists.jsonl"
    lists.write_text(json.dumps(line(0, [rock(2**70)])))
    assert main(["export", str(lists), "--parquet", str(tmp_path / "tables")]) == 1
    assert "does not fit" in capsys.readouterr().err
    assert not (tmp_path / "tables").exists()


def test_a_place_that_cannot_be_written_is_named(lists, tmp_path, capsys):
    for target in (["--mcap", tmp_path / "none" / "drive.mcap"], ["--mcap", lists / "drive.mcap"],
                   ["--mcap", tmp_path], ["--parquet", lists / "tables"]):  # fmt: skip
        assert main(["export", str(lists), "--force", *map(str, target)]) == 1
        assert str(target[1]).removesuffix("/drive.mcap") in capsys.readouterr().err


def test_drop_ins_say_where_the_lidar_sits(capture, scree_program, tmp_path):
    drive = shutil.copytree(capture, tmp_path / "drive")
    (drive / "scree.d").mkdir()
    for name, x in (("b", 2.0), ("a", 1.0)):
        (drive / "scree.d" / f"{name}.toml").write_text(f"[lidar]\ntranslation = [{x}, 0.0, 0.0]\n")
    assert mount_of(drive, None, scree_program).p == (2, 0, 0)
    assert mount_of(capture, drive / "scree.toml", scree_program).p == (2, 0, 0)
    assert mount_of(capture / "lidar.pcap", None, scree_program).p == (0, 0, 0)
