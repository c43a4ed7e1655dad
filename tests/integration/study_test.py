"""scree study as a program, with tiny settings: python3 study_test.py SCREE [TEST ...]"""

import csv
import os
import struct
import sys
import zlib

from programs import ProgramTest, main

SCREE = sys.argv[1]


class StudyTest(ProgramTest):
    def test_settings_without_a_robot_are_studied_on_the_scenes_own(self):
        config, out = self.write("scree.toml", ""), self.path("out")
        arguments = ["study", "detection", "--out", out, "--seeds", "1", "--points", "100000"]
        said = self.scree(*arguments, "--config", config).stdout
        sweeps = said[said.index("single sweeps") :]
        found, missed = (int(sweeps.split("\nall ")[1].split()[i]) for i in (0, 2))
        self.assertGreater(found + missed, 3, "the lidar has seen obstacles")

    def scree(self, *arguments, code=0):
        return self.done(SCREE, *arguments, code=code)

    def study(self, name, table, *pictures, points=300000):
        out = os.path.join(self.folder, "new", "folder")
        said = self.scree("study", name, "--out", out, "--seeds", "1", "--training", "1",
                          "--points", str(points)).stdout  # fmt: skip
        with open(os.path.join(out, table)) as file:
            text = file.read()
        self.assertIn(text, said)
        self.assertGreater(len(text.splitlines()), 2)
        for picture in pictures:
            self.check_png(os.path.join(out, picture))
        self.assertEqual(sorted(os.listdir(out)), sorted([table, *pictures]))
        return [line.split(",") for line in text.splitlines()]

    def check_png(self, path):
        """A whole PNG, and more than one colour in it."""
        with open(path, "rb") as file:
            data = file.read()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        at, pixels, kinds = 8, b"", []
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at : at + 8])
            body = data[at + 8 : at + 8 + size]
            (sum_,) = struct.unpack(">I", data[at + 8 + size : at + 12 + size])
            self.assertEqual(zlib.crc32(kind + body), sum_)
            kinds.append(kind)
            pixels += body if kind == b"IDAT" else b""
            at += 12 + size
        self.assertEqual((kinds[0], kinds[-1]), (b"IHDR", b"IEND"))
        self.assertGreater(len(set(zlib.decompress(pixels))), 16)

    def test_training(self):
        rows = self.study("training", "training.csv", "training.png")
        self.assertEqual(rows[1][0], "0")
        first, last = [float(v) for v in rows[1][1:]], [float(v) for v in rows[-1][1:]]
        self.assertEqual(len(set(first)), 1)  # all from the same weights
        self.assertTrue(all(after < before for before, after in zip(first, last)))

    def test_clustering(self):
        self.study("clustering", "clustering.csv", "clustering.png")

    def test_seed_distance(self):
        rows = self.study("seed-distance", "seed-distance.csv", "seed-distance.png")
        self.assertTrue(all(0 <= float(value) <= 1 for row in rows[1:] for value in row[1:]))

    def test_stages(self):
        rows = self.study("stages", "stages.csv", "stages.png")
        self.assertEqual([row[1] for row in rows[1:]], ["914608", "413591", "82242", "26011"])
        counts = [int(row[2]) for row in rows[1:]]
        self.assertEqual(counts, sorted(counts, reverse=True))

    def test_result(self):
        self.study("result", "result.csv", "result.png")

    def test_classifiers(self):
        rows = self.study("classifiers", "classifiers.csv", "classifiers.png", points=600000)
        self.assertEqual([row[-3:] for row in rows][-1], ["0.963", "0.988", "0.975"])

    def test_changes(self):
        rows = self.study("changes", "changes.csv", "changes.png")
        self.assertIn("paper", rows[1][0])
        for row in rows[1:]:
            self.assertTrue(all(0 <= float(share) <= 1 for share in row[1:6]), row)
            self.assertLessEqual(int(row[7]), int(row[6]))  # pairs parted

    def test_detection(self):
        self.study("detection", "detection.txt", "detection.png", "detection-sweeps.png")

    def test_drives(self):
        said = self.scree("study", "drives", "--out", self.folder, "--seeds", "1",
                          "--seconds", "1").stdout  # fmt: skip
        scenes = ["easy", "rolling", "rough", "crater", "ditch", "grass", "mixed", "cliff", "kerb",
                  "wood", "meadow", "boulders", "street", "quarry"]  # fmt: skip
        with open(self.path("drives.txt")) as file:
            text = file.read()
        self.assertIn(text, said)
        for goal in ("f1", "coverage", "drift_largest", "yaw_largest", "map_rms_m"):
            self.assertRegex(text, rf"(?m)^{goal} +[<>]= \S+ +\d\S* +\w+ +(not )?met")
        self.assertRegex(text, r"cost_of_faults .* not measured")  # too short for faults
        with open(self.path("drives.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["scene"] for row in rows], scenes)
        for row in rows:
            self.assertEqual(float(row["coverage"]), 1)
            self.assertTrue(0 <= float(row["f1_single_sweeps"]) <= 1)
            self.assertGreater(float(row["map_points"]), 1000)
            self.assertLess(float(row["map_rms_m"]), 0.1)
            self.assertEqual(row["f1_with_faults"], "")
        self.check_png(self.path("drives.png"))

    def test_hardly_any_points_are_no_crash(self):
        for name in ("training", "clustering", "seed-distance", "stages", "result", "detection"):
            self.scree("study", name, "--out", self.folder, "--seeds", "1", "--points", "1000")
        again = self.run_to_end(SCREE, "study", "stages", "--out", self.folder, "--points", "1000")
        self.assert_fails(again, "stages.", "--force")

    def test_failures_are_one_sentence(self):
        for arguments in (["stages", "--out", "/dev/null/x"], ["stages", "--out", "/proc"]):
            said = self.scree("study", *arguments, "--seeds", "1", "--points", "1000", code=1)
            self.assertEqual(len(said.stderr.splitlines()), 1, said.stderr)

    def test_wrong_usage_exits_2(self):
        self.scree("study", code=2)
        self.scree("study", "stages", code=2)
        self.scree("study", "nothing", "--out", self.folder, code=2)
        self.scree("study", "stages", "--out", self.folder, "--seeds", "0", code=2)


if __name__ == "__main__":
    main(sys.argv[2:])
