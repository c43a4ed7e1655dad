"""Reads lists, grids and health: JSON lines, LCM logs, and captures by running `scree detect`."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from struct import error as StructError
from typing import Any

from .decoding import decode_grid, decode_health, decode_list
from .records import Grid, ObstacleList, grid_of_json, grid_of_message, list_of_json, list_of_message

Health = dict[str, Any]  # as `scree status --json` prints it
Record = ObstacleList | Grid | Health

_LOG_MAGIC = bytes.fromhex("eda1da01")
_MOST_NS = 2**32 * 1_000_000_000  # MCAP counts seconds in 32 bits
_WRONG = (ValueError, KeyError, TypeError, AttributeError, OverflowError, RuntimeError)  # what a line can do
_STATES = ("never seen", "ok", "silent", "wrong data", "slow")


class ReadError(Exception):
    """One sentence for the person who has to mend it."""


def sentence(error: Exception) -> str:
    """The error for a person."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return shown(f"{error.filename}: {error.strerror}")
    return shown(str(error))


def shown(text: str | Path) -> str:
    """Text that any file takes: a byte of a name that is not UTF-8 becomes \\udcNN."""
    return str(text).encode(errors="backslashreplace").decode()


def find_scree(scree: str | None = None) -> str:
    """The command-line tool: as given, else that on the path."""
    found = shutil.which(scree or "scree")
    if found is None:
        raise ReadError(
            f"there is no program {scree or 'scree'}: install Scree's package, or name it with --scree"
        )
    return found


def run_scree(scree: str | None, *arguments: str | Path) -> str:
    """What it printed; its remarks go to stderr. ReadError with its last sentence where it failed."""
    command = [find_scree(scree), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, errors="backslashreplace", check=False)
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"{command[0]} ended with {done.returncode}"]
        raise ReadError(lines[-1].removeprefix("scree: "))
    sys.stderr.write(done.stderr)
    return done.stdout


@contextmanager
def replacing(file: Path) -> Iterator[Path]:
    """Where to write what takes the place of a file when it is whole; after a failure nothing is left of it."""
    fresh = file.with_name(file.name + ".new")
    try:
        yield fresh
        os.replace(fresh, file)
    finally:
        fresh.unlink(missing_ok=True)


def is_capture(source: Path) -> bool:
    """Whether it holds sensor data, as far as its kind tells."""
    return source.is_dir() or source.suffix in (".pcap", ".pcapng")


def read(source: str | Path, scree: str | None = None, config: str | Path | None = None) -> Iterator[Record]:
    """All records of a source in their order; of a capture the lists and grids that `scree detect` gives.

    ReadError names the file, and the line where there is one.
    """
    source = Path(source)
    if not source.exists():
        raise ReadError(f"there is no {source}")
    if is_capture(source):
        yield from _read_capture(source, scree, config)
    else:
        with source.open("rb") as file:
            is_log = file.read(4) == _LOG_MAGIC
        yield from _read_log(source) if is_log else _read_lines(source)


def _read_capture(source: Path, scree: str | None, config: str | Path | None) -> Iterator[Record]:
    with tempfile.TemporaryDirectory() as folder:
        lists, grids = Path(folder, "lists.jsonl"), Path(folder, "grids.jsonl")
        options = ["--config", str(config)] if config else []
        try:
            run_scree(scree, "detect", source, "--out", lists, "--grid", grids, *options)
        except ReadError as error:
            if "no grid" not in str(error):
                raise
        waiting = _read_lines(grids) if grids.exists() else iter(())
        grid = next(waiting, None)
        for record in _read_lines(lists):
            yield record
            while (
                isinstance(grid, Grid)
                and isinstance(record, ObstacleList)
                and grid.stamp_ns <= record.stamp_ns
            ):
                yield grid
                grid = next(waiting, None)


def _read_lines(source: Path) -> Iterator[Record]:
    with source.open("rb") as file:
        for number, line in enumerate(file, 1):
            if number > 1 and not line.strip() and not file.peek(1):
                break  # the blank line that some editors leave at the end
            try:
                record = _stamped(_record_of(json.loads(line.decode("utf-8-sig"))))
            except _WRONG as error:
                what = f"it has no {error}" if isinstance(error, KeyError) else error
                raise ReadError(f"{source}:{number}: neither list nor grid nor health: {what}") from error
            yield record


def _stamped(record: Record) -> Record:
    """The record where it has a time that all files take."""
    stamp = record["stamp_ns"] if isinstance(record, dict) else record.stamp_ns
    if not isinstance(stamp, int) or not 0 <= stamp < _MOST_NS:
        raise ValueError(f"stamp_ns {stamp} is no time")
    return record


def _record_of(record: Any) -> Record:
    if not isinstance(record, dict):
        raise ValueError("it is no object")
    if "health" in record:
        return record
    return grid_of_json(record) if "states" in record else list_of_json(record)


def _read_log(source: Path) -> Iterator[Record]:
    from lcm import EventLog

    for event in EventLog(str(source), "r"):
        try:
            if event.channel == "SCREE_OBSTACLES":
                yield _stamped(list_of_message(decode_list(event.data)))
            elif event.channel == "SCREE_GRID":
                yield _stamped(grid_of_message(decode_grid(event.data)))
            elif event.channel == "SCREE_HEALTH":
                yield _stamped(health_of_message(decode_health(event.data)))
        except (ValueError, IndexError, OverflowError, StructError):
            continue  # of another version, or broken: as the C++ programs do, it is passed over


def health_of_message(message: Any) -> Health:
    """The part of a health_t that tables and viewers show, by the names of `scree status --json`."""

    def sensor(it: Any) -> Health:
        state = _STATES[it.state] if 0 <= it.state < len(_STATES) else "unknown"
        return {"state": state, "rate": it.rate, "lost": it.lost, "clock_accuracy_ms": it.clock_accuracy_ms}

    def times(it: Any) -> Health:
        return {"p50_ms": it.p50_ms, "p99_ms": it.p99_ms, "max_ms": it.max_ms}

    return {
        "stamp_ns": message.stamp_ns,
        "health": "ok" if message.state == message.OK else "blind",
        "reason": message.reason,
        "stop": bool(message.stop),
        "setup": list(message.setup),
        "version": message.version,
        **{name: sensor(getattr(message, name)) for name in ("lidar", "imu", "encoder")},
        "latency": times(message.latency),
        "detector_time": times(message.detector_time),
        "position_deviation": message.position_deviation,
        "lists_published": message.lists_published,
        "sweeps_dropped": message.sweeps_dropped,
    }
