"""The scoring of lists once more, with shapely, to hold `scree evaluate` against."""

import json
import math

from shapely import Point, Polygon

NEAR_NS = 60_000_000


def rotate(q, v, back=False):
    """A vector turned by a quaternion [w, x, y, z]; back: by its inverse."""
    w, u = q[0], [-c if back else c for c in q[1:]]
    cross = lambda a, b: [  # noqa: E731
        a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
    ]  # fmt: skip
    t = [2 * c for c in cross(u, v)]
    return [v[i] + w * t[i] + cross(u, t)[i] for i in range(3)]


def slerp(a, b, share):
    dot = sum(x * y for x, y in zip(a, b))
    if dot < 0:
        b, dot = [-x for x in b], -dot
    if dot > 1 - 1e-12:
        return b
    angle = math.acos(dot)
    one, two = math.sin((1 - share) * angle), math.sin(share * angle)
    return [(one * x + two * y) / math.sin(angle) for x, y in zip(a, b)]


def true_pose(truth, t_ns):
    poses = truth["poses"]
    if t_ns <= poses[0]["t_ns"]:
        return poses[0]
    for before, after in zip(poses, poses[1:]):
        if before["t_ns"] <= t_ns <= after["t_ns"]:
            share = (t_ns - before["t_ns"]) / max(1, after["t_ns"] - before["t_ns"])
            p = [x + share * (y - x) for x, y in zip(before["p"], after["p"])]
            return {"p": p, "q": slerp(before["q"], after["q"], share)}
    return poses[-1]


def in_base(pose, point):
    return rotate(pose["q"], [a - b for a, b in zip(point, pose["p"])], back=True)[:2]


class Thing:
    """A footprint in base with its centre."""

    def __init__(self, pose, center, corners):
        self.center = in_base(pose, center)
        self.polygon = Polygon([in_base(pose, [x, y, center[2]]) for x, y in corners])


def box_corners(obstacle):
    c, s = math.cos(obstacle["yaw"]), math.sin(obstacle["yaw"])
    x, y = obstacle["center"][:2]
    length, width = obstacle["extent"][0] / 2, obstacle["extent"][1] / 2
    return [
        (x + c * a * length - s * b * width, y + s * a * length + c * b * width)
        for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
    ]


def can_match(detection, obstacle):
    if obstacle.polygon.distance(Point(detection.center)) <= 0.3:
        return True
    if detection.polygon.area == 0:
        return False
    shared = obstacle.polygon.intersection(detection.polygon).area
    return shared / obstacle.polygon.union(detection.polygon).area >= 0.2


def score(truth, lists):
    """{kind: [TP, FP, FN]}, the entries that have a list, and the lists without an entry."""
    counts = {"positive": [0, 0, 0], "negative": [0, 0, 0]}
    covered, unmet = set(), 0
    kinds = {o["id"]: o["kind"] for o in truth["obstacles"]}
    visible = truth["visible"]
    for each in lists:
        stamp = each["stamp_ns"]
        if len(lists) == len(visible) == 1:
            nearest = 0
        else:
            nearest = min(range(len(visible)), key=lambda i: abs(visible[i]["t_ns"] - stamp))
            if abs(visible[nearest]["t_ns"] - stamp) > NEAR_NS:
                unmet += 1
                continue
        covered.add(nearest)
        entry = visible[nearest]
        pose = true_pose(truth, stamp)
        there = {
            o["id"]: Thing(pose, o["center"], o["footprint"]) for o in truth["obstacles"]
        }
        found = [(Thing(each["pose"], o["center"], o.get("footprint") or box_corners(o)), o["kind"])
                 for o in each["obstacles"]]  # fmt: skip
        near = sorted(
            (math.dist(obstacle.center, thing.center), number, i)
            for i, (thing, _) in enumerate(found)
            for number, obstacle in there.items()
            if can_match(thing, obstacle)
        )
        taken, used = {}, set()
        for _, number, i in near:
            if number in entry["ids"] and number not in taken and i not in used:
                taken[number] = i
                used.add(i)
        for number in entry["ids"]:
            if number in taken and found[taken[number]][1] == kinds[number]:
                counts[kinds[number]][0] += 1
                continue
            counts[kinds[number]][2] += 1
            if number in taken:
                counts[found[taken[number]][1]][1] += 1
        for i, (_, kind) in enumerate(found):
            if i in used:
                continue
            nearest_id = next((number for _, number, j in near if j == i), None)
            if nearest_id is None or nearest_id not in entry["ignore"]:
                counts[kind][1] += 1
    return counts, len(covered), unmet


def read(truth, detections):
    with open(truth) as file:
        read_truth = json.load(file)
    with open(detections) as file:
        return read_truth, [json.loads(line) for line in file]
