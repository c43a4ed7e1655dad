"""scree record as a program, on live sensors: python3 record_test.py SCREE [TEST ...]"""

import glob
import json
import os
import resource
import shutil
import signal
import sys
import time

from live_sensors import EmulatedMti, Player, can_socket
from programs import PATIENCE, ProgramTest, main

SCREE = sys.argv[1]

DBC = """BO_ 340 WHEEL: 8 ECU
 SG_ WAY : 12|20@1+ (1,0) [0|0] "" X
"""


class RecordTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.original, self.recording = self.path("original"), self.path("recording")
        self.mti = EmulatedMti(self.path("imu"))
        self.config = self.write("robot.toml", self.configuration())

    def configuration(self, encoder='interface = "vcan0"\n'):
        return self.lidar_here() + f'[imu]\ndevice = "{self.mti.port}"\n[encoder]\n{encoder}'

    def simulate(self, seconds):
        self.done(SCREE, "simulate", self.original, "--seconds", str(seconds), "--scene", "easy")

    def record(self, *arguments, **options):
        """Starts it, and waits until it listens."""
        process = self.start(SCREE, "record", self.recording, "--config", self.config, *arguments,
                             **options)  # fmt: skip
        self.read_until(process.stderr, "recording to")
        return process

    def play(self, can=None):
        self.mti.plug_in()
        self.assertTrue(self.mti.measures.wait(PATIENCE), "the IMU was not started")
        player = Player(self.original, self.port, self.position_port, self.mti, can)
        player.wait()
        player.stop()
        time.sleep(0.3)  # until what was sent last is read

    def assert_same_values(self, sensor, *arguments):
        """All but the times, which are those of the recording's clock."""
        recorded = self.decoded(SCREE, self.recording, sensor)
        original = self.decoded(SCREE, self.original, sensor, *arguments)
        self.assertGreater(len(original), 100)
        self.assertEqual(recorded, original)

    def test_what_is_recorded_decodes_to_the_same_values(self):
        self.simulate(2)
        process = self.record()
        self.play()
        process.send_signal(signal.SIGINT)
        _, summary = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 0, summary)
        self.assertRegex(summary, r"recorded \d+\.\d s; lidar \d+ packets, .* MB; imu \d+ reads, .* kB; can")
        self.assert_same_values("lidar")
        self.assert_same_values("imu")
        info = self.done(SCREE, "info", self.recording)
        self.assertIn("from 127.0.0.1", info.stdout)
        lists = self.done(SCREE, "detect", self.recording, "--out", self.path("lists.jsonl"))
        # A computer that has too much to do hears the samples late, and records so.
        said = [line for line in lists.stderr.splitlines() if "came later than map.wait" not in line]
        self.assertNotIn("IMU", "\n".join(said))

    def test_frames_of_the_can_bus_are_recorded(self):
        can, reason = can_socket("vcan0")
        if can is None:
            self.skipTest(reason)
        self.addCleanup(can.close)
        self.simulate(1)
        with open(os.path.join(self.original, "scree.toml")) as file:
            encoder = file.read().split("[encoder]\n")[1].replace('"can0"', '"vcan0"')
        self.config = self.write("robot.toml", self.configuration(encoder))
        process = self.record()
        self.play(can)
        process.send_signal(signal.SIGTERM)
        _, summary = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 0, summary)
        self.assert_same_values("encoder")

    def test_a_drive_is_calibrated_while_it_lasts(self):
        self.simulate(12)
        live = [SCREE, "calibrate", "--live", "60", "--config", self.config, "--json", "--keep",
                self.recording]  # fmt: skip
        process = self.start(*live)
        self.read_until(process.stderr, "recording to")
        self.play()
        process.send_signal(signal.SIGINT)
        found, said = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("found", json.loads(found)[1], found)
        kept = self.done(SCREE, "calibrate", self.recording, "--json")
        self.assertEqual(found, kept.stdout)
        self.assert_fails(self.run_to_end(*live), "not an empty folder")

    def test_a_drive_of_which_nothing_came_leaves_nothing(self):
        os.mkdir(self.path("temporary"))
        done = self.run_to_end(SCREE, "calibrate", "--live", "1", "--config", self.config,
                               env={**os.environ, "TMPDIR": self.path("temporary")})  # fmt: skip
        self.assert_fails(done, "nothing came from any sensor")
        self.assertEqual(os.listdir(self.path("temporary")), [])

    def test_a_killed_recording_is_whole(self):
        self.simulate(1)
        process = self.record()
        self.play()
        process.kill()
        process.communicate()
        self.assert_same_values("lidar")
        self.assert_same_values("imu")

    def test_killed_before_the_imu_says_anything_it_is_a_capture(self):
        self.simulate(1)
        process = self.record()
        player = Player(self.original, self.port, self.position_port, self.mti)
        player.wait()
        player.stop()
        time.sleep(0.3)
        process.kill()
        process.communicate()
        self.done(SCREE, "info", self.recording)
        lists = self.done(SCREE, "detect", self.recording, "--out", self.path("lists.jsonl"))
        self.assertIn("the file holds no bytes", lists.stderr)

    def test_a_folder_that_is_removed_meanwhile_is_no_success(self):
        process = self.record()
        shutil.rmtree(self.recording)
        _, said = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("is gone: was its folder removed?", said.splitlines()[-1])

    def test_who_reads_its_words_may_go_or_stall(self):
        self.simulate(1)
        process = self.record()
        process.stderr.close()
        self.play()
        self.assertIsNone(process.poll())
        process.terminate()
        self.assertEqual(process.wait(timeout=PATIENCE), 0)
        process.stderr = open(os.devnull)
        self.assert_same_values("lidar")

    def test_asked_to_end_while_it_starts_it_ends_by_itself(self):
        process = self.record()
        process.terminate()
        self.assertEqual(process.wait(timeout=PATIENCE), 1)  # nothing has come
        self.assertIn("nothing came from any sensor", process.stderr.read())

    def test_files_that_the_configuration_names_come_along(self):
        os.mkdir(self.path("robot"))
        dbc = self.write("robot/wheel.dbc", DBC)
        network = glob.glob(os.path.join(os.path.dirname(SCREE), "..", "share", "scree",
                                         "network_sweep.txt"))[0]  # fmt: skip
        shutil.copy(network, self.path("robot/own.txt"))
        self.config = self.write(
            "robot.toml",
            self.configuration(f'dbc = "{dbc}"\nsignal = "WHEEL.WAY"\nscale = 0.001\n')
            + '[detect.sweep]\nnetwork = "robot/own.txt"\n',
        )
        self.simulate(1)
        process = self.record()
        self.play()
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=PATIENCE)
        shutil.rmtree(self.path("robot"))
        self.done(SCREE, "detect", self.recording, "--out", self.path("lists.jsonl"))

    def test_sensors_that_are_not_there_by_the_settings_have_no_part(self):
        config = self.write(
            "lidar_alone.toml",
            f"[lidar]\nport = {self.port}\n[imu]\ndevice = ''\n[encoder]\ninterface = ''\n",
        )
        said = self.run_to_end(SCREE, "record", self.recording, "--config", config, "--seconds", "1").stderr
        self.assertEqual(sorted(os.listdir(self.recording)), ["lidar.pcap", "scree.toml"])
        for word in ("IMU", "imu", "CAN"):
            self.assertNotIn(word, said)

    def test_missing_sensors_are_waited_for_and_said(self):
        self.mti.port = self.path("elsewhere")
        done = self.run_to_end(SCREE, "record", self.recording, "--config", self.config,
                               "--seconds", "3")  # fmt: skip
        said = done.stderr
        self.assertEqual(done.returncode, 1, said)
        self.assertIn("imu is not there: is the IMU plugged in?", said)
        self.assertIn("vcan0", said)
        self.assertIn(f"no packets of the lidar on UDP port {self.port}", said)
        self.assertIn("nothing came from any sensor", said.splitlines()[-1])

    def test_a_port_in_use_and_a_folder_in_use_are_one_sentence(self):
        self.record()
        again = [SCREE, "record", self.path("other"), "--config", self.config]
        self.assert_fails(self.run_to_end(*again), f"UDP port {self.port}", "in use")
        self.assertFalse(os.path.exists(self.path("other")))
        self.config = self.write("other.toml", "[lidar]\nport = 23681\nposition_port = 23682\n")
        again = [SCREE, "record", self.recording, "--config", self.config]
        self.assert_fails(self.run_to_end(*again), "not an empty folder")
        self.assert_fails(self.run_to_end(SCREE, "record", self.path("x"), "--config", "none"),
                          "cannot read none")  # fmt: skip

    def test_a_full_disk_is_said(self):
        self.simulate(1)

        def limit_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

        # Python ignores SIGXFSZ, and so does what it starts.
        process = self.record(preexec_fn=limit_files, restore_signals=False)
        self.play()
        _, said = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("lidar.pcap: the disk may be full", said.splitlines()[-1])


if __name__ == "__main__":
    main(sys.argv[2:])
