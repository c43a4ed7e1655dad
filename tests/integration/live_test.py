"""screed with all its sensors live: python3 live_test.py SCREED SCREE [TEST ...]"""

import json
import math
import sys
import time

from hung_thread import hung
from live_daemon import LiveDaemonTest
from live_sensors import Player, can_socket
from programs import PATIENCE, main

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]


class LiveTest(LiveDaemonTest):
    def start_all(self, can=None):
        capture = self.simulate()
        self.start_daemon()
        self.player = Player(capture, self.port, self.position_port, self.mti, can, loop=True)
        self.addCleanup(self.player.stop)

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

    def test_answers_to_the_start_up_are_no_wrong_data(self):
        capture = self.simulate()
        self.start_daemon()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        for _ in range(2):  # health comes once a second
            self.say("imu never seen", len(self.health.lines))
        self.player = Player(capture, self.port, self.position_port, self.mti)
        self.addCleanup(self.player.stop)
        self.say("imu ok")
        self.assertNotIn("imu wrong data", "".join(self.health.lines))

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
