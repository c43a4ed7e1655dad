"""screed with all its sensors live: python3 live_test.py SCREED SCREE [TEST ...]"""

import json
import math
import os
import sys
import threading
import time

from hung_thread import hung
from live_sensors import EmulatedMti, Player, can_socket
from programs import PATIENCE, ProgramTest, main

SCREED, SCREE = sys.argv[1:3]


class Lines:
    """The lines of a stream as they come."""

    def __init__(self, stream):
        self.lines = []
        threading.Thread(target=self._read, args=[stream], daemon=True).start()

    def _read(self, stream):
        for line in stream:
            self.lines.append(line)

    def first(self, holds, since=0):
        """The first line from there on that it holds for, and where it stands."""
        end = time.monotonic() + PATIENCE
        at = since
        while time.monotonic() < end:
            if at == len(self.lines):
                time.sleep(0.02)
            elif holds(self.lines[at]):
                return self.lines[at], at
            else:
                at += 1
        raise AssertionError("it did not come; the last lines: " + "".join(self.lines[-9:]))


class LiveTest(ProgramTest):
    def simulate(self):
        """A capture, and a configuration for its sensors on this computer."""
        capture = self.path("capture")
        done = self.run_to_end(SCREE, "simulate", capture, "--seconds", "6", "--scene", "easy")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(os.path.join(capture, "scree.toml")) as file:
            robot = file.read()
        self.mti = EmulatedMti(self.path("imu"))
        for default, here in [
            ("port = 2368", f'port = {self.port}\naddress = "127.0.0.1"'),
            ("position_port = 8308", f"position_port = {self.position_port}"),
            ("/dev/ttyUSB0", self.mti.port),
            ('"can0"', '"vcan0"'),
        ]:
            self.assertIn(default, robot)
            robot = robot.replace(default, here)
        self.config = self.write("robot.toml", f'{robot}[lcm]\nurl = "{self.url}"\n')
        return capture

    def start_all(self, can=None):
        capture = self.simulate()
        self.daemon = self.start(SCREED, "--config", self.config)
        self.log = Lines(self.daemon.stderr)
        self.log.first(lambda line: "publishing on" in line)
        watch = [SCREE, "watch", "--url", self.url]
        self.health = Lines(self.start(*watch).stdout)
        self.lists = Lines(self.start(*watch, "--json").stdout)
        self.mti.plug_in()
        self.player = Player(capture, self.port, self.position_port, self.mti, can, loop=True)
        self.addCleanup(self.player.stop)

    def say(self, words, since=0):
        """Where health first says so."""
        return self.health.first(lambda line: words in line, since)[1]

    def lists_go_on(self):
        """Lists of data from now on come, and the robot does not stand."""
        now = time.time_ns()
        at = self.lists.first(lambda line: json.loads(line)["stamp_ns"] > now)[1]
        start = json.loads(self.lists.lines[at])["pose"]["p"]
        self.lists.first(lambda line: math.dist(json.loads(line)["pose"]["p"], start) > 0.2, at)

    def test_the_imu_is_cut_and_comes_back(self):
        self.start_all()
        self.say(f"imu ok ({self.mti.port})")
        self.say("health ok")
        self.lists_go_on()

        at = len(self.health.lines)
        cut = time.monotonic()
        self.mti.unplug()
        self.say("imu silent", at)
        print(f"silent was said {time.monotonic() - cut:.2f} s after the cut")
        self.log.first(lambda line: "no messages from the IMU" in line and "check its cable" in line)
        now = time.time_ns()
        self.lists.first(lambda line: json.loads(line)["stamp_ns"] > now)

        at = len(self.health.lines)
        self.mti.plug_in()
        self.say("imu ok", at)
        self.log.first(lambda line: "messages from the IMU" in line and "again after" in line)
        self.lists_go_on()

    def blind_is_said(self, cause, since, start):
        """And the stop line with it."""
        line = self.health.lines[self.say("health BLIND", since)]
        print(f"BLIND was said {time.monotonic() - start:.3f} s after {cause}")
        self.assertIn(", stop: ", line)

    def test_blind_is_said_when_packets_or_lists_stop(self):
        self.start_all()
        self.say("health ok")
        self.lists_go_on()
        self.assertIn("slowest", self.health.lines[self.say("detector p50")])

        at = len(self.health.lines)
        try:
            with hung(self.daemon.pid, "detector"):
                self.blind_is_said("the detector hung", at, time.monotonic())
                self.say("the detector is late", at)
        except PermissionError as error:
            self.skipTest(f"no thread can be stopped here: {error}")
        self.say("health ok", len(self.health.lines))

        at = len(self.health.lines)
        self.player.stop()
        last_ns = time.time_ns()
        self.blind_is_said("the last packet", at, self.player.last_sent)
        self.say("no packets on", at)
        self.say("health BLIND", len(self.health.lines))
        self.assertLess(json.loads(self.lists.lines[-1])["stamp_ns"], last_ns)

    def test_the_encoder_is_heard(self):
        can, reason = can_socket("vcan0")
        if can is None:
            self.skipTest(reason)
        self.addCleanup(can.close)
        self.start_all(can)
        self.say("encoder ok (vcan0, bus active)")
        self.say("imu ok")
        self.lists_go_on()


if __name__ == "__main__":
    main(sys.argv[3:])
