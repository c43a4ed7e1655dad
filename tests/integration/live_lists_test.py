"""screed and scree detect on one capture: python3 live_lists_test.py SCREED SCREE [TEST ...]"""

import json
import math
import os
import sys

from live_daemon import Lines, LiveDaemonTest
from live_sensors import Player
from programs import PATIENCE, main
from reference_scoring import in_base

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]


def same_obstacles(a, b):
    """How many obstacles two lists share, and how many each has."""
    places = [
        [(each["kind"], in_base(one["pose"], each["center"])) for each in one["obstacles"]]
        for one in (a, b)
    ]
    left, same = list(places[1]), 0
    for kind, place in places[0]:
        near = [each for each in left if each[0] == kind and math.dist(each[1], place) < 0.3]
        if near:
            left.remove(min(near, key=lambda each: math.dist(each[1], place)))
            same += 1
    return same, len(places[0]), len(places[1])


class LiveListsTest(LiveDaemonTest):
    def play(self, capture):
        """Plays all of it to a screed. Returns the player."""
        self.start_daemon()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        player = Player(capture, self.port, self.position_port, self.mti)
        player.wait()
        player.stop()
        self.say("no packets on")
        return player

    def test_its_lists_are_those_of_scree_detect(self):
        """As far as nothing is late; the stamps are those of this playing, so not to the bit."""
        capture = self.simulate()
        os.remove(os.path.join(capture, "can.log"))
        offline = self.path("offline.jsonl")
        self.done(self.scree, "detect", capture, "--out", offline)
        watched = Lines(self.start(self.scree, "watch", "--url", self.url, "--grid").stdout)
        player = self.play(capture)
        health = "".join(self.health.lines)
        if "dropped" in health or "without all motion" in health:
            self.skipTest("this machine was too slow: sweeps were dropped, or had not all motion")
        with open(offline) as file:
            alone = [json.loads(line) for line in file]
        live = [json.loads(line) for line in self.lists.lines]
        self.assertGreater(len(live), len(alone) - 5)
        grids = [line for line in watched.lines if "grid of 120 x 120 cells of 0.2 m: " in line]
        self.assertGreater(len(grids), len(live) - 5)  # none before IMU or encoder have spoken
        self.assertLessEqual(len(grids), len(live))
        self.assertNotIn(" 0 free", grids[-1])
        both = missed = added = 0
        for here in live:
            stamp = here["stamp_ns"] - player.later_ns
            there = min(alone, key=lambda each: abs(each["stamp_ns"] - stamp))
            self.assertLess(abs(there["stamp_ns"] - stamp), 30e6)
            same, all_here, all_there = same_obstacles(here, there)
            both, added, missed = both + same, added + all_here - same, missed + all_there - same
        print(f"{both} obstacles in both, {added} in the daemon's lists alone, {missed} missed")
        self.assertGreater(both, 100)
        self.assertLess(added + missed, 0.2 * both)

    def test_a_turn_may_have_several_lists(self):
        """As many as there is time for: of parts that wait the newest is taken."""
        capture = self.simulate()
        with open(self.config, "a") as file:
            file.write("[detect]\nlists_per_turn = 8\n")
        self.play(capture)
        stamps = [json.loads(line)["stamp_ns"] for line in self.lists.lines]
        self.assertEqual(stamps, sorted(set(stamps)))
        turns = sum(1e8 - 2e6 < b - a < 1e8 + 2e6 for a, b in zip(stamps, stamps[1:]))
        parts = sum(b - a < 9e7 for a, b in zip(stamps, stamps[1:]))
        if len(stamps) < 55:
            self.skipTest(f"this machine was too slow: {len(stamps)} lists of 60 turns")
        print(f"{len(stamps)} lists of 60 turns; {turns} came a turn after the one before")
        self.assertGreater(parts, 5)
        self.assertIn("parts of turns a second: detect.lists_per_turn asks", "".join(self.log.lines))


if __name__ == "__main__":
    main(sys.argv[3:])
