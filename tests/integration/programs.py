"""What tests of screed and scree as programs share."""

import csv
import os
import socket
import subprocess
import sys
import tempfile
import unittest

PATIENCE = 150  # seconds; only a hang lasts as long

# A program that a sanitizer watches is ten times slower: too slow for all that a robot sees.
SANITIZED = "/asan/" in sys.argv[1] or "/tsan/" in sys.argv[1]
COARSE = """[lidar]
max_range = 6.0
[map]
registration_reach = 6.0
voxel = 0.2
reach = 6.0
search_reach = 4.0
[detect.map]
ground_cell = 0.3
kernel_spacing = 0.3
kernel_radius = 0.33
[detect.sweep]
leaf_size = 0.2
"""


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def fill(pipe):
    """Writes until nothing more goes in, as when nobody reads. `pipe` is a descriptor that does not block."""
    try:
        while True:
            os.write(pipe, b"x" * 4095 + b"\n")
    except BlockingIOError:
        pass


class ProgramTest(unittest.TestCase):
    """Has a folder of its own, ports and an LCM url that no other test has."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.port, self.position_port = free_port(), free_port()
        self.url = f"udpm://239.255.76.67:{free_port()}?ttl=0"

    def path(self, name):
        return os.path.join(self.folder, name)

    @staticmethod
    def read(path):
        with open(path) as file:
            return file.read()

    def write(self, name, text):
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)
        return path

    def start(self, *arguments, **options):
        process = subprocess.Popen(
            arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
        )

        def clean_up():
            process.kill()
            process.communicate()

        self.addCleanup(clean_up)
        return process

    def run_to_end(self, *arguments, **options):
        return subprocess.run(arguments, capture_output=True, text=True, timeout=PATIENCE, **options)

    def done(self, *arguments, code=0, **options):
        """What a program gave that ended with this code."""
        result = self.run_to_end(*arguments, **options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def decoded(self, scree, capture, sensor, *arguments):
        """The rows that `scree decode` lists of a sensor, without the first column, the times."""
        out = self.path("decoded.csv")
        self.done(scree, "decode", capture, "--sensor", sensor, "--out", out, "--force", *arguments)
        with open(out, newline="") as file:
            return [row[1:] for row in list(csv.reader(file))[1:]]

    def lidar_here(self):
        """The configuration's first table: the lidar on this test's ports."""
        return (
            f'[lidar]\naddress = "127.0.0.1"\nport = {self.port}\n'
            f"position_port = {self.position_port}\n"
        )

    def keep_up(self):
        """Lets a program that a sanitizer watches see less, so that its lists are not late."""
        if SANITIZED:  # a drop-in of robot.toml
            self.write("robot.d/coarse.toml", COARSE)

    def write_config_here(self, capture, imu):
        """The configuration of a simulated capture's robot, with its sensors on this computer."""
        with open(os.path.join(capture, "scree.toml")) as file:
            robot = file.read()
        for default, here in [
            ("port = 2368", f'port = {self.port}\naddress = "127.0.0.1"'),
            ("position_port = 8308", f"position_port = {self.position_port}"),
            ("/dev/ttyUSB0", imu),
            ('"can0"', '"vcan0"'),
        ]:
            self.assertIn(default, robot)
            robot = robot.replace(default, here)
        self.keep_up()
        return self.write("robot.toml", f'{robot}[lcm]\nurl = "{self.url}"\n')

    def read_until(self, stream, words):
        for line in stream:
            if words in line:
                return line
        self.fail(f'the program ended before it said "{words}"')

    def assert_fails(self, result, *words):
        """It failed with one sentence that holds these words."""
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stdout, "")
        sentence = result.stderr.strip().splitlines()[-1]
        for word in words:
            self.assertIn(word, sentence)


def main(tests):
    """Runs them; exit code 77 where one was skipped, which CTest then says."""
    outcome = unittest.main(argv=[sys.argv[0], *tests], exit=False).result
    skipped = outcome.skipped and outcome.wasSuccessful()
    sys.exit(77 if skipped else not outcome.wasSuccessful())
