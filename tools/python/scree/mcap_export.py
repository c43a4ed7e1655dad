"""Writes MCAP that Foxglove, Lichtblick and Rerun open: lists as scenes, poses, clouds, grid, health."""

from __future__ import annotations

import json
import subprocess
import tomllib
from collections.abc import Iterator
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import foxglove
from foxglove import channels as fc
from foxglove import messages as fm

from .read import ReadError, Record, find_scree, is_capture, read, replacing, run_scree
from .records import Grid, Obstacle, ObstacleList, Pose

BLUE, ORANGE, PURPLE = (0.0, 0.447, 0.698), (0.835, 0.369, 0.0), (0.63, 0.23, 0.47)


def _colour(obstacle: Obstacle, alpha: float) -> Any:
    r, g, b = (PURPLE if obstacle.moves else BLUE) if obstacle.positive else ORANGE
    return fm.Color(r=r, g=g, b=b, a=alpha)


def _time(stamp_ns: int) -> Any:
    return fm.Timestamp(sec=stamp_ns // 1_000_000_000, nsec=stamp_ns % 1_000_000_000)


def _pose(p: tuple[float, float, float], q: tuple[float, float, float, float] = (1, 0, 0, 0)) -> Any:
    x, y, z = p
    w, a, b, c = q
    return fm.Pose(position=fm.Vector3(x=x, y=y, z=z), orientation=fm.Quaternion(x=a, y=b, z=c, w=w))


def _about_z(yaw: float) -> tuple[float, float, float, float]:
    return cos(yaw / 2), 0.0, 0.0, sin(yaw / 2)


def scene_of(found: ObstacleList) -> Any:
    """All of a list; what an earlier one had is gone."""
    entities = [_entity(it, found) for it in found.obstacles]
    gone = fm.SceneEntityDeletion(timestamp=_time(found.stamp_ns), type=fm.SceneEntityDeletionType.All)
    return fm.SceneUpdate(deletions=[gone], entities=entities)


def _entity(it: Obstacle, found: ObstacleList) -> Any:
    length, width, height = (max(0.02, side) for side in it.extent)
    x, y, z = it.center
    box = fm.CubePrimitive(
        pose=_pose(it.center, _about_z(it.yaw)),
        color=_colour(it, 0.4),
        size=fm.Vector3(x=length, y=width, z=height),
    )
    outline = fm.LinePrimitive(
        type=fm.LinePrimitiveLineType.LineLoop,
        thickness=2,
        scale_invariant=True,
        color=_colour(it, 1),
        points=[fm.Point3(x=u, y=v, z=z) for u, v in it.outline()],
    )
    text = fm.TextPrimitive(
        pose=_pose((x, y, z + height / 2 + 0.2)),
        billboard=True,
        font_size=14,
        scale_invariant=True,
        color=_colour(it, 1),
        text=f"{it.id}: {it.height:+.2f}",
    )
    arrows = []
    if it.moves:
        from math import atan2, hypot

        vx, vy = it.velocity
        arrows.append(
            fm.ArrowPrimitive(
                pose=_pose((x, y, z), _about_z(atan2(vy, vx))),
                shaft_length=hypot(vx, vy),
                shaft_diameter=0.08,
                head_length=0.2,
                head_diameter=0.2,
                color=_colour(it, 1),
            )
        )
    words = {
        "kind": "positive" if it.positive else "negative",
        "confidence": f"{it.confidence:.2f}",
        "height": f"{it.height:.3f}",
        "points": str(it.points),
        "evidence": it.evidence,
    }
    return fm.SceneEntity(
        timestamp=_time(found.stamp_ns),
        frame_id="odom",
        id=str(it.id),
        cubes=[box],
        lines=[outline],
        texts=[text],
        arrows=arrows,
        metadata=[fm.KeyValuePair(key=key, value=value) for key, value in words.items()],
    )


def _transform(stamp_ns: int, parent: str, child: str, pose: Pose) -> Any:
    (x, y, z), (w, a, b, c) = pose.p, pose.q
    return fm.FrameTransform(
        timestamp=_time(stamp_ns),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=fm.Vector3(x=x, y=y, z=z),
        rotation=fm.Quaternion(x=a, y=b, z=c, w=w),
    )


def _grid(grid: Grid) -> Any:
    """Cells of red, green, blue, alpha: unknown ones cannot be seen."""
    colours = (bytes(4), bytes((120, 170, 120, 110)), bytes((0, 114, 178, 170)), bytes((213, 94, 0, 170)))
    x, y = grid.origin
    fields = [
        fm.PackedElementField(name=name, offset=i, type=fm.PackedElementFieldNumericType.Uint8)
        for i, name in enumerate(("red", "green", "blue", "alpha"))
    ]
    return fm.Grid(
        timestamp=_time(grid.stamp_ns),
        frame_id="odom",
        pose=_pose((x, y, grid.pose.p[2])),
        column_count=grid.columns,
        cell_size=fm.Vector2(x=grid.cell_size, y=grid.cell_size),
        row_stride=4 * grid.columns,
        cell_stride=4,
        fields=fields,
        data=b"".join(colours[cell] for cell in grid.state),
    )


def clouds(
    capture: Path, stamps: list[int], scree: str | None, config: str | Path | None = None
) -> Iterator[tuple[int, bytes]]:
    """The lidar's returns until each stamp since the one before: x, y, z, reflectivity as float32.

    They are in `lidar`, each seen from where the lidar was at its time.
    """
    import numpy as np
    from pyarrow import csv

    command = [find_scree(scree), "decode", str(capture), "--sensor", "lidar"]
    command += ["--config", str(config)] if config else []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        columns = ["t_ns", "x", "y", "z", "reflectivity"]
        try:
            rows = csv.open_csv(process.stdout, convert_options=csv.ConvertOptions(include_columns=columns))
        except ValueError as error:
            raise ReadError(f"{capture}: scree decode gives no returns: {error}") from error
        rest = np.empty((0, 5))
        at = 0
        for batch in rows:
            rest = np.concatenate(
                [rest, np.column_stack([batch.column(name).to_numpy() for name in columns])]
            )
            while at < len(stamps) and len(rest) and rest[-1, 0] > stamps[at]:
                is_part = rest[:, 0] <= stamps[at]
                yield stamps[at], rest[is_part, 1:].astype("<f4").tobytes()
                rest = rest[~is_part]
                at += 1
        if at < len(stamps):
            yield stamps[at], rest[rest[:, 0] <= stamps[at], 1:].astype("<f4").tobytes()


def mount_of(capture: Path, config: str | Path | None, scree: str | None = None) -> Pose:
    """The lidar in `base`, of the configuration with its drop-ins."""
    file = Path(config) if config else capture / "scree.toml"
    if not config and not file.exists():
        return Pose()
    lidar = tomllib.loads(run_scree(scree, "config", "--config", file, "--all"))["lidar"]
    x, y, z = lidar["translation"]
    roll, pitch, yaw = (radians(angle) / 2 for angle in lidar["rpy_deg"])
    (cr, sr), (cp, sp), (cy, sy) = ((cos(half), sin(half)) for half in (roll, pitch, yaw))
    q = (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
    return Pose((float(x), float(y), float(z)), q)


class _Writer:
    def __init__(self, context: foxglove.Context) -> None:
        self.scenes = fc.SceneUpdateChannel("/obstacles", context=context)
        self.poses = fc.FrameTransformsChannel("/tf", context=context)
        self.grids = fc.GridChannel("/grid", context=context)
        self.clouds = fc.PointCloudChannel("/lidar", context=context)
        self.health = foxglove.Channel(
            "/health",
            message_encoding="json",
            context=context,
            schema={"type": "object", "title": "scree.health"},
        )

    def write(self, record: Record) -> None:
        if isinstance(record, ObstacleList):
            stamp = record.stamp_ns
            self.scenes.log(scene_of(record), log_time=stamp)
            transform = _transform(stamp, "odom", "base", record.pose)
            self.poses.log(fm.FrameTransforms(transforms=[transform]), log_time=stamp)
        elif isinstance(record, Grid):
            self.grids.log(_grid(record), log_time=record.stamp_ns)
        else:
            self.health.log(json.dumps(record).encode(), log_time=record["stamp_ns"])

    def write_cloud(self, stamp_ns: int, data: bytes) -> None:
        fields = [
            fm.PackedElementField(name=name, offset=4 * i, type=fm.PackedElementFieldNumericType.Float32)
            for i, name in enumerate(("x", "y", "z", "intensity"))
        ]
        cloud = fm.PointCloud(
            timestamp=_time(stamp_ns),
            frame_id="lidar",
            pose=_pose((0, 0, 0)),
            point_stride=16,
            fields=fields,
            data=data,
        )
        self.clouds.log(cloud, log_time=stamp_ns)


def export_mcap(
    source: str | Path,
    file: str | Path,
    scree: str | None = None,
    config: str | Path | None = None,
    with_cloud: bool = True,
    force: bool = False,
) -> int:
    """Writes one file of all records of a source; of a capture with the lidar's clouds.

    @return how many lists it has
    """
    source, file = Path(source), Path(file)
    if file.exists() and not force:
        raise ReadError(f"{file} is there already: --force overwrites it")
    if file.is_dir():
        raise ReadError(f"{file} is a folder")
    with replacing(file) as fresh:
        fresh.touch()  # foxglove's error would not name the file
        return _write(source, fresh, scree, config, with_cloud)


def _write(source: Path, file: Path, scree: str | None, config: str | Path | None, with_cloud: bool) -> int:
    stamps = []
    context = foxglove.Context()
    with foxglove.open_mcap(str(file), allow_overwrite=True, context=context):
        writer = _Writer(context)
        for record in read(source, scree, config):
            try:
                writer.write(record)
            except (OverflowError, TypeError, ValueError) as error:
                raise ReadError(f"{source}: a record does not fit into MCAP: {error}") from error
            if isinstance(record, ObstacleList):
                stamps.append(record.stamp_ns)
        if with_cloud and is_capture(source) and stamps:
            mount = _transform(stamps[0], "base", "lidar", mount_of(source, config, scree))
            writer.poses.log(fm.FrameTransforms(transforms=[mount]), log_time=stamps[0])
            for stamp_ns, data in clouds(source, stamps, scree, config):
                writer.write_cloud(stamp_ns, data)
    if not stamps:
        raise ReadError(f"{source} holds no list")
    return len(stamps)
