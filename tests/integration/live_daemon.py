"""A screed with all its sensors: what the tests of it as it runs share."""

import os
import threading
import time

from live_sensors import EmulatedMti
from programs import PATIENCE, ProgramTest


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


class LiveDaemonTest(ProgramTest):
    screed = scree = None  # the programs

    def simulate(self):
        """A capture, and a configuration for its sensors on this computer."""
        capture = self.path("capture")
        done = self.run_to_end(self.scree, "simulate", capture, "--seconds", "6", "--scene", "easy")
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

    def start_daemon(self):
        self.daemon = self.start(self.screed, "--config", self.config)
        self.log = Lines(self.daemon.stderr)
        self.log.first(lambda line: "publishing on" in line)
        watch = [self.scree, "watch", "--url", self.url]
        self.health = Lines(self.start(*watch).stdout)
        self.lists = Lines(self.start(*watch, "--json").stdout)
        self.mti.plug_in()

    def say(self, words, since=0):
        """Where health first says so."""
        return self.health.first(lambda line: words in line, since)[1]
