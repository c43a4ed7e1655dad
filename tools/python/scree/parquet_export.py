"""Writes tables: lists, obstacles, tracks, health."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from .read import Health, ReadError, read, replacing
from .records import ObstacleList, distance

Row = dict[str, Any]

LISTS = pa.schema(
    [
        ("stamp_ns", pa.int64()),
        ("x", pa.float64()),
        ("y", pa.float64()),
        ("z", pa.float64()),
        ("qw", pa.float64()),
        ("qx", pa.float64()),
        ("qy", pa.float64()),
        ("qz", pa.float64()),
        ("obstacles", pa.int32()),
    ]
)
OBSTACLES = pa.schema(
    [
        ("stamp_ns", pa.int64()),
        ("id", pa.int64()),
        ("positive", pa.bool_()),
        ("confidence", pa.float32()),
        ("x", pa.float64()),
        ("y", pa.float64()),
        ("z", pa.float64()),
        ("length", pa.float64()),
        ("width", pa.float64()),
        ("box_height", pa.float64()),
        ("yaw", pa.float64()),
        ("height", pa.float64()),
        ("vx", pa.float64()),
        ("vy", pa.float64()),
        ("points", pa.int64()),
        ("evidence", pa.string()),
        ("distance", pa.float64()),
        ("footprint", pa.list_(pa.list_(pa.float64(), 2))),
    ]
)
TRACKS = pa.schema(
    [
        ("id", pa.int64()),
        ("positive", pa.bool_()),
        ("lists", pa.int32()),
        ("first_ns", pa.int64()),
        ("last_ns", pa.int64()),
        ("first_distance", pa.float64()),
        ("nearest", pa.float64()),
        ("height", pa.float64()),
        ("confidence", pa.float32()),
        ("moves", pa.bool_()),
    ]
)
HEALTH = pa.schema(
    [
        ("stamp_ns", pa.int64()),
        ("ok", pa.bool_()),
        ("reason", pa.string()),
        ("stop", pa.bool_()),
        ("lidar_rate", pa.float64()),
        ("lidar_lost", pa.int64()),
        ("imu_rate", pa.float64()),
        ("encoder_rate", pa.float64()),
        ("latency_p50_ms", pa.float64()),
        ("latency_p99_ms", pa.float64()),
        ("position_deviation", pa.float64()),
        ("lists_published", pa.int64()),
        ("setup", pa.list_(pa.string())),
    ]
)


def list_row(found: ObstacleList) -> Row:
    (x, y, z), (w, a, b, c) = found.pose.p, found.pose.q
    return {
        "stamp_ns": found.stamp_ns,
        "x": x,
        "y": y,
        "z": z,
        "qw": w,
        "qx": a,
        "qy": b,
        "qz": c,
        "obstacles": len(found.obstacles),
    }


def obstacle_rows(found: ObstacleList) -> list[Row]:
    return [
        {
            "stamp_ns": found.stamp_ns,
            "id": it.id,
            "positive": it.positive,
            "confidence": it.confidence,
            "x": it.center[0],
            "y": it.center[1],
            "z": it.center[2],
            "length": it.extent[0],
            "width": it.extent[1],
            "box_height": it.extent[2],
            "yaw": it.yaw,
            "height": it.height,
            "vx": it.velocity[0],
            "vy": it.velocity[1],
            "points": it.points,
            "evidence": it.evidence,
            "distance": distance(it, found.pose),
            "footprint": [list(corner) for corner in it.footprint],
        }
        for it in found.obstacles
    ]


def track_rows(obstacles: list[Row]) -> list[Row]:
    """Each obstacle over all lists; height and confidence are the latest."""
    tracks: dict[int, Row] = {}
    for it in obstacles:
        track = tracks.setdefault(
            it["id"],
            {
                "id": it["id"],
                "lists": 0,
                "first_ns": it["stamp_ns"],
                "first_distance": it["distance"],
                "nearest": it["distance"],
                "moves": False,
            },
        )
        track["lists"] += 1
        track["nearest"] = min(track["nearest"], it["distance"])
        track["moves"] = track["moves"] or (it["vx"], it["vy"]) != (0, 0)
        track.update(
            last_ns=it["stamp_ns"], positive=it["positive"], height=it["height"], confidence=it["confidence"]
        )
    return list(tracks.values())


def health_row(health: Health) -> Row:
    def of(*keys: str) -> Any:
        value: Any = health
        for key in keys:
            value = value.get(key) if isinstance(value, dict) else None
        return value

    return {
        "stamp_ns": health["stamp_ns"],
        "ok": health["health"] == "ok",
        "reason": of("reason"),
        "stop": of("stop"),
        "lidar_rate": of("lidar", "rate"),
        "lidar_lost": of("lidar", "lost"),
        "imu_rate": of("imu", "rate"),
        "encoder_rate": of("encoder", "rate"),
        "latency_p50_ms": of("latency", "p50_ms"),
        "latency_p99_ms": of("latency", "p99_ms"),
        "position_deviation": of("position_deviation"),
        "lists_published": of("lists_published"),
        "setup": of("setup"),
    }


def export_parquet(
    source: str | Path,
    folder: str | Path,
    scree: str | None = None,
    config: str | Path | None = None,
    force: bool = False,
) -> dict[str, int]:
    """Writes lists, obstacles, tracks and health as .parquet into a folder. How many rows each has."""
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()) and not force:
        raise ReadError(f"{folder} is not empty: --force overwrites what is there")
    lists: list[Row] = []
    obstacles: list[Row] = []
    health: list[Row] = []
    for record in read(source, scree, config):
        if isinstance(record, ObstacleList):
            lists.append(list_row(record))
            obstacles += obstacle_rows(record)
        elif isinstance(record, dict):
            health.append(health_row(record))
    if not lists and not health:
        raise ReadError(f"{source} holds neither lists nor health")
    parts = {
        "lists": (lists, LISTS),
        "obstacles": (obstacles, OBSTACLES),
        "tracks": (track_rows(obstacles), TRACKS),
        "health": (health, HEALTH),
    }
    try:
        tables = {name: pa.Table.from_pylist(rows, schema=schema) for name, (rows, schema) in parts.items()}
    except (pa.ArrowException, OverflowError, TypeError) as error:
        raise ReadError(f"{source}: a record does not fit into the tables: {error}") from error
    folder.mkdir(parents=True, exist_ok=True)
    for name, table in tables.items():
        with replacing(folder / f"{name}.parquet") as fresh:
            pq.write_table(table, fresh)
    return {name: len(table) for name, table in tables.items()}
