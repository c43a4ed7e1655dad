"""A screed with all its sensors: what the tests of it as it runs share."""

import threading
import time

from live_sensors import EmulatedMti
from programs import PATIENCE, ProgramTest


class Lines:
    """The lines of a stream as they come."""

    def __init__(self, stream):
        self.lines = []
        self.thread = threading.Thread(target=self._read, args=[stream], daemon=True)
        self.thread.start()

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
        self.done(self.scree, "simulate", capture, "--seconds", "6", "--scene", "easy")
        self.mti = EmulatedMti(self.path("imu"))
        self.config = self.write_config_here(capture, self.mti.port)
        return capture

    def start_daemon(self):
        self.daemon = self.start(self.screed, "--config", self.config)
        self.log = Lines(self.read_log())
        self.log.first(lambda line: "publishing on" in line)
        watch = [self.scree, "watch", "--url", self.url]
        self.health = Lines(self.start(*watch).stdout)
        self.lists = Lines(self.start(*watch, "--json").stdout)
        self.mti.plug_in()

    def read_log(self):
        return self.daemon.stderr

    def say(self, words, since=0):
        """Where health first says so."""
        return self.health.first(lambda line: words in line, since)[1]
