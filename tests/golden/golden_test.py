"""scree detect against the pinned lists: python3 golden_test.py SCREE DATA [TEST ...]"""

import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "integration"))

import inputs  # noqa: E402
import pinned  # noqa: E402
import programs  # noqa: E402
from differences import Differences, table  # noqa: E402

SCREE, DATA = sys.argv[1:3]


class GoldenTest(programs.ProgramTest):
    def check(self, name):
        made = inputs.Inputs(self.done, SCREE, DATA, self.folder)
        try:
            lists = made.lists(name)
        except inputs.Missing as missing:
            self.skipTest(str(missing))
        found = Differences(pinned.read(inputs.lists_file(name)), lists)
        if found:
            self.fail(f"not as pinned; tests/golden/README.md says what to do\n{table({name: found})}")

    def test_cloud(self):
        self.check("cloud")

    def test_cloud_paper(self):
        self.check("cloud_paper")

    def test_drive(self):
        self.check("drive")

    def test_drive_faults(self):
        self.check("drive_faults")

    def test_lidar_alone(self):
        self.check("lidar_alone")

    def test_sweeps(self):
        self.check("sweeps")

    def test_interop(self):
        self.check("interop")

    def differences(self, change):
        """What is found where a pinned drive was changed."""
        old = pinned.read(inputs.lists_file("drive"))
        new = pinned.read(inputs.lists_file("drive"))
        change(new)
        return Differences(old, new)

    def change_one(self, **values):
        def change(lists):
            lists[20].obstacles[3] = lists[20].obstacles[3]._replace(**values)

        return self.differences(change)

    def test_what_rounding_does_is_no_difference(self):
        old = pinned.read(inputs.lists_file("drive"))[20].obstacles[3]
        self.assertFalse(self.differences(lambda lists: None))
        self.assertFalse(self.change_one(center=[v + 0.0099 for v in old.center]))
        self.assertFalse(self.change_one(size=[v - 0.0199 for v in old.size]))
        self.assertFalse(self.change_one(yaw=old.yaw + 184))
        self.assertFalse(self.change_one(confidence=old.confidence - 0.049))

    def test_every_other_difference_is_found_and_said(self):
        old = pinned.read(inputs.lists_file("drive"))[20].obstacles[3]
        for column, values in {
            "moved": {"center": [old.center[0] + 0.0101, *old.center[1:]]},
            "size": {"size": [*old.size[:3], old.size[3] + 0.0201]},
            "yaw": {"yaw": old.yaw + 90},
            "confidence": {"confidence": old.confidence - 0.051},
            "points": {"points": old.points * 2 + 2},
            "kind": {"kind": "other"},
            "id": {"id": 999},
        }.items():
            found = self.change_one(**values)
            self.assertEqual([key for key, count in found.counts.items() if count], [column])
            self.assertEqual(found.changed, [20])
            self.assertIn("drive: lists 20\n  list 20: ", table({"drive": found}))
        far = self.change_one(center=[v + 1 for v in old.center])
        self.assertEqual((far.counts["gone"], far.counts["new"]), (1, 1))
        self.assertEqual(self.differences(lambda lists: lists.pop(7)).missing, [7])

        def append(lists):
            lists.append(lists[-1]._replace(stamp=lists[-1].stamp + 100))

        self.assertEqual(len(self.differences(append).added), 1)


if __name__ == "__main__":
    programs.main(sys.argv[3:])
