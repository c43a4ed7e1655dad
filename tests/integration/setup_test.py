"""Robots that are set up wrong, and right: python3 setup_test.py SCREE [TEST ...]"""

import json
import os
import re
import sys
import tomllib

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

    def test_messages_that_take_longer_than_set_are_named(self):
        capture = self.simulated("mixed", "--scene", "mixed", "--seed", "70003")
        with open(os.path.join(capture, "scree.toml")) as file:
            robot = file.read()
        for delay, word in [(0.08, "large"), (-0.08, "small")]:
            config = self.write("late.toml", robot.replace("[imu]\n", f"[imu]\ndelay = {delay}\n"))
            [said] = self.said(capture, config)
            self.assertRegex(said, f"imu.delay looks 0.(0[6-9]|1) s too {word}: set -?0")

    def test_detect_says_it_too_and_goes_on(self):
        capture = self.simulated("mixed", "--scene", "mixed", "--seed", "70003")
        config = self.changed(capture, encoder_scale=lambda v: 2 * v)
        result = self.done(SCREE, "detect", capture, "--config", config)
        self.assertRegex(result.stderr, "scree: encoder.scale looks .* times too large: set ")
        self.assertGreater(len(result.stdout.splitlines()), 70)

    def test_nothing_is_said_of_right_robots(self):
        drives = [("rough", "70016", ["--turns"]), ("street", "70034", ["--people", "4"])]
        for scene, seed, more in drives:
            capture = self.simulated(scene, "--scene", scene, "--seed", seed, *more)
            self.assertEqual(self.said(capture), [], scene)

    def values(self, capture, *arguments):
        """What `scree calibrate` says of each value, by "key part"."""
        said = json.loads(self.done(SCREE, "calibrate", capture, "--json", *arguments).stdout)
        return {f"{each['key']} {each['part']}".strip(): each for each in said}

    def test_a_minutes_drive_calibrates_a_robot_that_is_set_up_wrong(self):
        capture = self.path("turning")
        drive = ["--scene", "mixed", "--seed", "70005", "--seconds", "40", "--turns"]
        self.done(SCREE, "simulate", capture, *drive)
        with open(os.path.join(capture, "scree.toml")) as file:
            robot = tomllib.loads(file.read())
        config = self.changed(
            capture,
            lidar_translation=lambda v: [0, v[1], 0],
            lidar_rpy_deg=lambda v: [v[0] + 8, v[1] - 10, v[2] + 9],
            imu_rpy_deg=lambda v: [v[0], v[1], v[2] + 170],
            encoder_scale=lambda v: -2 * v,
        )
        drop_in, picture = self.path("changed.d/mounts.toml"), self.path("drive.png")
        os.mkdir(self.path("changed.d"))
        found = self.values(capture, "--config", config, "--out", drop_in, "--picture", picture)
        true = {
            "encoder.scale": (robot["encoder"]["scale"], 0.015 * robot["encoder"]["scale"]),
            "lidar.translation x": (robot["lidar"]["translation"][0], 0.05),
            "lidar.translation z": (robot["lidar"]["translation"][2], 0.02),
        }
        for table, off in [("lidar", 0.5), ("imu", 1.5)]:
            for part, angle in zip(["roll", "pitch", "yaw"], robot[table]["rpy_deg"]):
                true[f"{table}.rpy_deg {part}"] = (angle, off)
        for name, (value, off) in true.items():
            each = found[name]
            self.assertIn("found", each, name)
            away = each["found"] - value
            away = (away + 180) % 360 - 180 if "rpy" in name else away
            self.assertLess(abs(away), off, name)
            self.assertLess(abs(away), 4 * each["deviation"], name)
        self.assertTrue(found["encoder.scale"]["contradicts"])
        with open(picture, "rb") as file:
            self.assertEqual(file.read(4), b"\x89PNG")

        # With the drop-in it drives as set.
        again = self.values(capture, "--config", config)
        self.assertEqual([name for name, each in again.items() if each.get("contradicts")], [])
        self.assertEqual(self.said(capture, config), [])
        failed = self.run_to_end(SCREE, "calibrate", capture, "--config", config, "--out", drop_in)
        self.assert_fails(failed, "mounts.toml", "--force")

    def test_a_robot_that_stands_shows_nothing_of_its_mounts(self):
        capture = self.simulated("standing", "--at-rest")
        failed = self.run_to_end(SCREE, "calibrate", capture)
        self.assert_fails(failed, "shows nothing of the mounts")


if __name__ == "__main__":
    main(sys.argv[2:])
