"""Drives by the thousand: one capture in, one row out, whatever happens.

`process` needs nothing but its arguments, so any engine can map it: Dask (`scree.fleet_run`), Ray
(`ray.data.from_items(captures).map(lambda it: process(it["item"], out))`), or plain `map`.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import subprocess
import tempfile
import time
from functools import lru_cache
from pathlib import Path
from typing import Any

from .read import ReadError, find_scree, run_scree

Row = dict[str, Any]

FORMAT = "1"  # of a result; another one makes every result anew
BLOCK = 1 << 20
PCAP = (".pcap", ".pcapng")
LIDAR = {"lidar.pcap", "lidar.pcapng", "lidar.lcm"}


def captures_in(place: str | Path) -> list[str]:
    """The captures below a folder, those that a text file lists, a path a line, or the one capture."""
    place = Path(place)
    if not place.exists():
        raise ReadError(f"there is no {place}")
    if place.is_dir():
        return sorted(_captures_below(place))
    if place.suffix in PCAP:
        return [str(place.resolve())]
    try:
        lines = [line.strip() for line in place.read_text(encoding="utf-8").splitlines()]
        return [str((place.parent / line).resolve()) for line in lines if line and not line.startswith("#")]
    except ValueError as error:  # other text, or a zero in it
        raise ReadError(f"{place} is no list of captures, a path a line in UTF-8") from error


def _captures_below(place: Path) -> set[str]:
    """Folders with lidar data under its name. A pcap of any other name is a capture by itself."""
    found, seen = set(), set()
    for name, folders, files in os.walk(place, followlinks=True):
        folder = os.path.realpath(name)
        if folder in seen:  # a link back
            folders.clear()
            continue
        seen.add(folder)
        if not LIDAR.isdisjoint(files):
            found.add(folder)
            continue
        alone = (file for file in map(Path, files) if file.suffix in PCAP and file.stem != "imu")
        found |= {os.path.realpath(folder / file) for file in alone}
    return found


def _hash_file(file: Path) -> str:
    digest = hashlib.sha256()
    with file.open("rb") as stream:
        while block := stream.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _hash_files(files: list[Path], root: Path) -> str:
    digest = hashlib.sha256()
    for file in sorted(files):
        digest.update(os.fsencode(f"{file.relative_to(root)}\0{_hash_file(file)}\n"))
    return digest.hexdigest()


def content_of(capture: Path) -> str:
    """What the capture holds, truth and configuration too; the same wherever it lies."""
    if capture.is_file():
        return _hash_file(capture)
    if not capture.exists():
        raise ReadError(f"there is no {capture}")
    files = [file for file in capture.rglob("*") if file.is_file()]
    if not files:
        raise ReadError(f"{capture} is empty")
    return _hash_files(files, capture)


def setting_of(config: str | Path | None) -> str:
    """What a configuration says, with its drop-ins, and the profiles and networks that lie beside it."""
    if not config:
        return ""
    file = Path(config)
    beside = [
        it
        for name in ("map.toml", "sweep.toml", "cloud.toml", "network_*.txt")
        for it in file.parent.glob(name)
    ]
    return _hash_files(list({file, *file.with_suffix(".d").glob("*.toml"), *beside}), file.parent)


@lru_cache(maxsize=8)
def _version_of(program: str, _changed: float) -> tuple[str, str]:
    version = run_scree(program, "--version").strip()
    if not version:
        raise ReadError(f"{program} does not say its version")
    binary = Path(program).resolve()
    shipped = binary.parent.parent / "share" / "scree"
    files = [binary, *(file for file in shipped.glob("*") if file.suffix in (".toml", ".txt"))]
    return version, _hash_files(files, binary.parent.parent)[:12]


def version_of(scree: str | None = None) -> str:
    """Version of the program, and a mark that changes with it and with its profiles and networks."""
    program = find_scree(scree)
    version, mark = _version_of(program, os.stat(program).st_mtime)
    return f"{version} ({mark})"


def process(
    capture: str | Path,
    out: str | Path,
    scree: str | None = None,
    config: str | Path | None = None,
    timeout: float = 3600,
    retry_failed: bool = False,
) -> Row:
    """Looks at one capture and stores the result in out/results, once and whole. Never throws.

    What is stored already, of the same content, configuration and version, is not done again.

    @param timeout seconds for each of the programs that it runs
    @return `ok` says whether it worked, `reason` why not; `key` names the stored result
    """
    begin = time.monotonic()
    own: Row = {"capture": str(capture), "program": "", "config": ""}  # the rest is that of the key
    row: Row = {"ok": False, "reason": "", "key": "", "content": "", "setting": "", "version": ""}
    try:
        own |= {
            "program": os.path.abspath(find_scree(scree)),
            "config": os.path.abspath(config) if config else "",
        }
        row["version"] = version_of(scree)
        row["content"] = content_of(Path(capture))
        row["setting"] = setting_of(config)
        name = "\0".join((FORMAT, row["content"], row["setting"], row["version"]))
        row["key"] = hashlib.sha256(name.encode()).hexdigest()[:32]
        folder = Path(out) / "results" / row["key"]
        stored = load(folder)
        if stored is not None and (stored["ok"] or not retry_failed):
            reason = stored["reason"].replace(stored["capture"], str(capture))
            return {**stored, **own, "reason": reason, "was_stored": True}
        with tempfile.TemporaryDirectory(prefix="scree-fleet-") as work:
            try:
                row |= _look(Path(capture), Path(work), find_scree(scree), config, timeout)
                row["ok"] = True
            except _WorkFailed as error:
                row["reason"] = str(error)
            row["seconds_taken"] = time.monotonic() - begin
            _store(row | own, Path(work), folder)
    except Exception as error:  # a row, whatever it is: thousands of others wait
        kind = "" if isinstance(error, ReadError) else f"{type(error).__name__}: "
        row |= {"ok": False, "reason": f"{kind}{error}"}
    return {**row, **own, "was_stored": False}


class _WorkFailed(Exception):
    pass


def _run(timeout: float, *command: str | Path) -> str:
    try:
        done = subprocess.run(
            list(map(str, command)),
            capture_output=True,
            text=True,
            errors="backslashreplace",
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise _WorkFailed(f"scree {command[1]} took longer than {timeout:g} s") from error
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"scree {command[1]} ended with {done.returncode}"]
        raise _WorkFailed(lines[-1].removeprefix("scree: "))
    return done.stdout


def _look(capture: Path, work: Path, scree: str, config: str | Path | None, timeout: float) -> Row:
    """Info, lists, and with truth the score, of one capture."""
    options: list[str | Path] = ["--config", config] if config else []
    info = json.loads(_run(timeout, scree, "info", capture, "--json", *options))
    lists = work / "lists.jsonl"
    began = time.monotonic()
    _run(timeout, scree, "detect", capture, "--out", lists, *options)
    row = _row_of_info(info) | {"seconds_detecting": time.monotonic() - began} | _row_of_lists(lists)
    truth = capture / "truth.json"
    if capture.is_dir() and truth.exists():
        matches = work / "matches.jsonl"
        score = _run(timeout, scree, "evaluate", truth, lists, "--json", "--matches", matches)
        row |= _row_of_score(json.loads(score))
    return row


def _row_of_info(info: Row) -> Row:
    imu, encoder = info.get("imu") or {}, info.get("encoder") or {}
    return {
        "seconds": float(info["seconds"]),
        "packets": info["packets"],
        "packets_lost": info["lost"],
        "packets_refused": sum(info["refused"].values()),
        "sweeps": info["sweeps"],
        "imu_messages": imu.get("messages", 0),
        "encoder_samples": encoder.get("samples", 0),
        "settings": list(info.get("settings", [])),
    }


def _row_of_lists(file: Path) -> Row:
    from .read import read
    from .records import ObstacleList

    found = [record for record in read(file) if isinstance(record, ObstacleList)]
    stamps = [it.stamp_ns for it in found]
    gaps = [(b - a) * 1e-9 for a, b in zip(stamps, stamps[1:], strict=False)]
    way = sum(
        ((b.pose.p[0] - a.pose.p[0]) ** 2 + (b.pose.p[1] - a.pose.p[1]) ** 2) ** 0.5
        for a, b in zip(found, found[1:], strict=False)
    )
    return {
        "lists": len(found),
        "obstacles": len({it.id for one in found for it in one.obstacles}),
        "way": way,
        "longest_gap": max(gaps, default=0.0),
        "blind": sum(gap for gap in gaps if gap > 0.3),
    }


def _row_of_score(score: Row) -> Row:
    row: Row = {"has_truth": True, "coverage": score["coverage"], "counts": score["counts"]}
    for kind in ("all", "positive", "negative"):
        prefix = "" if kind == "all" else f"{kind}_"
        for name in ("f1", "precision", "recall"):
            row[prefix + name] = score[kind][name]
    for name in ("true_positives", "false_positives", "false_negatives"):
        row[name] = score["all"][name]
    return row


def sweep_up(out: str | Path, older_than: float = 86400) -> None:
    """Removes what killed workers left half written, once nobody can be at it any more (seconds)."""
    for left in (Path(out) / "results").glob(".*-*"):
        with contextlib.suppress(OSError):
            if time.time() - left.stat().st_mtime > older_than:
                shutil.rmtree(left, ignore_errors=True)


def load(folder: Path) -> Row | None:
    """The row of a stored result; nothing where there is none."""
    with contextlib.suppress(FileNotFoundError, NotADirectoryError, ValueError):
        row: Row = json.loads((folder / "row.json").read_text())
        return row
    return None


def _store(row: Row, work: Path, folder: Path) -> None:
    """All of a result at once: it is written beside its place, and moved there. The first one stays."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        for name in ("lists.jsonl", "matches.jsonl"):
            if (work / name).exists():
                shutil.copyfile(work / name, made / name)
        (made / "row.json").write_text(json.dumps(row) + "\n")
        _move(made, folder)
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _move(made: Path, folder: Path) -> None:
    """Where another worker was first, its result stays; a failure makes room for a success."""
    try:
        made.rename(folder)
    except OSError:
        stored = load(folder)
        if stored is None or not stored["ok"]:
            shutil.rmtree(folder, ignore_errors=True)
            with contextlib.suppress(OSError):
                made.rename(folder)
