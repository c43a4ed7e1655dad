"""Scree's lists and grids as plain objects. Metres, radians, nanoseconds; frames as in the README."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from math import atan2, cos, inf, isfinite, sin
from typing import Any

Vector = tuple[float, float, float]
Corner = tuple[float, float]

EVIDENCE = ("none", "inside", "wall", "edge", "shadow")
CELLS = "?.#v"  # unknown, free, occupied, drop


@dataclass(frozen=True)
class Pose:
    """A child frame in its parent: position, and rotation w x y z."""

    p: Vector = (0.0, 0.0, 0.0)
    q: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    @property
    def yaw(self) -> float:
        w, x, y, z = self.q
        return atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def apply(self, v: Vector) -> Vector:
        """A point of the child in the parent."""
        x, y, z = _rotated(self.q, v)
        return x + self.p[0], y + self.p[1], z + self.p[2]

    def unapply(self, v: Vector) -> Vector:
        """A point of the parent in the child."""
        w, x, y, z = self.q
        return _rotated((w, -x, -y, -z), (v[0] - self.p[0], v[1] - self.p[1], v[2] - self.p[2]))


def _rotated(q: tuple[float, float, float, float], v: Vector) -> Vector:
    w, a, b, c = q
    x, y, z = v
    tx, ty, tz = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
    return x + w * tx + b * tz - c * ty, y + w * ty + c * tx - a * tz, z + w * tz + a * ty - b * tx


@dataclass(frozen=True)
class Obstacle:
    id: int
    positive: bool  # a rock; else a hole
    confidence: float
    center: Vector
    extent: Vector  # length, width, height of the box
    yaw: float
    height: float  # above the ground around it; below zero: depth
    velocity: Corner = (0.0, 0.0)
    points: int = 0
    evidence: str = "none"
    footprint: tuple[Corner, ...] = ()

    @property
    def moves(self) -> bool:
        return self.velocity != (0.0, 0.0)

    def outline(self) -> tuple[Corner, ...]:
        """The footprint where it is known, else the box, from above."""
        if self.footprint:
            return self.footprint
        c, s = cos(self.yaw), sin(self.yaw)
        corners = []
        for a, b in ((1, -1), (1, 1), (-1, 1), (-1, -1)):
            u, v = a * self.extent[0] / 2, b * self.extent[1] / 2
            corners.append((self.center[0] + c * u - s * v, self.center[1] + s * u + c * v))
        return tuple(corners)


@dataclass(frozen=True)
class ObstacleList:
    stamp_ns: int  # of the data
    pose: Pose  # `base` in `odom`
    obstacles: tuple[Obstacle, ...] = field(default=())  # in `odom`

    def in_base(self) -> tuple[Obstacle, ...]:
        """The obstacles in `base`: x ahead, y to the left, z up."""
        return tuple(self._in_base(it) for it in self.obstacles)

    def _in_base(self, it: Obstacle) -> Obstacle:
        def flat(corner: Corner) -> Corner:
            return self.pose.unapply((*corner, it.center[2]))[:2]

        c, s = cos(self.pose.yaw), sin(self.pose.yaw)
        vx, vy = it.velocity
        return replace(
            it,
            center=self.pose.unapply(it.center),
            yaw=it.yaw - self.pose.yaw,
            velocity=(c * vx + s * vy, c * vy - s * vx),
            footprint=tuple(flat(corner) for corner in it.footprint),
        )


@dataclass(frozen=True)
class Grid:
    """Square cells around the robot, row by row: x grows along a row."""

    stamp_ns: int
    pose: Pose
    origin: Corner
    cell_size: float
    columns: int
    rows: int
    state: bytes  # of each cell: 0 unknown, 1 free, 2 occupied, 3 drop
    ground: tuple[int | None, ...]  # centimetres above `base`; None: unknown


def pose_of_json(json: dict[str, Any]) -> Pose:
    x, y, z = map(_number, json["p"])
    w, a, b, c = map(_number, json["q"])
    return Pose((x, y, z), (w, a, b, c))


def _number(value: Any) -> float:
    return float("nan") if value is None else float(value)


def list_of_json(json: dict[str, Any]) -> ObstacleList:
    obstacles = []
    for it in json["obstacles"]:
        x, y, z = map(_number, it["center"])
        length, width, height = map(_number, it["extent"])
        vx, vy = map(_number, it.get("velocity", (0, 0)))
        obstacles.append(
            Obstacle(
                int(it["id"]),
                it["kind"] == "positive",
                _number(it["confidence"]),
                (x, y, z),
                (length, width, height),
                _number(it["yaw"]),
                _number(it["height"]),
                (vx, vy),
                int(it["points"]),
                it.get("evidence", "none"),
                tuple((float(u), float(v)) for u, v in it.get("footprint", ())),
            )
        )
    return ObstacleList(int(json["stamp_ns"]), pose_of_json(json["pose"]), tuple(obstacles))


def list_of_message(message: Any) -> ObstacleList:
    """Of an obstacle_list_t."""
    obstacles = tuple(
        Obstacle(
            it.id,
            it.kind == it.POSITIVE,
            it.confidence,
            tuple(it.center),
            tuple(it.extent),
            it.yaw,
            it.height,
            tuple(it.velocity),
            it.points,
            EVIDENCE[it.evidence] if 0 <= it.evidence < len(EVIDENCE) else "none",
            tuple((x, y) for x, y in it.footprint),
        )
        for it in message.obstacles
    )
    return ObstacleList(message.stamp_ns, Pose(tuple(message.p), tuple(message.q)), obstacles)


def grid_of_json(json: dict[str, Any]) -> Grid:
    state = bytearray()
    for row in json["states"]:
        for count, sign in re.findall(r"(\d*)([?.#v])", row):
            state += bytes([CELLS.index(sign)]) * int(count or 1)
    columns, rows = int(json["columns"]), int(json["rows"])
    if len(state) != columns * rows:
        raise ValueError("the grid has not as many cells as its columns and rows say")
    heights = iter(json["ground"])
    ground = tuple(None if cell == 0 else int(next(heights)) for cell in state)
    x, y = map(float, json["origin"])
    return Grid(
        int(json["stamp_ns"]),
        pose_of_json(json["pose"]),
        (x, y),
        float(json["cell_size"]),
        columns,
        rows,
        bytes(state),
        ground,
    )


def grid_of_message(message: Any) -> Grid:
    """Of a grid_t. ValueError where it contradicts itself."""
    if message.columns * message.rows != message.cells or not message.cell_size > 0:
        raise ValueError("the grid contradicts itself")
    ground = tuple(None if h == message.NO_GROUND else h for h in message.ground)
    return Grid(
        message.stamp_ns,
        Pose(tuple(message.p), tuple(message.q)),
        tuple(message.origin),
        message.cell_size,
        message.columns,
        message.rows,
        bytes(message.state),
        ground,
    )


def distance(obstacle: Obstacle, pose: Pose) -> float:
    """From `base` to the obstacle's centre, seen from above."""
    x, y = obstacle.center[0] - pose.p[0], obstacle.center[1] - pose.p[1]
    away = (x * x + y * y) ** 0.5
    return away if isfinite(away) else inf
