"""Obstacle lists as they are pinned: read from `scree detect`, rounded, one line an obstacle.

Position, size and height are in metres in the frame of the list, yaw in degrees.
"""

import json
import math
from collections import namedtuple

# What a value is rounded to, and how far a new one may lie from it: one step.
STEPS = {"position": 0.01, "size": 0.02, "confidence": 0.05, "yaw": 5.0, "attitude": 0.01}
DECIMALS = {"position": 2, "size": 2, "confidence": 2, "yaw": 0, "attitude": 2}

Obstacle = namedtuple("Obstacle", "id kind confidence center size yaw points")
List = namedtuple("List", "stamp position attitude obstacles")  # stamp in milliseconds

HEAD = """\
# {input}
# list: its time in seconds, position and attitude (quaternion w x y z) of the robot
# obstacle: id kind  confidence  center x y z  length width thickness height  yaw  points
"""


def detected(path):
    """The lists of a file of `scree detect`, as they are."""
    lists = []
    with open(path) as file:
        for each in map(json.loads, file):
            attitude = each["pose"]["q"]
            if attitude[0] < 0:  # the same rotation
                attitude = [-value for value in attitude]
            obstacles = [
                Obstacle(o["id"], o["kind"], o["confidence"], o["center"],
                         [*o["extent"], o["height"]], math.degrees(o["yaw"]), o["points"])
                for o in each["obstacles"]
            ]  # fmt: skip
            stamp = round(each["stamp_ns"] / 1e6)
            lists.append(List(stamp, each["pose"]["p"], attitude, obstacles))
    return lists


def rounded(kind, values):
    step, decimals = STEPS[kind], DECIMALS[kind]
    # Adding zero makes a plain zero of a negative one.
    return " ".join(f"{round(value / step) * step + 0.0:.{decimals}f}" for value in values)


def write(path, source, lists):
    with open(path, "w") as file:
        file.write(HEAD.format(input=source))
        for each in lists:
            pose = f"{rounded('position', each.position)}  {rounded('attitude', each.attitude)}"
            file.write(f"list {each.stamp / 1000:.3f}  {pose}\n")
            for o in each.obstacles:
                file.write(
                    f"{o.id} {o.kind}  {rounded('confidence', [o.confidence])}"
                    f"  {rounded('position', o.center)}  {rounded('size', o.size)}"
                    f"  {rounded('yaw', [o.yaw])}  {o.points}\n"
                )


def read(path):
    lists = []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[0] == "#":
                continue
            if words[0] == "list":
                stamp, *pose = map(float, words[1:])
                lists.append(List(round(stamp * 1000), pose[:3], pose[3:], []))
                continue
            values = list(map(float, words[2:]))
            lists[-1].obstacles.append(
                Obstacle(int(words[0]), words[1], values[0], values[1:4], values[4:8], values[8],
                         int(values[9]))
            )  # fmt: skip
    return lists
