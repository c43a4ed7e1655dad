"""scree-spy: python3 spy_test.py SCREE_SPY PYTHON_TYPES PICTURE [TEST ...]
PYTHON_TYPES is the folder of the types' module, PICTURE where a picture of the screen is left."""

import math
import os
import shutil
import subprocess
import sys
import time

from lcm_sender import Sender
from programs import PATIENCE, ProgramTest, main
from virtual_screen import VirtualScreen

SPY, TYPES, PICTURE = sys.argv[1:4]
sys.path.insert(0, TYPES)
import scree  # noqa: E402

# As ObstacleView.java has them.
ROCK, HOLE, ROBOT, OLD = (60, 110, 220), (220, 60, 50), (0, 120, 60), (150, 150, 150)


def box(number, kind, x, y):
    """A robot at (10, -4) that looks along the y axis of `odom` sees it there, forward and left."""
    one = scree.obstacle_t()
    one.id, one.kind, one.confidence, one.height = number, kind, 0.9, 0.4 * kind
    one.center, one.extent, one.yaw = [10 - y, -4 + x, 1.2], [1.4, 0.7, 0.4], 0.3
    if kind < 0:
        # A metre to the right of the box, so that what is drawn tells which of the two it is.
        corners = ((0.5, -0.3), (1.5, -0.3), (1.5, 0.3), (0.5, 0.3))
        one.evidence, one.corners = scree.obstacle_t.INSIDE, len(corners)
        one.footprint = [[one.center[0] + dx, one.center[1] + dy] for dx, dy in corners]
    return one


def found():
    message = scree.obstacle_list_t()
    message.p, message.q = [10, -4, 1], [math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
    message.obstacles = [box(3, 1, 8, 0), box(4, -1, 4, 7)]
    message.size = len(message.obstacles)
    return message


class SpyTest(ProgramTest):
    def setUp(self):
        super().setUp()
        for program in ["Xvfb", "xdotool"]:
            if shutil.which(program) is None:
                self.skipTest(f"{program} is not installed")
        self.screen = VirtualScreen(self.folder)
        self.addCleanup(self.screen.stop)

    def do(self, *command):
        return subprocess.run(
            ["xdotool", *command], env=self.screen.environment, capture_output=True, text=True
        ).stdout

    def until(self, what, holds):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            result = holds()
            if result:
                return result
            time.sleep(0.2)
        self.screen.save(PICTURE)
        self.fail(f"{what} did not come within {PATIENCE} s; the screen: {PICTURE}")

    def start_spy(self):
        spy = self.start(SPY, "--url", self.url, env=self.screen.environment)
        said = []
        for line in spy.stdout:
            said.append(line)
            if "plugins" in line:
                break
        else:
            self.skipTest(spy.stderr.read().strip())
        self.assertIn("Found 9 LCM types\n", said)
        self.assertEqual(said[-1], "Found 1 plugins\n")

    def open_view(self):
        """A double click on the only channel opens the plug-in."""
        if self.do("search", "--name", "^SCREE_OBSTACLES$"):
            return True
        window = self.do("search", "--name", "^LCM Spy$").split()
        if window:
            self.do("mousemove", "--window", window[0], "60", "30", "click", "--repeat", "2", "1")
            time.sleep(1)
        return False

    def test_a_double_click_draws_the_list_from_above(self):
        sender = Sender(self.url, {"SCREE_OBSTACLES": found()})
        self.addCleanup(lambda: sender.stopped.is_set() or sender.stop())
        self.start_spy()
        self.until("the view", self.open_view)
        rock = self.until("a rock", lambda: self.screen.middle_of(ROCK))
        time.sleep(1)
        rock, hole, robot = (self.screen.middle_of(colour) for colour in (ROCK, HOLE, ROBOT))
        self.screen.save(PICTURE)
        metre = (robot[1] - rock[1]) / 8
        self.assertGreater(metre, 10)
        # The middle of the robot's arrow is a little behind its origin.
        self.assertAlmostEqual((robot[0] - rock[0]) / metre, 0, delta=0.1)
        self.assertAlmostEqual((rock[0] - hole[0]) / metre, 6, delta=0.2)
        self.assertAlmostEqual((hole[1] - rock[1]) / metre, 4, delta=0.2)

        sender.stop()
        self.until("its age", lambda: self.screen.middle_of(OLD))
        self.assertIsNone(self.screen.middle_of(ROCK))

    def test_it_says_what_is_missing(self):
        result = self.run_to_end(SPY, env={**os.environ, "DISPLAY": ""})
        self.assert_fails(result, "")
        self.assertEqual(self.run_to_end(SPY, "--colour").returncode, 2)


if __name__ == "__main__":
    main(sys.argv[4:])
