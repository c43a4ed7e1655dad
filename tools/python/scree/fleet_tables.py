"""The tables of a run: captures, lists, obstacles, matches."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from .fleet import Row
from .parquet_export import LISTS, OBSTACLES, list_row, obstacle_rows
from .read import read, replacing, shown
from .records import ObstacleList

KEY = pa.field("key", pa.string())
FLOATS = (
    "seconds",
    "way",
    "longest_gap",
    "blind",
    "seconds_taken",
    "seconds_detecting",
    "coverage",
    "f1",
    "precision",
    "recall",
    "positive_f1",
    "positive_precision",
    "positive_recall",
    "negative_f1",
    "negative_precision",
    "negative_recall",
)
COUNTS = (
    "packets",
    "packets_lost",
    "packets_refused",
    "sweeps",
    "imu_messages",
    "encoder_samples",
    "lists",
    "obstacles",
    "true_positives",
    "false_positives",
    "false_negatives",
)
CAPTURES = pa.schema(
    [
        KEY,
        ("capture", pa.string()),
        ("content", pa.string()),
        ("version", pa.string()),
        ("program", pa.string()),
        ("config", pa.string()),
        ("setting", pa.string()),
        ("ok", pa.bool_()),
        ("reason", pa.string()),
        ("has_truth", pa.bool_()),
        ("counts", pa.bool_()),
        ("settings", pa.list_(pa.string())),
        *((name, pa.float64()) for name in FLOATS),
        *((name, pa.int64()) for name in COUNTS),
    ]
)
MATCHES = pa.schema(
    [
        KEY,
        ("stamp_ns", pa.int64()),
        ("outcome", pa.string()),
        ("truth_id", pa.int64()),
        ("id", pa.int64()),
        ("distance", pa.float64()),
    ]
)


def write_tables(out: str | Path, rows: Iterable[Row]) -> None:
    """Writes out/captures.parquet and so on of these rows, each file at once.

    Each capture has its row. Those of the same content share a result, which stands once.
    """
    out = Path(out)
    once = list({row["capture"]: row for row in rows}.values())
    stored = list({row["key"]: row for row in once if row["ok"]}.values())
    _write(out / "captures.parquet", CAPTURES, [[_shown(row) for row in once]])
    for name, schema, parts_of in (
        ("lists", LISTS.insert(0, KEY), _lists),
        ("obstacles", OBSTACLES.insert(0, KEY), _obstacles),
        ("matches", MATCHES, _matches),
    ):
        _write(out / f"{name}.parquet", schema, _parts(out, stored, parts_of))


def _shown(row: Row) -> Row:
    return {name: shown(value) if isinstance(value, str) else value for name, value in row.items()}


def _parts(out: Path, rows: list[Row], of: Callable[[Path], list[Row]]) -> Iterator[list[Row]]:
    for row in rows:
        yield [{"key": row["key"], **part} for part in of(out / "results" / row["key"])]


def _found(folder: Path) -> Iterator[ObstacleList]:
    return (record for record in read(folder / "lists.jsonl") if isinstance(record, ObstacleList))


def _lists(folder: Path) -> list[Row]:
    return [list_row(found) for found in _found(folder)]


def _obstacles(folder: Path) -> list[Row]:
    return [row for found in _found(folder) for row in obstacle_rows(found)]


def _matches(folder: Path) -> list[Row]:
    file = folder / "matches.jsonl"
    rows: list[Row] = []
    for line in file.read_text().splitlines() if file.exists() else []:
        json_line: dict[str, Any] = json.loads(line)
        stamp = {"stamp_ns": json_line["stamp_ns"]}
        rows += [
            {**stamp, "outcome": "right", "truth_id": t, "id": i, "distance": d}
            for t, i, d in json_line["right"]
        ]
        rows += [{**stamp, "outcome": "missed", "truth_id": t, "distance": d} for t, d in json_line["missed"]]
        rows += [{**stamp, "outcome": "invented", "id": i, "distance": d} for i, d in json_line["invented"]]
    return rows


def _write(file: Path, schema: pa.Schema, parts: Iterable[list[Row]], most: int = 100_000) -> None:
    """In groups of rows, so that no more than `most` and a part are in memory."""
    waiting: list[Row] = []
    with replacing(file) as fresh, pq.ParquetWriter(fresh, schema) as writer:
        for part in parts:
            waiting += part
            if len(waiting) >= most:
                writer.write_table(pa.Table.from_pylist(waiting, schema=schema))
                waiting = []
        writer.write_table(pa.Table.from_pylist(waiting, schema=schema))
