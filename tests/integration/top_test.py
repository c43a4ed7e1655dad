"""scree top in a terminal: python3 top_test.py SCREE PYTHON_TYPES [TEST ...]
PYTHON_TYPES is the folder of the types' module."""

import fcntl
import os
import select
import struct
import subprocess
import sys
import termios
import time

from lcm_sender import Sender
from programs import PATIENCE, ProgramTest, main

SCREE, TYPES = sys.argv[1:3]
sys.path.insert(0, TYPES)
import scree  # noqa: E402

try:
    import pyte
except ImportError:
    pyte = None


def messages():
    health = scree.health_t()
    health.state, health.version = health.OK, "7.8.9"
    health.lidar.state = health.lidar.OK
    found = scree.obstacle_list_t()
    found.q = [1, 0, 0, 0]
    rock = scree.obstacle_t()
    rock.id, rock.kind, rock.center, rock.height = 42, 1, [4, 3, 0], 0.35
    found.size, found.obstacles = 1, [rock]
    return {"SCREE_HEALTH": health, "SCREE_OBSTACLES": found}


class TopTest(ProgramTest):
    def setUp(self):
        super().setUp()
        if pyte is None:
            self.skipTest("pyte is not installed (tests/requirements.txt)")
        self.terminal, self.inside = os.openpty()
        self.addCleanup(os.close, self.terminal)
        self.screen = pyte.Screen(80, 24)
        self.stream = pyte.ByteStream(self.screen)
        self.resize(24, 80)

    def resize(self, rows, columns):
        self.screen.resize(rows, columns)
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def start_top(self, terminal="linux"):
        """TERM is one that pyte knows all of."""
        top = subprocess.Popen(
            [SCREE, "top", "--url", self.url], stdin=self.inside, stdout=self.inside,
            stderr=subprocess.PIPE, text=True, env={**os.environ, "TERM": terminal},
            preexec_fn=lambda: (os.setsid(), fcntl.ioctl(0, termios.TIOCSCTTY, 0)),
        )  # fmt: skip
        os.close(self.inside)
        self.addCleanup(top.stderr.close)
        self.addCleanup(top.wait)
        self.addCleanup(top.kill)
        return top

    def shows(self, *words):
        end = time.monotonic() + PATIENCE
        while not all(any(word in line for line in self.screen.display) for word in words):
            if time.monotonic() > end:
                self.fail(f"{words} did not come; on the terminal:\n" + "\n".join(self.screen.display))
            if select.select([self.terminal], [], [], 0.1)[0]:
                self.stream.feed(os.read(self.terminal, 1 << 16))

    def test_it_shows_what_comes_fits_the_terminal_and_ends_with_q(self):
        top = self.start_top()
        self.shows("no health yet", "does screed run")
        sender = Sender(self.url, messages())
        self.addCleanup(lambda: sender.stopped.is_set() or sender.stop())
        self.shows("screed 7.8.9", "SEES", "lidar   ok", "imu     off",
                   "42    rock    5.00   37 L", "TIME, ms", "^")  # fmt: skip
        self.resize(10, 46)
        self.screen.reset()
        self.shows("screed 7.8.9", "SENSOR", "42    rock")
        self.assertFalse(any("TIME, ms" in line for line in self.screen.display))
        sender.stop()
        self.shows("no health for 3 s", "NO LIST for")
        os.write(self.terminal, b"q")
        self.assertEqual(top.wait(PATIENCE), 0)

    def test_it_works_without_colours_and_ends_when_interrupted(self):
        top = self.start_top("vt100")
        self.shows("no health yet")
        os.write(self.terminal, b"\x03")
        self.assertEqual(top.wait(PATIENCE), 0)

    def test_an_unknown_terminal_is_said(self):
        top = self.start_top("no-such-terminal")
        self.assertEqual(top.wait(PATIENCE), 1)
        self.assertIn("TERM is no-such-terminal", top.stderr.read())

    def test_it_needs_a_terminal(self):
        self.assert_fails(self.run_to_end(SCREE, "top", "--url", self.url), "terminal", "scree watch")
        os.close(self.inside)


if __name__ == "__main__":
    main(sys.argv[3:])
