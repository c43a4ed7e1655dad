"""scree train as a program, on one small terrain a part: python3 train_test.py SCREE [TEST ...]"""

import re
import sys

from programs import ProgramTest, main

SCREE = sys.argv[1]
SMALL = ("--training", "1", "--validation", "1", "--held-out", "1", "--hidden", "3")


class TrainTest(ProgramTest):
    def train(self, *arguments):
        out = self.path("network.txt")
        said = self.done(SCREE, "train", *arguments, "--out", out, "--force").stdout
        self.assertIn(f"wrote {out}", said)
        with open(out) as file:
            return file.read()

    def test_the_file_names_the_command_that_gives_it_again(self):
        mean = self.train(*SMALL, "--seed", "7", "--restarts", "3", "--average", "2")
        self.assertIn("\nhidden 6\n", mean)
        steps = re.findall(r"^# \d+ steps, best \d+: .*, validation (\d\.\d+)$", mean, re.MULTILINE)
        self.assertEqual(len(steps), 2, mean)
        self.assertEqual(steps, sorted(steps), "the best first")
        command = re.search(r"^# scree train (.*)$", mean, re.MULTILINE)[1]
        self.assertEqual(self.train(*command.split()), mean)

    def test_what_does_not_fit_together_is_refused_before_the_work(self):
        for wrong, reason in (
            (("--restarts", "2", "--average", "3"), "--average 3 takes more networks than"),
            (("--average", "2", "--hidden", "33"), "--average 2 times --hidden 33 is more than"),
            (("--average", "0"), "--average"),
            (("--hidden", "65"), "--hidden"),
            (("--profile", "moon"), "--profile"),
        ):
            result = self.run_to_end(SCREE, "train", "--out", self.path("none.txt"), *wrong)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(reason, result.stderr)
            self.assertNotIn("clusters for", result.stderr + result.stdout)

    def test_it_asks_for_its_file_before_it_trains(self):
        self.assertIn("--out is required", self.done(SCREE, "train", *SMALL, code=2).stderr)
        there = self.write("network.txt", "mine")
        self.assert_fails(self.run_to_end(SCREE, "train", *SMALL, "--out", there), "--force")
        nowhere = self.run_to_end(SCREE, "train", *SMALL, "--out", self.path("no/network.txt"))
        self.assert_fails(nowhere, "there is no folder")


if __name__ == "__main__":
    main(sys.argv[2:])
