"""What differs between pinned lists and new ones, and the table that says it."""

import math

from pinned import STEPS

SAME_PLACE = 0.5  # metres; farther apart, two obstacles are one that is gone and one that is new
DETAILS = 12  # lines for each input

COLUMNS = ["gone", "new", "kind", "moved", "size", "yaw", "confidence", "points", "id", "pose"]
WORDS = {  # how a change of each column reads
    "moved": "m moved", "size": "m of its size", "yaw": "degrees turned",
    "confidence": "of confidence", "points": "points", "pose": "m or of the attitude",
}  # fmt: skip


class Differences:
    """Counts of a pair of lists files by column, the largest of each, and a line for every change."""

    def __init__(self, pinned, new):
        self.lists = len(new)
        self.changed = []  # numbers of the lists
        self.counts = dict.fromkeys(COLUMNS, 0)
        self.largest = dict.fromkeys(WORDS, 0.0)
        self.missing, self.added, self.lines = [], [], []
        for number, old_list, new_list in paired_lists(pinned, new):
            before = len(self.lines)
            if new_list is None:
                self.missing.append(number)
                self.lines.append((-1, number, f"is missing, pinned at {old_list.stamp / 1000:.3f} s"))
            elif old_list is None:
                self.added.append(number)
                self.lines.append((-1, number, f"is new, at {new_list.stamp / 1000:.3f} s"))
            else:
                self.compare(number, old_list, new_list)
            if len(self.lines) > before:
                self.changed.append(number)

    def __bool__(self):
        return bool(self.lines)

    def compare(self, number, old_list, new_list):
        apart = max(steps(old_list.position, new_list.position, "position"),
                    steps(old_list.attitude, new_list.attitude, "attitude"))  # fmt: skip
        if apart > 1:
            self.add(number, "pose", "the robot", apart * STEPS["position"])
        for old, new in paired_obstacles(old_list.obstacles, new_list.obstacles):
            if new is None:
                self.add(number, "gone", named(old))
            elif old is None:
                self.add(number, "new", named(new))
            else:
                self.compare_obstacle(number, old, new)

    def compare_obstacle(self, number, old, new):
        name = named(old)
        if old.kind != new.kind:
            self.add(number, "kind", f"{name} is {new.kind} now")
        if old.id != new.id:
            self.add(number, "id", f"{name} is {new.id} now")
        for column, kind, pair in [
            ("moved", "position", (old.center, new.center)),
            ("size", "size", (old.size, new.size)),
            ("yaw", "yaw", ([0], [turned(old.yaw, new.yaw)])),
            ("confidence", "confidence", ([old.confidence], [new.confidence])),
        ]:
            apart = steps(*pair, kind)
            if apart > 1:
                self.add(number, column, name, apart * STEPS[kind])
        if abs(new.points - old.points) > 1 + old.points // 50:
            self.add(number, "points", name, abs(new.points - old.points))

    def add(self, number, column, name, size=None):
        self.counts[column] += 1
        text = f"{column}: {name}"
        if size is not None:
            self.largest[column] = max(self.largest[column], size)
            text = f"{name}: {size:.4g} {WORDS[column]}"
        self.lines.append((COLUMNS.index(column), number, text))

    def details(self):
        """The weightiest changes, a line each."""
        lines = [f"list {number}: {text}" for _, number, text in sorted(self.lines)]
        more = len(lines) - DETAILS
        return lines[:DETAILS] + ([f"and {more} more changes"] if more > 0 else [])


def steps(old, new, kind):
    """By how many steps two tuples differ at most; what rounding of doubles adds is no difference."""
    return max(abs(b - a) for a, b in zip(old, new)) / STEPS[kind] - 1e-6


def turned(old, new):
    """Degrees between the directions of two boxes, which are the same after half a turn."""
    return abs((new - old + 90) % 180 - 90)


def named(obstacle):
    place = " ".join(f"{value:.2f}" for value in obstacle.center)
    return f"{obstacle.id} {obstacle.kind} at {place}, confidence {obstacle.confidence:.2f}"


def paired_lists(pinned, new):
    """Number, pinned and new list of the same millisecond, give or take one; None for no partner."""
    pairs, i, j = [], 0, 0
    while i < len(pinned) or j < len(new):
        later = math.inf
        old_stamp = pinned[i].stamp if i < len(pinned) else later
        new_stamp = new[j].stamp if j < len(new) else later
        take_old, take_new = old_stamp <= new_stamp + 1, new_stamp <= old_stamp + 1
        number = i if take_old else j
        pairs.append((number, pinned[i] if take_old else None, new[j] if take_new else None))
        i, j = i + take_old, j + take_new
    return pairs


def paired_obstacles(old, new):
    """Pinned and new obstacles at the same place, those of the same id first; None for no partner."""
    distances = sorted(
        (a.id != b.id, math.dist(a.center, b.center), i, j)
        for i, a in enumerate(old)
        for j, b in enumerate(new)
        if math.dist(a.center, b.center) <= SAME_PLACE
    )
    partners = {}
    for _, _, i, j in distances:
        if i not in partners and j not in partners.values():
            partners[i] = j
    alone = set(range(len(new))) - set(partners.values())
    return [(a, new[partners[i]] if i in partners else None) for i, a in enumerate(old)] + [
        (None, new[j]) for j in sorted(alone)
    ]


def ranges(numbers):
    """Sorted numbers as text: 1-3, 7."""
    runs = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(f"{a}-{b}" if b > a else f"{a}" for a, b in runs)


def table(results):
    """Text for {input: Differences}: a row for each input, then what changed in which lists."""
    head = ["input", "lists", "changed", "missing", "added", *COLUMNS,
            "most moved", "most size", "most confidence"]  # fmt: skip
    rows = [head]
    for name, found in results.items():
        largest = [f"{found.largest[column]:.2f}" for column in ("moved", "size", "confidence")]
        counts = [found.lists, len(found.changed), len(found.missing), len(found.added)]
        counts += found.counts.values()
        rows.append([name, *(str(count or ".") for count in counts), *largest])
    widths = [max(map(len, column)) for column in zip(*rows)]
    text = [
        "  ".join([row[0].ljust(widths[0])] + [w.rjust(n) for w, n in zip(row[1:], widths[1:])])
        for row in rows
    ]
    for name, found in results.items():
        if found:
            text += ["", f"{name}: lists {ranges(found.changed)}"]
            text += [f"  {line}" for line in found.details()]
    return "\n".join(text)
