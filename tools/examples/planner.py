#!/usr/bin/env python3
"""Says "drive", or "stop" and why: python3 planner.py [LCM_URL]. README.md says what it needs."""

import sys
import time
from itertools import product
from math import atan2, ceil, cos, sin

import lcm
import scree

AHEAD, HALF_WIDTH = 3, 0.6  # metres of the way that must be clear
state = {"blind": "no health yet", "obstacle": "no list yet", "unknown": 0, "heard": 0}


def is_in_the_way(it, x, y):
    """Of a place in odom, seen from base: x forward, y left."""
    yaw = atan2(2 * (it.q[0] * it.q[3] + it.q[1] * it.q[2]), 1 - 2 * (it.q[2] ** 2 + it.q[3] ** 2))
    x, y = x - it.p[0], y - it.p[1]
    ahead, left = cos(yaw) * x + sin(yaw) * y, cos(yaw) * y - sin(yaw) * x
    return 0 < ahead < AHEAD and abs(left) < HALF_WIDTH


def places_of(it):
    """All over its box, at most 0.2 m apart; in half a second and in one, too."""
    across = [[(i / n - 0.5) * side for i in range(n + 1)]
              for side in it.extent[:2] for n in [ceil(side / 0.2) or 1]]  # fmt: skip
    for t, u, v in product((0, 0.5, 1), *across):
        yield (it.center[0] + cos(it.yaw) * u - sin(it.yaw) * v + t * it.velocity[0],
               it.center[1] + sin(it.yaw) * u + cos(it.yaw) * v + t * it.velocity[1])  # fmt: skip


def on_list(_, data):
    found = scree.obstacle_list_t.decode(data)
    state.update(heard=time.monotonic(), obstacle="")
    for it in found.obstacles:
        if any(is_in_the_way(found, x, y) for x, y in places_of(it)):
            state["obstacle"] = "a rock" if it.kind == it.POSITIVE else "a hole"


def on_grid(_, data):
    grid = scree.grid_t.decode(data)
    place = lambda i: [grid.origin[k] + (n + 0.5) * grid.cell_size  # noqa: E731
                       for k, n in enumerate((i % grid.columns, i // grid.columns))]  # fmt: skip
    unseen = (i for i, cell in enumerate(grid.state) if cell == grid.UNKNOWN)
    state["unknown"] = sum(is_in_the_way(grid, *place(i)) for i in unseen)


def on_health(_, data):
    health = scree.health_t.decode(data)
    state["blind"] = "" if health.state == health.OK else "blind: " + health.reason


def decision():
    if state["blind"]:
        return "stop: " + state["blind"]
    if time.monotonic() - state["heard"] > 0.5:
        return "stop: the lists are stale"
    if state["obstacle"]:
        return "stop: " + state["obstacle"]
    return "drive slowly, not all of the way was seen" if state["unknown"] > 10 else "drive"


bus = lcm.LCM(sys.argv[1] if len(sys.argv) > 1 else "udpm://239.255.76.67:7667?ttl=0")  # lcm.url
for channel, take in ("SCREE_OBSTACLES", on_list), ("SCREE_GRID", on_grid), ("SCREE_HEALTH", on_health):
    bus.subscribe(channel, take)
said = None
while True:
    bus.handle_timeout(100)  # milliseconds
    if said != (said := decision()):
        print(said, flush=True)
