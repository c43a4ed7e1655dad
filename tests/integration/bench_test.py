"""scree bench as a program: python3 bench_test.py SCREE"""

import os
import re
import sys

from programs import ProgramTest, main

SCREE = sys.argv[1]
LINE = r"(\d+) % of a core, a list +([\d.]+) ms \(median\), +([\d.]+) ms \(p99\), (\d+) voxels"


class BenchTest(ProgramTest):
    def test_a_drive_is_measured_by_stages(self):
        drive = self.path("drive")
        self.done(SCREE, "simulate", drive, "--seconds", "5", "--scene", "mixed")
        said = self.done(SCREE, "bench", drive).stdout
        share, median, p99, voxels = map(float, re.search(LINE, said).groups())
        self.assertGreater(median, 0)
        self.assertGreaterEqual(p99, median)
        self.assertGreater(voxels, 10_000)
        # At 10 Hz a list of 10 ms takes a tenth of a core.
        self.assertAlmostEqual(share, median, delta=0.5 * median + 3)
        stages = dict(re.findall(r"^(\w+) +([\d.]+)$", said, re.M))
        self.assertLess(abs(sum(map(float, stages.values())) - median), 0.5 * median)
        self.assertIn("map", stages)
        self.assertRegex(said, "This computer (suffices|just suffices|is too slow)")

    def test_without_a_capture_it_simulates_and_leaves_nothing_behind(self):
        os.mkdir(self.path("tmp"))
        said = self.done(SCREE, "bench", "--seconds", "5", env={"TMPDIR": self.path("tmp")}).stdout
        for rate in ("5 Hz", "10 Hz", "20 Hz"):
            self.assertRegex(said, rate + " +" + LINE)
        self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_a_drive_too_short_to_fill_the_map_is_refused(self):
        drive = self.path("short")
        self.done(SCREE, "simulate", drive, "--seconds", "2")
        failed = self.done(SCREE, "bench", drive, code=1)
        self.assertIn("shorter than the map takes to fill", failed.stderr)


if __name__ == "__main__":
    main(sys.argv[2:])
