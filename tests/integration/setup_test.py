"""Robots that are set up wrong, and right: python3 setup_test.py SCREE [TEST ...]"""

import json
import os
import re
import sys

from programs import ProgramTest, main

SCREE = sys.argv[1]


class SetupTest(ProgramTest):
    def simulated(self, name, *arguments):
        """A drive that is simulated once for all tests."""
        capture = self.path(name)
        self.done(SCREE, "simulate", capture, "--seconds", "8", *arguments)
        return capture

    def changed(self, capture, **keys):
        """The capture's configuration with other values: lidar_rpy_deg=... for lidar.rpy_deg."""
        with open(os.path.join(capture, "scree.toml")) as file:
            robot = file.read()
        for name, change in keys.items():
            table, key = name.split("_", 1)
            pattern = rf"(\[{table}\]\n(?:[^\[\n].*\n)*?{key} = )(\[[^]]*\]|\S+)"
            match = re.search(pattern, robot)
            self.assertIsNotNone(match, name)
            value = change(json.loads(match[2]))
            robot = robot[: match.start(2)] + json.dumps(value) + robot[match.end(2) :]
        return self.write("changed.toml", robot)

    def said(self, capture, config=None):
        """The mistakes that `scree info` names."""
        arguments = ["--config", config] if config else []
        return json.loads(self.done(SCREE, "info", capture, "--json", *arguments).stdout)["settings"]

    def test_each_mistake_is_named_with_the_number_to_set(self):
        capture = self.simulated("mixed", "--scene", "mixed", "--seed", "70003")
        self.assertEqual(self.said(capture), [])
        mistakes = [
            ("lidar.translation looks .* too low", dict(lidar_translation=lambda v: [0, 0, 0])),
            (
                "lidar.rpy_deg looks turned by [4-6] degrees about y",
                dict(lidar_rpy_deg=lambda v: [v[0], v[1] + 5, v[2]]),
            ),
            (
                "lidar.rpy_deg looks turned by (8|9|10|11|12) degrees about z",
                dict(lidar_rpy_deg=lambda v: [v[0], v[1], v[2] + 10]),
            ),
            ("encoder.scale looks (1.9|2.[01]) times too large", dict(encoder_scale=lambda v: 2 * v)),
            ("encoder.scale looks of the wrong sign: set 0.00015", dict(encoder_scale=lambda v: -v)),
            (
                "imu.rpy_deg looks turned by 180 degrees about z",
                dict(imu_rpy_deg=lambda v: [-v[0], -v[1], v[2] + 180]),
            ),
            (
                "imu.rpy_deg looks turned by 180 degrees about [xy]",
                dict(imu_rpy_deg=lambda v: [v[0] + 180, v[1], v[2]]),
            ),
        ]
        for sentence, keys in mistakes:
            said = self.said(capture, self.changed(capture, **keys))
            self.assertTrue(any(re.search(sentence, each) for each in said), (sentence, said))

    def test_detect_says_it_too_and_goes_on(self):
        capture = self.simulated("mixed", "--scene", "mixed", "--seed", "70003")
        config = self.changed(capture, encoder_scale=lambda v: 2 * v)
        result = self.done(SCREE, "detect", capture, "--config", config)
        self.assertRegex(result.stderr, "scree: encoder.scale looks .* times too large: set ")
        self.assertGreater(len(result.stdout.splitlines()), 70)

    def test_nothing_is_said_of_right_robots(self):
        drives = [
            ("ditch", "70005", []),
            ("rough", "70016", ["--turns"]),
            ("street", "70034", ["--people", "4"]),
            ("quarry", "70082", []),
        ]
        for scene, seed, more in drives:
            capture = self.simulated(scene, "--scene", scene, "--seed", seed, *more)
            self.assertEqual(self.said(capture), [], scene)


if __name__ == "__main__":
    main(sys.argv[2:])
