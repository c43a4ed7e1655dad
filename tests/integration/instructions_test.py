"""What a drive costs, counted: python3 instructions_test.py SCREE

Times on a shared machine say little. The instructions of `scree detect`, which valgrind counts, are
nearly the same on every computer.
"""

import platform
import re
import shutil
import sys
import unittest

from programs import ProgramTest, main

SCREE = sys.argv[1]
# Millions for the drive below. After a change that is meant to cost more or less, write down the
# number that the test gives.
EXPECTED = 9_050
MOST_MORE = 1.1


@unittest.skipUnless(platform.machine() == "x86_64", "the number was counted on x86-64")
@unittest.skipUnless(shutil.which("valgrind"), "valgrind is not installed")
class InstructionsTest(ProgramTest):
    def test_a_drive_costs_no_more_than_it_did(self):
        drive = self.path("drive")
        self.done(SCREE, "simulate", drive, "--seconds", "3", "--scene", "mixed", "--speed", "1")
        count = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
        said = self.done(*count, SCREE, "detect", drive, "--out", self.path("lists.jsonl")).stderr
        millions = int(re.search(r"I +refs: +([\d,]+)", said).group(1).replace(",", "")) // 1_000_000
        self.assertLess(millions, MOST_MORE * EXPECTED, "millions of instructions")
        self.assertGreater(millions * MOST_MORE, EXPECTED, "far fewer: write down the new number")


if __name__ == "__main__":
    main(sys.argv[2:])
