"""How a test in the virtual machine looks at it."""

import glob
import json
import os
import subprocess
import threading
import time

PATIENCE = 60  # seconds; only a hang lasts as long


def run(command, **options):
    """What a command prints; an error where it fails."""
    done = subprocess.run(command, shell=True, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout.strip()


def fails(command):
    """What a command prints that has to fail."""
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.returncode != 0, f"{command} did not fail"
    return done.stdout + done.stderr


def until(holds, what):
    """Waits until it holds; gives what it gave."""
    end = time.monotonic() + PATIENCE
    while not (result := holds()):
        if time.monotonic() > end:
            raise AssertionError(f"in vain: {what}")
        time.sleep(0.1)
    return result


def show(name):
    """A property of the service."""
    return run(f"systemctl show --value -p {name} screed")


class Journal:
    """The service's lines in the journal."""

    def lines(self):
        return run("journalctl -u screed -o cat --no-pager").splitlines()

    def mark(self):
        """Where the journal stands."""
        return len(self.lines())

    def says(self, words, since=0):
        return until(
            lambda: [line for line in self.lines()[since:] if words in line], f'journal: "{words}"'
        )[0]


class Watch:
    """What `scree watch` prints, as it comes."""

    def __init__(self, *options):
        self.texts = []
        self.program = subprocess.Popen(
            ["scree", "watch", *options], stdout=subprocess.PIPE, text=True
        )
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.program.stdout:
            self.texts.append(line.rstrip())

    def mark(self):
        return len(self.texts)

    def says(self, words, since=0):
        """Where a line holds them first."""
        return until(
            lambda: [i for i, line in enumerate(self.texts[since:], since) if words in line],
            f'watch: "{words}"; last came: {self.texts[-12:]}',
        )[0]

    def next_list(self, since):
        """Of a watch with --json: the first list from there on that is not older than now."""
        now = time.time_ns()
        return until(
            lambda: [one for one in map(json.loads, self.texts[since:]) if one["stamp_ns"] > now],
            f"a list; last came: {self.texts[-1:]}",
        )[0]


class GpioChip:
    """A simulated chip with named lines (kernel: Documentation/admin-guide/gpio/gpio-sim.rst)."""

    def __init__(self, label, lines):
        run("modprobe gpio-sim")
        if not os.path.exists("/sys/kernel/config/gpio-sim"):
            run("mount -t configfs none /sys/kernel/config")
        chip = f"/sys/kernel/config/gpio-sim/{label}"
        os.makedirs(f"{chip}/bank0")
        self._write(f"{chip}/bank0/num_lines", len(lines))
        self._write(f"{chip}/bank0/label", label)
        for number, name in enumerate(lines):
            os.mkdir(f"{chip}/bank0/line{number}")
            self._write(f"{chip}/bank0/line{number}/name", name)
        self.config, self.lines = chip, lines
        self.plug_in()

    def plug_in(self):
        self._write(f"{self.config}/live", 1)
        with open(f"{self.config}/bank0/chip_name") as file:
            self.name = file.read().strip()
        (self.folder,) = glob.glob(f"/sys/devices/platform/*/{self.name}/sim_gpio0")
        self.folder = os.path.dirname(self.folder)

    def unplug(self):
        self._write(f"{self.config}/live", 0)

    @staticmethod
    def _write(path, value):
        with open(path, "w") as file:
            file.write(str(value))

    def value(self, line):
        with open(f"{self.folder}/sim_gpio{self.lines.index(line)}/value") as file:
            return int(file.read())

    def pull(self, line, level):
        self._write(f"{self.folder}/sim_gpio{self.lines.index(line)}/pull", f"pull-{level}")
