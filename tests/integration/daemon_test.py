"""screed and scree as programs: python3 daemon_test.py SCREED SCREE [TEST ...]"""

import json
import math
import os
import signal
import socket
import sys
import time

from programs import PATIENCE, ProgramTest, free_port, main
from synthetic_capture import data_packet, write_capture

SCREED, SCREE = sys.argv[1:3]

# Finds nothing, whatever the features are.
NETWORK = """scree_network 1
inputs 5
hidden 1
outputs 2
form raw raw raw log1p log1p
mean 0 0 0 0 0
scale 1 1 1 1 1
unit 0 0 0 0 0 0
output 0 -9
output 0 -9
"""


class DaemonTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.config = self.write(
            "robot.toml",
            self.lidar_here() + "translation = [0, 0, 0.95]\n"
            f'[detect.sweep]\nnetwork = "network.txt"\n[lcm]\nurl = "{self.url}"\n',
        )
        self.write("network.txt", NETWORK)

    def start_daemon(self):
        daemon = self.start(SCREED, "--config", self.config)
        self.read_until(daemon.stderr, "publishing on")
        return daemon

    def watch(self, *arguments):
        return [SCREE, "watch", "--url", self.url, *arguments]

    def replay(self, *arguments):
        capture = os.path.join(self.folder, "lidar.pcap")
        write_capture(capture, seconds=1)
        return [SCREE, "replay", capture, "--address", f"127.0.0.1:{self.port}",
                "--position-port", str(self.position_port), *arguments]  # fmt: skip

    def test_a_replayed_capture_gives_lists_and_health(self):
        self.keep_up()
        daemon = self.start_daemon()
        lists = self.start(*self.watch("--json", "--count", "5"))
        health = self.start(*self.watch())
        self.read_until(health.stdout, "BLIND")
        replay = self.start(*self.replay("--loop"))
        self.read_until(health.stdout, "health ok")
        output, complaint = lists.communicate(timeout=PATIENCE)
        self.assertEqual(lists.returncode, 0, complaint)
        stamps = []
        for line in output.splitlines():
            found = json.loads(line)
            self.assertEqual(list(found), ["stamp_ns", "pose", "obstacles"])
            self.assertLess(math.dist(found["pose"]["p"], [0, 0, 0]), 0.02)
            self.assertLess(math.dist(found["pose"]["q"], [1, 0, 0, 0]), 0.01)
            stamps.append(found["stamp_ns"])
        self.assertEqual(len(stamps), 5)
        self.assertEqual(stamps, sorted(stamps))

        replay.send_signal(signal.SIGINT)
        _, summary = replay.communicate(timeout=PATIENCE)
        self.assertEqual(replay.returncode, 0, summary)
        self.assertRegex(summary, r"^sent \d+ data packets to .* and \d+ position packets to ")
        self.read_until(health.stdout, "BLIND")
        daemon.terminate()
        _, log = daemon.communicate(timeout=PATIENCE)
        self.assertEqual(daemon.returncode, 0, log)
        self.assertIn("is from 127.0.0.1 and has 1206 bytes", log)
        self.assertIn("stopping", log)

    def test_it_stops_when_interrupted_while_nothing_comes(self):
        daemon = self.start_daemon()
        daemon.send_signal(signal.SIGINT)
        self.assertEqual(daemon.wait(timeout=PATIENCE), 0)

    def test_no_sender_is_said(self):
        daemon = self.start_daemon()
        self.assertIn(f"UDP port {self.port}", self.read_until(daemon.stderr, "no packets on"))
        result = self.run_to_end(*self.watch("--json", "--seconds", "1.5"))
        self.assert_fails(result, "no obstacle list")

    def test_a_second_daemon_names_the_port(self):
        self.start_daemon()
        result = self.run_to_end(SCREED, "--config", self.config)
        self.assert_fails(result, f"UDP port {self.port}", "in use")

    def test_of_two_sensors_on_one_port_one_is_taken_and_both_are_named(self):
        daemon = self.start_daemon()
        senders = []
        for address in ("127.0.0.1", "127.0.0.2"):
            sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.addCleanup(sender.close)
            sender.bind((address, 0))
            senders.append(sender)
        for number in range(200):
            for sender in senders:
                sender.sendto(data_packet(number), ("127.0.0.1", self.port))
            time.sleep(0.001)
        line = self.read_until(daemon.stderr, "two sensors send to this port")
        for words in ("127.0.0.1", "127.0.0.2", "lidar.sender"):
            self.assertIn(words, line)

    def test_a_mistake_in_the_configuration_names_file_line_and_key(self):
        config = self.write("wrong.toml", "[lidar]\nport = 70000\n")
        result = self.run_to_end(SCREED, "--config", config)
        self.assert_fails(result, f"{config}:2: lidar.port")
        result = self.run_to_end(SCREED, "--config", os.path.join(self.folder, "none.toml"))
        self.assert_fails(result, "none.toml")

    def test_a_gpio_line_that_is_not_there_is_said(self):
        with open(self.config, "a") as file:
            file.write('[gpio]\nstop = "nochip:4"\n')
        result = self.run_to_end(SCREED, "--config", self.config)
        self.assert_fails(result, 'gpio.stop = "nochip:4"', "no GPIO chip nochip")

    def test_an_unusable_lcm_url_is_explained(self):
        for url, why in [("udpm://127.0.0.1:7667", "multicast address"),
                         ("memq://", "no planner hears"), ("file:///tmp/log", "no planner hears")]:  # fmt: skip
            config = self.write("wrong.toml", f'[lidar]\nport = {self.port}\nposition_port = '
                                f'{self.position_port}\n[detect.sweep]\nnetwork = "network.txt"\n'
                                f'[lcm]\nurl = "{url}"\n')  # fmt: skip
            self.assert_fails(self.run_to_end(SCREED, "--config", config), url, why)

    def test_wrong_usage_ends_with_2(self):
        self.assertEqual(self.run_to_end(SCREED, "--colour").returncode, 2)
        self.assertEqual(self.run_to_end(*self.replay("--rate", "fast")).returncode, 2)
        self.assertEqual(self.run_to_end(*self.watch("--count", "0")).returncode, 2)

    def test_replay_and_watch_say_when_nobody_is_there(self):
        self.assert_fails(self.run_to_end(*self.replay("--rate", "max")), "nobody listens")
        self.assert_fails(self.run_to_end(*self.watch("--seconds", "0.5")), "nothing came")


if __name__ == "__main__":
    main(sys.argv[3:])
