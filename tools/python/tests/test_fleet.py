"""The engine is tried with a program that only pretends; that the numbers are right, with the real one."""

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from scree import fleet
from scree.fleet_commands import main

pq = pytest.importorskip("pyarrow.parquet")
distributed = pytest.importorskip("distributed")
from scree.fleet_run import run  # noqa: E402

PRETENDER = f"""#!{sys.executable}
import json, os, sys, time
if sys.argv[1] == "--version":
    print("9.9")
    sys.exit()
command, capture = sys.argv[1:3]
what = json.load(open(os.path.join(os.path.dirname(capture) if command == "evaluate" else capture, "what.json")))
with open(os.environ["LOOKED"], "a", errors="backslashreplace") as log:
    log.write(f"{{command}} {{capture}}\\n")
time.sleep(what.get("sleep", 0))
if command == what.get("fails"):
    print("scree: warning", file=sys.stderr)
    print("scree: it is broken", capture if what.get("names") else "", file=sys.stderr)
    sys.exit(1)
if command == "info":
    print(json.dumps({{"seconds": 5, "packets": 10, "lost": 1, "refused": {{}}, "sweeps": 2, "imu": None, "encoder": None}}))
elif command == "report":
    with open(sys.argv[sys.argv.index("--out") + 1], "w") as out:
        out.write(" ".join(sys.argv))
elif command == "detect":
    pose = {{"p": [0, 0, 0], "q": [1, 0, 0, 0]}}
    with open(sys.argv[sys.argv.index("--out") + 1], "w") as out:
        for n in range(3):
            out.write(json.dumps({{"stamp_ns": n * 10**8, "pose": pose, "obstacles": []}}) + "\\n")
else:
    right = what["right"]
    score = {{"true_positives": right, "false_positives": 10 - right, "false_negatives": 0, "precision": right / 10,
             "recall": 1.0, "f1": 2 * right / (10 + right)}}
    covered = what.get("covered", 1)
    print(json.dumps({{"coverage": covered, "counts": covered >= 0.95, "all": score, "positive": score, "negative": score}}))
    with open(sys.argv[sys.argv.index("--matches") + 1], "w") as out:
        out.write(json.dumps({{"run": 0, "stamp_ns": 0, "right": [[4, 7, 2.5]], "missed": [[5, 3.5]], "invented": [[8, 1.5]]}}))
"""


@pytest.fixture
def pretender(tmp_path, monkeypatch):
    program = tmp_path / "pretender"
    program.write_text(PRETENDER)
    program.chmod(0o755)
    monkeypatch.setenv("LOOKED", str(tmp_path / "looked"))
    return str(program)


def made_up(folder, number, **what):
    capture = folder / f"drive{number:03}"
    capture.mkdir(parents=True)
    (capture / "lidar.pcap").write_bytes(f"{number}".encode())
    (capture / "truth.json").write_text("{}")
    (capture / "what.json").write_text(json.dumps({"right": 5, **what}))
    return capture


def looked(tmp_path, command="detect"):
    file = tmp_path / "looked"
    lines = file.read_text().splitlines() if file.exists() else []
    return [line for line in lines if line.startswith(command)]


def test_a_row_has_what_the_programs_say(capture, scree_program, tmp_path):
    row = fleet.process(capture, tmp_path / "out", scree_program)
    assert row["ok"], row["reason"]
    lists = tmp_path / "lists.jsonl"
    subprocess.run([scree_program, "detect", capture, "--out", lists], check=True, capture_output=True)
    done = subprocess.run(
        [scree_program, "evaluate", capture / "truth.json", lists, "--json"], capture_output=True, check=True
    )
    score = json.loads(done.stdout)
    assert (row["f1"], row["true_positives"]) == (score["all"]["f1"], score["all"]["true_positives"])
    assert row["negative_recall"] == score["negative"]["recall"]
    assert row["lists"] == len(lists.read_text().splitlines())
    folder = tmp_path / "out" / "results" / row["key"]
    assert (folder / "lists.jsonl").read_bytes() == lists.read_bytes()
    counted = {"right": 0, "missed": 0, "invented": 0}
    for line in (folder / "matches.jsonl").read_text().splitlines():
        for name in counted:
            counted[name] += len(json.loads(line)[name])
    sums = [score["all"][name] for name in ("true_positives", "false_negatives", "false_positives")]
    assert list(counted.values()) == sums


def test_what_was_done_is_not_done_again_unless_something_changed(pretender, tmp_path):
    capture, out = made_up(tmp_path, 1), tmp_path / "out"
    first = fleet.process(capture, out, pretender)
    again = fleet.process(capture, out, pretender)
    assert (first["was_stored"], again["was_stored"]) == (False, True)
    assert len(looked(tmp_path)) == 1
    assert {**again, "was_stored": False} == first
    moved = capture.rename(tmp_path / "elsewhere")
    assert fleet.process(moved, out, pretender)["was_stored"]
    config = tmp_path / "other.toml"
    config.write_text("")
    assert not fleet.process(moved, out, pretender, config=config)["was_stored"]
    (moved / "lidar.pcap").write_bytes(b"other")
    assert not fleet.process(moved, out, pretender)["was_stored"]
    with open(pretender, "a") as program:
        program.write("# another version\n")
    os.utime(pretender, (1, 1))
    assert not fleet.process(moved, out, pretender)["was_stored"]
    assert len(list((out / "results").iterdir())) == 4


def test_a_failure_is_a_row(pretender, tmp_path):
    out = tmp_path / "out"
    broken = fleet.process(made_up(tmp_path, 1, fails="detect"), out, pretender)
    assert (broken["ok"], broken["reason"]) == (False, "it is broken")
    slow = fleet.process(made_up(tmp_path, 2, sleep=30), out, pretender, timeout=0.5)
    assert "longer than 0.5 s" in slow["reason"]
    assert not fleet.process(tmp_path / "gone", out, pretender)["ok"]
    assert "there is no program" in fleet.process(tmp_path / "gone", out, "/no/such/program")["reason"]
    (tmp_path / "file").write_text("")
    assert not fleet.process(made_up(tmp_path, 3), tmp_path / "file", pretender)["ok"]


def rows_and_page(tmp_path, captures, *arguments):
    """What the tables and the page have after a run over them."""
    out, page = tmp_path / "out", tmp_path / "page.html"
    assert main(["run", str(captures), "--out", str(out), "--workers", "1", *arguments]) == 0
    assert main(["report", str(out), str(page), "--force"]) == 0
    return pq.read_table(out / "captures.parquet").to_pylist(), page.read_text(encoding="utf-8")


def test_each_capture_has_its_own_row(pretender, tmp_path):
    drives = tmp_path / "drives"
    same = [made_up(drives / name, 1) for name in "ab"]
    broken = [made_up(drives / name, 2, fails="info", names=True) for name in "ab"]
    (drives / "empty").mkdir()
    names = [*same, *broken, drives / "empty", drives / "gone1", drives / "gone2"]
    (tmp_path / "list.txt").write_text("\n".join(map(str, names)))
    rows, page = rows_and_page(tmp_path, tmp_path / "list.txt", "--scree", pretender)
    assert [row["capture"] for row in rows] == list(map(str, names))
    assert [row["ok"] for row in rows] == [True] * 2 + [False] * 5
    for row in rows[2:]:
        assert row["capture"] in row["reason"]
        assert row["reason"] in page
    assert rows[0]["key"] == rows[1]["key"]
    assert len(pq.read_table(tmp_path / "out" / "lists.parquet")) == 3


def test_a_name_that_is_not_utf_8_is_a_row(pretender, tmp_path):
    drives = tmp_path / "drives"
    made_up(drives, 1)
    made_up(drives, 2).rename(drives / os.fsdecode(b"drive\xff"))
    rows, page = rows_and_page(tmp_path, drives, "--scree", pretender)
    assert [(Path(row["capture"]).name, row["ok"]) for row in rows] == [
        ("drive001", True),
        ("drive\\udcff", True),
    ]
    assert "drive\\udcff" in page


def test_scores_of_a_part_of_the_drive_do_not_count(pretender, tmp_path):
    drives = tmp_path / "drives"
    made_up(drives, 1, right=5)
    made_up(drives, 2, right=9, covered=0.9499)
    _, page = rows_and_page(tmp_path, drives, "--scree", pretender)
    assert "drive002</a><br>covers 94 % of the drive: does not count</td><td>–</td>" in page
    assert page.index("drive002</a>") < page.index("drive001</a>")
    assert "<b>0.667</b>F1 of all lists" in page
    assert page.count("<rect") - page.count('height="0.0"') == 1


def test_reports_are_of_the_run_and_their_links_lead_there(pretender, tmp_path):
    drives, config = made_up(tmp_path / "drives", 1).parent, tmp_path / "robot.toml"
    config.write_text("")
    out, page = tmp_path / "out", tmp_path / "what? 100%#.html"
    assert (
        main(
            [
                "run",
                str(drives),
                "--out",
                str(out),
                "--workers",
                "1",
                "--scree",
                pretender,
                "--config",
                str(config),
            ]
        )
        == 0
    )
    assert main(["report", str(out), str(page)]) == 0
    (report,) = (tmp_path / "what? 100%#_drives").iterdir()
    assert report.read_text().startswith(pretender)
    assert f"--config {config} --truth" in report.read_text()
    assert f'href="what%3F%20100%25%23_drives/{report.name}"' in page.read_text()
    report.unlink()
    (tmp_path / "robot.d").mkdir()
    (tmp_path / "robot.d" / "more.toml").write_text("")  # now it says something else
    assert main(["report", str(out), str(page), "--force"]) == 0
    assert "href" not in page.read_text()


def test_captures_are_what_the_contract_calls_so(tmp_path):
    drives, far = tmp_path / "drives", tmp_path / "far"
    folder, linked = made_up(drives, 1), made_up(far, 2)
    (folder / "imu.pcap").touch()
    (drives / "link").symlink_to(linked)
    (drives / "back").symlink_to(drives)
    single = drives / "single" / "morning.pcapng"
    single.parent.mkdir()
    single.touch()
    assert fleet.captures_in(drives) == sorted(map(str, (folder, linked, single)))
    assert fleet.captures_in(single) == [str(single)]


@pytest.mark.parametrize("wrong", ["--workers=0", "--timeout=0", "--timeout=nan", "--timeout=inf"])
def test_wrong_numbers_are_wrong_usage(wrong, tmp_path):
    with pytest.raises(SystemExit, match="2"):
        main(["run", str(tmp_path), "--out", str(tmp_path / "out"), wrong])
    with pytest.raises(SystemExit, match="2"):
        main(["report", str(tmp_path), "page.html", "--worst=0"])


def test_what_all_captures_need_is_missed_once(pretender, tmp_path, capsys):
    drives, out = made_up(tmp_path / "drives", 1).parent, tmp_path / "out"
    latin = tmp_path / "list.txt"
    latin.write_bytes(b"drive\xff")
    for captures, option, said in (
        (drives, "--config=gone.toml", "no configuration gone.toml"),
        (drives, "--scree=/bin/false", "/bin/false ended with 1"),
        (drives, "--scheduler=rubbish", "the scheduler rubbish cannot be reached"),
        (latin, "--workers=1", f"{latin} is no list of captures"),
    ):
        assert main(["run", str(captures), "--out", str(out), "--scree", pretender, option]) == 1
        assert said in capsys.readouterr().err


def test_a_failure_is_tried_again_where_that_is_asked_for(pretender, tmp_path):
    capture, out = made_up(tmp_path, 1, sleep=1), tmp_path / "out"
    assert not fleet.process(capture, out, pretender, timeout=0.1)["ok"]
    assert fleet.process(capture, out, pretender)["was_stored"]
    again = fleet.process(capture, out, pretender, retry_failed=True)
    assert (again["ok"], again["was_stored"]) == (True, False)
    assert fleet.process(capture, out, pretender)["ok"]


def test_two_at_once_leave_one_result(pretender, tmp_path):
    capture, out = made_up(tmp_path, 1, sleep=0.3), tmp_path / "out"
    with ThreadPoolExecutor(4) as pool:
        rows = list(pool.map(lambda _: fleet.process(capture, out, pretender), range(4)))
    assert all(row["ok"] for row in rows)
    assert [folder.name for folder in (out / "results").iterdir()] == [rows[0]["key"]]


def test_what_killed_workers_left_is_swept_up(tmp_path):
    old, fresh = tmp_path / "results" / ".abc-1", tmp_path / "results" / ".abc-2"
    for folder in (old, fresh):
        folder.mkdir(parents=True)
    os.utime(old, (1, 1))
    fleet.sweep_up(tmp_path)
    assert (old.exists(), fresh.exists()) == (False, True)


def test_any_engine_can_take_it(pretender):
    assert pickle.loads(pickle.dumps(fleet.process)) is fleet.process


def kill_one_worker(client, tmp_path):
    """As soon as some work is done."""
    while len(looked(tmp_path)) < 4:
        time.sleep(0.05)
    os.kill(next(iter(client.run(os.getpid).values())), signal.SIGKILL)


def test_a_killed_worker_loses_nothing_and_does_nothing_twice(pretender, tmp_path):
    captures = [str(made_up(tmp_path / "drives", number, sleep=0.1)) for number in range(24)]
    out = tmp_path / "out"
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        killer = threading.Thread(target=kill_one_worker, args=(client, tmp_path))
        killer.start()
        rows = run(captures, out, client=client, scree=pretender)
        killer.join()
    assert [row["capture"] for row in rows] == captures
    assert all(row["ok"] for row in rows)
    table = pq.read_table(out / "captures.parquet").to_pylist()
    assert sorted(row["capture"] for row in table) == captures
    assert len(pq.read_table(out / "lists.parquet")) == 3 * len(captures)
    # What the killed worker was at is looked at anew; all else once.
    assert len(captures) <= len(looked(tmp_path)) <= len(captures) + 2
    before = len(looked(tmp_path))
    assert all(row["was_stored"] for row in run(captures, out, workers=1, scree=pretender))
    assert len(looked(tmp_path)) == before


def test_tables_and_page_of_two_versions(pretender, tmp_path, capsys):
    drives, old, new = tmp_path / "drives", tmp_path / "old", tmp_path / "new"
    for number, right in enumerate((9, 3, 6)):
        made_up(drives, number, right=right)
    made_up(drives, 3, fails="info")
    arguments = ["--scree", pretender, "--workers", "1"]
    assert main(["run", str(drives), "--out", str(old), *arguments]) == 0
    assert "4 captures, 0 of them done before or of the same content, 1 failed" in capsys.readouterr().out
    alone = ["run", str(drives / "drive003"), "--out", str(tmp_path / "alone"), *arguments]
    assert main(alone) == 1  # all have failed
    matches = pq.read_table(old / "matches.parquet").to_pylist()
    assert [row["outcome"] for row in matches] == ["right", "missed", "invented"] * 3
    other = PRETENDER.replace('what["right"]', '{9: 6, 3: 4, 6: 6}[what["right"]]')
    Path(pretender).write_text(other)
    os.utime(pretender, (1, 1))
    assert main(["run", str(drives), "--out", str(new), *arguments]) == 0

    page = tmp_path / "page.html"
    assert main(["report", str(new), str(page), "--against", str(old), "--scree", pretender]) == 0
    text = page.read_text()
    assert "Better: 1 drives, worse: 1, the same: 1" in text
    worst_first = [text.rindex(f"drive00{number}</") for number in (3, 1, 2)]
    assert worst_first == sorted(worst_first)
    assert "failed: it is broken" in text
    assert main(["report", str(new), str(page)]) == 1
    assert main(["run", str(tmp_path / "none"), "--out", str(new), *arguments]) == 1
