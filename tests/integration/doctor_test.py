"""scree doctor as a program: python3 doctor_test.py SCREED SCREE [TEST ...]"""

import ctypes
import itertools
import os
import socket
import subprocess
import sys
import threading

from live_sensors import EmulatedMti
from programs import ProgramTest, free_port, main
from synthetic_capture import data_packet, write_capture

SCREED, SCREE = sys.argv[1:3]


CLONE_NEWNET = 0x40000000


def enter_own_network():
    """As root it sees all packets of the computer: here only those of this test."""
    if ctypes.CDLL(None).unshare(CLONE_NEWNET) == 0:
        for change in ["link set lo up", "link set lo multicast on", "route add 224.0.0.0/4 dev lo"]:
            subprocess.run(["ip", *change.split()], check=True)


class DoctorTest(ProgramTest):
    def setUp(self):
        enter_own_network()
        super().setUp()
        self.imu = self.path("imu")
        self.config = self.write(
            "robot.toml",
            self.lidar_here() + f'[imu]\ndevice = "{self.imu}"\n'
            f'[encoder]\ninterface = "nocan0"\n[gpio]\nstop = "nochip:4"\n[lcm]\nurl = "{self.url}"\n',
        )

    def doctor(self, config=None):
        """Verdict and text of each line by its subject, and the exit code."""
        done = self.run_to_end(SCREE, "doctor", "--config", config or self.config, "--seconds", "1.5")
        lines, verdicts = {}, []
        for line in done.stdout.splitlines():
            verdict, subject, text = line[:6].strip(), line[6:21].strip(), line[21:].strip()
            self.assertIn(verdict, ["ok", "WRONG", "?"], line)
            self.assertTrue(subject and text, line)
            lines[subject] = (verdict, text)
            verdicts.append(verdict)
        wrong = verdicts.count("WRONG")
        self.assertEqual(done.returncode, 1 if wrong else 0, done.stdout + done.stderr)
        if wrong:
            self.assertIn(f"{wrong} of {len(verdicts)} are wrong", done.stderr)
        return lines

    def assert_line(self, lines, subject, verdict, words):
        self.assertEqual(lines[subject][0], verdict, lines)
        self.assertIn(words, lines[subject][1])

    def keep_on(self, work):
        """Does it all the time, until the test ends."""
        stop = threading.Event()

        def run():
            while not stop.wait(0.005):
                work()

        thread = threading.Thread(target=run)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(stop.set)

    def send(self, payload_of, port):
        """Datagrams, each by its number."""
        sender, numbers = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), itertools.count()
        self.addCleanup(sender.close)
        self.keep_on(lambda: sender.sendto(payload_of(next(numbers)), ("127.0.0.1", port)))

    def test_without_anything_each_line_says_what_to_do(self):
        lines = self.doctor()
        self.assert_line(lines, "configuration", "ok", self.config)
        self.assert_line(lines, "screed", "ok", "does not run")
        self.assert_line(lines, "UDP port", "ok", f"UDP port {self.port} is free")
        self.assert_line(lines, "position port", "ok", f"UDP port {self.position_port} is free")
        self.assert_line(lines, "LCM", "ok", "has a route")
        self.assert_line(lines, "lidar", "WRONG", f"nothing came to UDP port {self.port}")
        self.assert_line(lines, "serial port", "WRONG", f"there is no {self.imu}")
        self.assert_line(lines, "CAN interface", "WRONG", "there is no nocan0")
        self.assert_line(lines, "gpio.stop", "WRONG", "no GPIO chip nochip")
        for subject in ["firewall", "real time", "memory", "clock"]:
            self.assertIn(subject, lines)

    def test_sensors_that_say_something_are_heard(self):
        self.send(data_packet, self.port)
        mti = EmulatedMti(self.imu)
        mti.plug_in()
        self.addCleanup(mti.unplug)
        body = b"\xff\x36\x07\xe0\x20\x04\x00\x00\x00\x03"  # MTData2 with a status word
        self.keep_on(lambda: mti.send(b"\xfa" + body + bytes([-sum(body) % 256])))
        lines = self.doctor()
        self.assert_line(lines, "lidar", "ok", "packets a second of 1206 bytes from 127.0.0.1")
        self.assert_line(lines, "firewall", "ok", "come through")
        self.assert_line(lines, "serial port", "ok", self.imu)
        self.assert_line(lines, "IMU", "ok", "answers and measures")

    def test_packets_of_another_size_or_to_another_port_are_said(self):
        self.send(lambda _: bytes(512), self.port)
        self.assert_line(self.doctor(), "lidar", "WRONG", "from 127.0.0.1 has 512 bytes")
        if os.geteuid() != 0:
            self.skipTest("seeing packets to other ports takes the right CAP_NET_RAW")
        port = free_port()
        self.send(data_packet, port)
        self.config = self.write("other.toml", f"[lidar]\nport = {free_port()}\n")
        self.assert_line(self.doctor(), "lidar", "WRONG", f"set lidar.port = {port}")

    def test_packets_that_screed_would_refuse_are_refused(self):
        def of_another_model(product, mode=0x37):
            return lambda number: data_packet(number)[:1204] + bytes([mode, product])

        for packets, words in [
            (of_another_model(0x24), 'set lidar.model = "puck_hires"'),
            (of_another_model(0x28), "VLP-32C"),
            (of_another_model(0x22, mode=0), "return mode byte"),
            (lambda _: b"\xff" * 1206, "does not begin with FF EE"),
        ]:
            self.port = free_port()
            config = self.write("other.toml", f"[lidar]\nport = {self.port}\n")
            self.send(packets, self.port)
            self.assert_line(self.doctor(config), "lidar", "WRONG", words)

    def test_position_packets_alone_are_no_matter_of_power_or_cable(self):
        config = self.write("other.toml", f"[lidar]\nport = {self.port}\nposition_port = {self.position_port}\n")
        self.send(lambda _: bytes(512), self.position_port)
        self.assert_line(self.doctor(config), "lidar", "WRONG", "so power and cable are right")

    def test_another_program_on_the_port_is_named(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", self.port))
            lines = self.doctor()
        self.assert_line(lines, "UDP port", "WRONG", f"(process {os.getpid()})")
        self.assert_line(lines, "lidar", "?", "another program")

    def test_a_running_daemon_tells_by_its_health(self):
        self.keep_up()
        with open(self.config) as file:
            config = self.write("robot.toml", file.read().replace('stop = "nochip:4"', ""))
        daemon = self.start(SCREED, "--config", config)
        self.read_until(daemon.stderr, "publishing on")
        lines = self.doctor(config)
        for subject, port in [("UDP port", self.port), ("position port", self.position_port)]:
            bound = f"127.0.0.1:{port} is bound by screed (process {daemon.pid})"
            self.assert_line(lines, subject, "ok", bound)
        self.assert_line(lines, "screed", "WRONG", "it is blind: nothing has come on UDP port")
        self.assert_line(lines, "lidar", "WRONG", "nothing came")
        self.assert_line(lines, "IMU", "WRONG", "nothing has come")
        capture = self.path("lidar.pcap")
        write_capture(capture, seconds=1)
        self.start(SCREE, "replay", capture, "--loop", "--address", f"127.0.0.1:{self.port}",
                   "--position-port", str(self.position_port))  # fmt: skip
        self.read_until(daemon.stderr, "sees: obstacle lists go out")
        lines = self.doctor(config)
        self.assert_line(lines, "screed", "ok", "it runs, and sees")
        self.assert_line(lines, "lidar", "ok", "messages a second from 127.0.0.1")

    def test_a_mistake_in_the_configuration_is_the_first_line(self):
        config = self.write("wrong.toml", "[lidar]\nport = 70000\n")
        self.assert_line(self.doctor(config), "configuration", "WRONG", f"{config}:2: lidar.port")


if __name__ == "__main__":
    main(sys.argv[3:])
