"""The inputs of the pinned lists, and how each is made and handed to `scree detect`."""

import os

from pinned import detected

HERE = os.path.dirname(os.path.abspath(__file__))
CONFIG = os.path.join(HERE, "..", "..", "config")

CLOUD = "--cloud FILE --scene mixed --seed 5"
DRIVE = "--scene mixed --seed 31 --seconds 5"
FAULTS = ("--scene grass --seed 35 --seconds 5 --packet-loss 0.02 --imu-corruption 0.01"
          " --imu-bursts --imu-gap 2,0.8 --encoder-gap 3.2,0.8")  # fmt: skip
SWEEPS = "--scene mixed --seed 40 --seconds 2"

SOURCES = {
    "cloud": f"scree simulate {CLOUD}; config/scree.toml",
    "cloud_paper": f"scree simulate {CLOUD}; config/paper.toml",
    "drive": f"scree simulate DIR {DRIVE}",
    "drive_faults": f"scree simulate DIR {FAULTS}",
    "lidar_alone": f"scree simulate DIR {SWEEPS}; its lidar.pcap alone",
    "sweeps": f"scree simulate DIR {SWEEPS}; its lidar.pcap alone, map.registration = false",
    "interop": "the recording captures/interop of the shared data",
}


def lists_file(name):
    return os.path.join(HERE, "lists", f"{name}.txt")


class Missing(Exception):
    """An input that is not on this computer; says which."""


class Inputs:
    """Makes inputs in a folder. `run(program, *arguments)` runs a program that must end well."""

    def __init__(self, run, scree, shared_data, folder):
        self.run, self.scree, self.shared_data, self.folder = run, scree, shared_data, folder

    def lists(self, name):
        """The lists that `scree detect` gives for an input."""
        out = os.path.join(self.folder, f"{name}.jsonl")
        self.run(self.scree, "detect", *self.arguments(name), "--out", out)
        return detected(out)

    def arguments(self, name):
        if name == "cloud":
            return [self.cloud(name), "--config", os.path.join(CONFIG, "scree.toml")]
        if name == "cloud_paper":
            return [self.cloud(name), "--config", os.path.join(CONFIG, "paper.toml")]
        if name == "drive":
            return [self.drive(name, DRIVE)]
        if name == "drive_faults":
            return [self.drive(name, FAULTS)]
        if name == "lidar_alone":
            return [os.path.join(self.drive(name, SWEEPS), "lidar.pcap")]
        if name == "sweeps":
            config = os.path.join(self.folder, "sweeps.toml")
            with open(config, "w") as file:
                file.write("[map]\nregistration = false\n")
            return [os.path.join(self.drive(name, SWEEPS), "lidar.pcap"), "--config", config]
        return [self.recording()]

    def cloud(self, name):
        path = os.path.join(self.folder, f"{name}.pcd")
        self.run(self.scree, "simulate", *CLOUD.replace("FILE", path).split())
        return path

    def drive(self, name, options):
        path = os.path.join(self.folder, name)
        self.run(self.scree, "simulate", path, *options.split())
        return path

    def recording(self):
        path = os.path.join(self.shared_data, "captures", "interop")
        if not os.path.isdir(path):
            raise Missing(f"the recording is not at {path}")
        return path
