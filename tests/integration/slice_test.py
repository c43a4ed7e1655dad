"""scree slice as a program: python3 slice_test.py SCREE [TEST ...]"""

import json
import os
import sys

from pcap_file import pcap_records
from programs import ProgramTest, main

SCREE = sys.argv[1]


class SliceTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.whole, self.part = self.path("whole"), self.path("part")
        self.done("simulate", self.whole, "--seconds", "3", "--scene", "easy")

    def done(self, *command):
        return super().done(SCREE, *command)

    def records(self, capture, name):
        return list(pcap_records(os.path.join(capture, name)))

    def begin(self):
        return min(self.records(self.whole, name)[0][0] for name in ["lidar.pcap", "imu.pcap"])

    def text(self, capture, name):
        with open(os.path.join(capture, name)) as file:
            return file.read()

    def test_it_has_what_came_in_that_time(self):
        self.done("slice", self.whole, self.part, "--from", "1", "--to", "2.5")
        first = self.begin()
        for name in ["lidar.pcap", "imu.pcap"]:
            wanted = [record for record in self.records(self.whole, name)
                      if first + 10**9 <= record[0] < first + 2_500_000_000]  # fmt: skip
            self.assertEqual(self.records(self.part, name), wanted)
        lines = self.text(self.whole, "can.log").splitlines()
        part = self.text(self.part, "can.log").splitlines()
        at = lines.index(part[0])
        self.assertEqual(part, lines[at : at + len(part)])
        self.assertAlmostEqual(len(part) / len(lines), 0.5, delta=0.1)
        self.assertEqual(self.text(self.part, "scree.toml"), self.text(self.whole, "scree.toml"))

    def test_it_is_detected_in_and_scored(self):
        self.done("slice", self.whole, self.part, "--from", "1")
        truth = json.loads(self.text(self.part, "truth.json"))
        self.assertEqual(truth["obstacles"], json.loads(self.text(self.whole, "truth.json"))["obstacles"])
        lists = self.path("lists.jsonl")
        self.done("detect", self.part, "--out", lists)
        score = json.loads(
            self.done("evaluate", os.path.join(self.part, "truth.json"), lists, "--json").stdout
        )
        self.assertEqual(score["coverage"], 1)
        self.assertGreater(score["all"]["f1"], 0.5)

    def test_nothing_of_an_older_capture_stays(self):
        self.done("simulate", self.part, "--seconds", "1", "--scene", "rough")
        self.done("slice", os.path.join(self.whole, "lidar.pcap"), self.part, "--to", "0.5", "--force")
        self.assertEqual(os.listdir(self.part), ["lidar.pcap"])
        config = os.path.join(self.part, "scree.toml")
        with open(config, "w") as file:
            file.write("[lidar]\nmin_range = 0.7\n")
        self.done("slice", self.whole, self.part, "--config", config, "--force")
        self.assertIn("0.7", self.text(self.part, "scree.toml"))

    def test_a_file_becomes_a_folder(self):
        lidar = os.path.join(self.whole, "lidar.pcap")
        self.done("slice", lidar, self.part, "--to", "0.5")
        self.assertEqual(os.listdir(self.part), ["lidar.pcap"])
        part = self.records(self.part, "lidar.pcap")
        self.assertEqual(part, self.records(self.whole, "lidar.pcap")[: len(part)])

    def test_what_cannot_be_cut_is_one_sentence(self):
        for times, words in [(["--from", "9"], "from 9 s on"),
                             (["--from", "8", "--to", "9"], "from 8 s to 9 s")]:  # fmt: skip
            result = self.run_to_end(SCREE, "slice", self.whole, self.part, *times)
            self.assert_fails(result, f"{self.whole} is 3.", "nothing is there " + words)
        self.assertFalse(os.path.exists(self.part))
        result = self.run_to_end(SCREE, "slice", self.whole, self.part, "--from", "2", "--to", "1")
        self.assertEqual(result.returncode, 2)
        result = self.run_to_end(SCREE, "slice", self.whole, self.whole, "--to", "1")
        self.assert_fails(result, "a part cannot take the place")
        self.assert_fails(self.run_to_end(SCREE, "slice", self.path("none"), self.part),
                          "no such file or folder")  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[2:])
