"""screed takes no memory while it works: python3 allocation_test.py SCREED SCREE ALLOCATION_LOG

SCREE_TEST_SECONDS is how long it is looked at, a minute for instance.
"""

import os
import re
import signal
import sys
import time

from live_daemon import Lines, LiveDaemonTest
from live_sensors import EmulatedMti, Player
from programs import COARSE, PATIENCE, main

LiveDaemonTest.screed, LiveDaemonTest.scree, LIBRARY = sys.argv[1:4]
SECONDS = float(os.environ.get("SCREE_TEST_SECONDS", "10"))
START = 5  # seconds from its start until it has worked for more than one
WORKERS = ("lidar", "imu", "detector", "publisher")


def page_faults(process):
    """Of each thread: proc(5), the fields minflt and majflt of its stat."""
    faults = {}
    for task in os.listdir(f"/proc/{process}/task"):
        with open(f"/proc/{process}/task/{task}/stat") as file:
            name, rest = re.fullmatch(r"\d+ \((.*)\) (.*)", file.read(), re.DOTALL).groups()
        fields = rest.split()
        faults[name] = int(fields[7]) + int(fields[9])
    return faults


class AllocationTest(LiveDaemonTest):
    def test_nothing_is_taken_while_the_robot_drives(self):
        capture, log = self.path("capture"), self.path("allocations")
        seconds = str(START + SECONDS + 5)
        self.done(self.scree, "simulate", capture, "--scene", "mixed", "--seconds", seconds)
        self.mti = EmulatedMti(self.path("imu"))
        self.config = self.write_config_here(capture, self.mti.port)
        # A bus that is not there would be opened again and again, and a slow computer speaks of it.
        self.write("robot.d/quiet.toml", f'{COARSE}[encoder]\ninterface = ""\n')
        counted = {
            "LD_PRELOAD": LIBRARY,
            "ALLOCATION_LOG": log,
            "ALLOCATION_LOG_AFTER": str(START),
            "ALLOCATION_LOG_UNTIL": str(START + SECONDS - 0.5),
        }
        began = time.monotonic()
        self.daemon = self.start(
            self.screed, "--config", self.config, env={**os.environ, **counted}
        )
        log_lines = Lines(self.daemon.stderr).lines
        self.mti.plug_in()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        lists = Lines(self.start(self.scree, "watch", "--url", self.url, "--json").stdout)
        player = Player(capture, self.port, self.position_port, self.mti)
        self.addCleanup(player.stop)
        self.assertLess(time.monotonic() - began, START - 2, "the drive began too late to tell")
        time.sleep(began + START - time.monotonic())
        before, lines_before = page_faults(self.daemon.pid), len(log_lines)
        time.sleep(SECONDS)
        after, said = page_faults(self.daemon.pid), log_lines[lines_before:]
        self.daemon.send_signal(signal.SIGTERM)
        self.assertEqual(self.daemon.wait(PATIENCE), 0)
        self.assertGreater(len(lists.lines), SECONDS, "lists came meanwhile")
        with open(log) as file:
            text = file.read()
        self.assertTrue(text.endswith("end\n"), "the counts were written")
        counts = dict(re.findall(r"^(\S+) (\d+)$", text, re.MULTILINE))
        # What it says to people is put together when it is said: of a busy computer, for instance.
        self.assertLessEqual(int(counts.pop("publisher", 0)), 4 * len(said), text)
        for worker in WORKERS:
            self.assertNotIn(worker, counts, text)
            self.assertEqual(after[worker], before[worker], f"page faults of {worker}")


if __name__ == "__main__":
    main(sys.argv[4:])
