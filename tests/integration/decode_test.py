"""scree info and scree decode as programs: python3 decode_test.py SCREE [TEST ...]"""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

from synthetic_capture import data_packet, write_capture

SCREE = sys.argv[1]
HEADER = "t_ns,packet,block,channel,azimuth_deg,range_m,reflectivity,x,y,z"


class DecodeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.capture = os.path.join(folder.name, "lidar.pcap")
        write_capture(self.capture, 1.0)

    def scree(self, *arguments, code=0):
        done = subprocess.run([SCREE, *arguments], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def path(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w") as file:
                file.write(text)
        return path

    def test_info_counts_what_the_capture_holds(self):
        info = json.loads(self.scree("info", self.folder, "--json").stdout)
        self.assertEqual(info["packets"], 753)
        self.assertEqual(info["return_modes"], {"strongest": 753})
        self.assertEqual((info["lost"], info["refused"]), (0, {}))
        self.assertAlmostEqual(info["rpm"], 600, delta=1)
        self.assertEqual(info["position"]["packets"], 76)
        self.assertEqual([port["port"] for port in info["ports"]], [2368, 8308])
        table = self.scree("info", self.capture).stdout
        self.assertIn("port 2368     753 datagrams", table)

    def test_wrong_port_is_said(self):
        config = self.path("other.toml", "[lidar]\nport = 2369\n")
        for command in (["info"], ["decode", "--sensor", "lidar"]):
            said = self.scree(*command, self.capture, "--config", config, code=1).stderr
            self.assertIn("no packets to port 2369, but 75", said)
            self.assertIn("a second to 2368", said)

    def test_the_captures_own_configuration_is_used(self):
        self.path("scree.toml", '[lidar]\nmodel = "puck_hires"\n')
        said = self.scree("info", self.folder, code=1).stderr
        self.assertIn("product byte of another model than lidar.model", said)
        self.scree("info", self.capture)

    def test_decode_lists_every_return_without_loss(self):
        self.scree("decode", self.folder, "--sensor", "lidar", "--out", self.path("out.csv"))
        with open(self.path("out.csv")) as file:
            self.assertEqual(file.readline().strip(), HEADER)
            rows = list(csv.reader(file))
        self.assertEqual(len(rows), 753 * 12 * 16)
        first = dict(zip(HEADER.split(","), rows[0]))
        counts = int.from_bytes(data_packet(0)[4:6], "little")
        self.assertEqual(first["range_m"], f"{counts / 500:g}")
        self.assertEqual((first["packet"], first["block"], first["channel"]), ("0", "0", "0"))
        self.assertEqual(float(first["azimuth_deg"]), 0)
        printed = self.scree("decode", self.folder, "--sensor", "lidar").stdout
        self.assertEqual(len(printed.splitlines()), len(rows) + 1)

    def test_decode_writes_one_pcd_a_sweep(self):
        self.scree("decode", self.folder, "--sensor", "lidar", "--out", self.path("out.csv"),
                   "--pcd", self.path("sweeps"))  # fmt: skip
        sweeps = sorted(os.listdir(self.path("sweeps")))
        self.assertEqual(sweeps, [f"sweep_{i:06}.pcd" for i in range(10)])
        with open(self.path("sweeps/sweep_000003.pcd"), "rb") as file:
            self.assertIn(b"FIELDS x y z intensity", file.read(200))

    def test_a_cut_capture_gives_what_is_there(self):
        with open(self.capture, "r+b") as file:
            file.truncate(100_000)
        done = self.scree("decode", self.folder, "--sensor", "lidar")
        self.assertGreater(len(done.stdout.splitlines()), 70 * 12 * 16)
        self.assertIn("breaks off", done.stderr)

    def test_failures_are_one_sentence_and_exit_1(self):
        empty, foreign = self.path("empty.pcap", ""), self.path("foreign.pcap", "no capture at all")
        for capture in (self.path("none.pcap"), empty, foreign):
            for command in (["info"], ["decode", "--sensor", "lidar"]):
                said = self.scree(*command, capture, code=1).stderr
                self.assertEqual(len(said.splitlines()), 1, said)
                self.assertIn(os.path.basename(capture), said)
        unwritable = self.path("no/such/folder.csv")
        self.scree("decode", self.capture, "--sensor", "lidar", "--out", unwritable, code=1)
        self.scree("decode", self.capture, "--sensor", "lidar", "--out", "/dev/full", code=1)

    def test_wrong_usage_exits_2(self):
        self.scree("info", code=2)
        self.scree("decode", self.capture, code=2)
        self.scree("decode", self.capture, "--sensor", "radar", code=2)
        self.scree("info", "--help")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
