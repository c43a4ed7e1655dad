"""scree replay as a program: python3 replay_test.py SCREED SCREE [TEST ...]"""

import json
import math
import os
import signal
import sys

from live_sensors import can_socket
from programs import PATIENCE, ProgramTest, main

SCREED, SCREE = sys.argv[1:3]


class ReplayTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.capture, self.imu = self.path("capture"), self.path("imu")

    def simulate(self, seconds):
        self.done(SCREE, "simulate", self.capture, "--seconds", str(seconds), "--scene", "easy")
        self.config = self.write_config_here(self.capture, self.imu)

    def replay(self, *arguments):
        return [SCREE, "replay", self.capture, "--address", f"127.0.0.1:{self.port}",
                "--position-port", str(self.position_port), *arguments]  # fmt: skip

    def record(self, *replayed):
        """What scree record makes of a replay."""
        recording = self.path("recording")
        recorder = self.start(SCREE, "record", recording, "--config", self.config)
        self.read_until(recorder.stderr, "recording to")
        summary = self.done(*self.replay(*replayed)).stderr
        recorder.send_signal(signal.SIGINT)
        _, complaint = recorder.communicate(timeout=PATIENCE)
        self.assertEqual(recorder.returncode, 0, complaint)
        return recording, summary

    def test_a_daemon_sees_lidar_and_imu_again_and_again(self):
        self.simulate(2)
        daemon = self.start(SCREED, "--config", self.config)
        self.read_until(daemon.stderr, "publishing on")
        health = self.start(SCREE, "watch", "--url", self.url)
        lists = self.start(SCREE, "watch", "--url", self.url, "--json")
        replay = self.start(*self.replay("--serial", self.imu, "--loop"))
        self.read_until(health.stdout, "imu ok")
        self.read_until(health.stdout, "health ok")
        start = json.loads(lists.stdout.readline())["pose"]["p"]
        while math.dist(json.loads(lists.stdout.readline())["pose"]["p"], start) < 0.1:
            pass
        # A daemon that starts anew finds the IMU as if it had been plugged in again.
        daemon.terminate()
        daemon.communicate(timeout=PATIENCE)
        daemon = self.start(SCREED, "--config", self.config)
        self.read_until(daemon.stderr, "messages from the IMU")
        replay.send_signal(signal.SIGTERM)
        _, summary = replay.communicate(timeout=PATIENCE)
        self.assertEqual(replay.returncode, 0, summary)
        self.assertIn(f"reads of the IMU to {self.imu}", summary)
        self.assertFalse(os.path.lexists(self.imu))

    def test_what_is_replayed_records_to_the_same_values(self):
        self.simulate(2)
        recording, summary = self.record("--serial", self.imu)
        self.assertIn("the encoder is not played: --can", summary)
        for sensor in ["lidar", "imu"]:
            original = self.decoded(SCREE, self.capture, sensor)
            self.assertGreater(len(original), 100)
            self.assertEqual(self.decoded(SCREE, recording, sensor), original)

    def test_frames_go_out_on_a_can_bus(self):
        can, reason = can_socket("vcan0")
        if can is None:
            self.skipTest(reason)
        can.close()
        self.simulate(1)
        recording, summary = self.record("--can", "vcan0")
        self.assertRegex(summary, r"\d+ frames to vcan0 in")
        self.assertEqual(self.decoded(SCREE, recording, "encoder"), self.decoded(SCREE, self.capture, "encoder"))

    def test_a_part_is_replayed(self):
        self.simulate(2)
        recording, _ = self.record("--serial", self.imu, "--from", "0.5", "--to", "1.25",
                                   "--rate", "0.5")  # fmt: skip
        for sensor in ["lidar", "imu"]:
            original, part = self.decoded(SCREE, self.capture, sensor), self.decoded(SCREE, recording, sensor)
            if sensor == "lidar":  # by packet, which is counted from the part's begin
                original, part = ([row[1:] for row in rows] for rows in (original, part))
            first = original.index(part[0])
            self.assertEqual(part, original[first : first + len(part)])
            self.assertAlmostEqual(len(part) / len(original), 0.75 / 2, delta=0.1)

    def test_what_cannot_be_replayed_is_one_sentence(self):
        self.simulate(1)
        self.assert_fails(self.run_to_end(*self.replay("--from", "7")),
                          f"{self.capture} is 1.", "nothing is there from 7 s on")  # fmt: skip
        self.assertEqual(self.run_to_end(*self.replay("--from", "3", "--to", "3")).returncode, 2)
        self.assert_fails(self.run_to_end(*self.replay("--can", "nocan0")), "CAN interface nocan0")
        self.write("imu", "")
        self.assert_fails(self.run_to_end(*self.replay("--serial", self.imu)), "is there already")
        os.remove(self.imu)
        os.symlink("/dev/null", self.imu)
        self.assert_fails(self.run_to_end(*self.replay("--serial", self.imu)), "is there already")
        self.assertEqual(os.readlink(self.imu), "/dev/null")


if __name__ == "__main__":
    main(sys.argv[3:])
