"""scree info and scree decode as programs: python3 decode_test.py SCREE [TEST ...]"""

import csv
import json
import os
import struct
import sys

from live_sensors import xbus_message
from pcap_file import ETHERNET, SERIAL, write_pcap
from programs import ProgramTest, main
from synthetic_capture import data_packet, write_capture

SCREE = sys.argv[1]
HEADER = "t_ns,packet,block,channel,azimuth_deg,range_m,reflectivity,x,y,z"
IMU_HEADER = (
    "t_ns,packet_counter,sample_time_fine,qw,qx,qy,qz,roll_deg,pitch_deg,yaw_deg,"
    "wx,wy,wz,ax,ay,az,status"
)


def item(data_id, data):
    return struct.pack(">HB", data_id, len(data)) + data


def imu_message(i):
    """Double quaternion, float rate, fixed-point acceleration; no angles."""
    return xbus_message(
        0x36,
        item(0x1020, struct.pack(">H", i % 65536))
        + item(0x1060, struct.pack(">I", 100 * i))
        + item(0x2013, struct.pack(">4d", 0.6, 0.0, 0.8, 0.0))
        + item(0x8020, struct.pack(">3f", 0.1, -0.2, 1e-7))
        + item(0x4021, struct.pack(">3i", 1 << 20, -1, 10 << 20))
        + item(0xE020, struct.pack(">I", 0x80000003)),
    )


class DecodeTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.capture = self.path("lidar.pcap")
        write_capture(self.capture, 1.0)

    def scree(self, *arguments, code=0):
        return self.done(SCREE, *arguments, code=code)

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
        config = self.write("other.toml", "[lidar]\nport = 2369\n")
        for command in (["info"], ["decode", "--sensor", "lidar"]):
            said = self.scree(*command, self.capture, "--config", config, code=1).stderr
            self.assertIn("no packets to port 2369, but 75", said)
            self.assertIn("a second to 2368", said)

    def test_the_captures_own_configuration_is_used(self):
        self.write("scree.toml", '[lidar]\nmodel = "puck_hires"\n')
        said = self.scree("info", self.folder, code=1).stderr
        self.assertIn('of a VLP-16 or Puck LITE: set lidar.model = "vlp16"', said)
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
        self.scree("decode", self.folder, "--sensor", "lidar", "--out", self.path("out.csv"), "--force",
                   "--pcd", self.path("sweeps"))  # fmt: skip
        sweeps = sorted(os.listdir(self.path("sweeps")))
        self.assertEqual(sweeps, [f"sweep_{i:06}.pcd" for i in range(10)])
        with open(self.path("sweeps/sweep_000003.pcd"), "rb") as file:
            self.assertIn(b"FIELDS x y z intensity", file.read(200))

    def write_imu(self, reads, link_type=SERIAL):
        """Reads of the port, 10 ms apart."""
        start = 1_600_000_000_000_000_000
        records = [(start + i * 10_000_000, data) for i, data in enumerate(reads)]
        write_pcap(self.path("imu.pcap"), records, link_type)

    def decoded_imu(self, reads):
        self.write_imu(reads)
        done = self.scree("decode", self.folder, "--sensor", "imu")
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], IMU_HEADER)
        return list(csv.DictReader(lines)), done.stderr

    def test_decode_imu_lists_every_message_as_sent(self):
        stream = b"".join(imu_message(i) for i in range(65530, 65540))
        rows, said = self.decoded_imu([stream[i : i + 70] for i in range(0, len(stream), 70)])
        self.assertEqual(said, "")
        self.assertEqual([int(row["packet_counter"]) for row in rows],
                         [i % 65536 for i in range(65530, 65540)])  # fmt: skip
        row = rows[3]
        self.assertEqual(row["sample_time_fine"], "6553300")
        self.assertEqual([row[name] for name in ("qw", "qx", "qy", "qz")], ["0.6", "0", "0.8", "0"])
        self.assertEqual([row[name] for name in ("wx", "wy", "wz")], ["0.1", "-0.2", "1e-07"])
        self.assertEqual([float(row[name]) for name in ("ax", "ay", "az")], [1, -1 / (1 << 20), 10])
        self.assertEqual([row[name] for name in ("roll_deg", "pitch_deg", "yaw_deg")], [""] * 3)
        self.assertEqual(row["status"], str(0x80000003))
        times = [int(row["t_ns"]) for row in rows]
        self.assertEqual(times, sorted(times))
        self.scree("decode", self.path("imu.pcap"), "--sensor", "imu", "--out", self.path("o.csv"))
        with open(self.path("o.csv")) as file:
            self.assertEqual(len(file.readlines()), 11)

    def test_decode_imu_says_what_is_wrong(self):
        messages = [imu_message(i) for i in range(20)]
        messages[5] = messages[5][:20] + b"\x55" + messages[5][21:]
        messages[9] = b"some garbage" + messages[9]
        messages[12] = messages[11]
        messages.append(xbus_message(0x36, item(0x1020, b"\0\x14") + item(0xF770, b"abc") + item(0x1060, b"")))
        rows, said = self.decoded_imu(messages)
        self.assertEqual(len(rows), 19)
        for sentence in ("1 wrong checksum", "1 duplicate", "1 an item has the wrong size",
                         "bytes belong to no message", "2 messages are missing",
                         "1 values of unknown kinds"):  # fmt: skip
            self.assertIn(sentence, said)

    def test_decode_imu_of_nothing_is_one_sentence_and_exit_1(self):
        cases = {
            "no bytes": [],
            "no Xbus message in 300 bytes": [b"nothing of the kind ." + bytes(79)] * 3,
            "3 Xbus messages, but none with measurements": [xbus_message(0x3E, b"")] * 3,
            "wrong checksum": [imu_message(1)[:-1] + b"\0"],
        }
        for sentence, reads in cases.items():
            self.write_imu(reads)
            said = self.scree("decode", self.folder, "--sensor", "imu", code=1).stderr
            self.assertEqual(len(said.splitlines()), 1, said)
            self.assertIn(sentence, said)
        self.write_imu([imu_message(1)], ETHERNET)
        said = self.scree("decode", self.folder, "--sensor", "imu", code=1).stderr
        self.assertIn("holds no serial bytes (link type 1, not 147)", said)
        os.remove(self.path("imu.pcap"))
        said = self.scree("decode", self.folder, "--sensor", "imu", code=1).stderr
        self.assertIn("the folder has no imu.pcap", said)

    def test_a_cut_capture_gives_what_is_there(self):
        with open(self.capture, "r+b") as file:
            file.truncate(100_000)
        done = self.scree("decode", self.folder, "--sensor", "lidar")
        self.assertGreater(len(done.stdout.splitlines()), 70 * 12 * 16)
        self.assertIn("breaks off", done.stderr)

    def test_decode_lists_every_encoder_reading(self):
        can = "(1598601600.000001) can0 1A0#FEFFFFFF\n(1598601600.010001) can0 0C8#01\n"
        can += "(1598601600.010002) can1 1A0#07000000\n(1598601600.020001) can0 1A0#00000070\n"
        can += "(1598601600.030001) can0 1A0#00\nnonsense\n(1598601600.040001) can0 1A0#01000000"
        self.write("can.log", can)
        done = self.scree("decode", self.folder, "--sensor", "encoder")
        self.assertEqual(done.stdout.splitlines(), [
            "t_ns,raw,value", "1598601600000001000,-2,-0.000314",
            "1598601600020001000,1879048192,295010.566144", "1598601600040001000,1,0.000157"])  # fmt: skip
        self.assertIn("1 lines refused", done.stderr)
        self.assertIn("2 frames refused", done.stderr)
        self.write("scree.toml", "[encoder]\nsigned = false\nscale = 1\n")
        done = self.scree("decode", self.folder, "--sensor", "encoder")
        self.assertIn("1598601600000001000,4294967294,4294967294\n", done.stdout)

    def test_a_dbc_file_beside_the_configuration_places_the_signal(self):
        self.write("can.log", "(5.000001) can0 000001D0#0102\n(5.010001) can0 1D0#0BB8\n")
        self.write("robot.dbc", "BO_ 464 SPEEDS: 2 A\n"
                  ' SG_ LEFT : 7|16@0+ (0.01,-10) [0|0] "km/h" A\n')  # fmt: skip
        toml = '[encoder]\ndbc = "robot.dbc"\nsignal = "SPEEDS.{}"\nkind = "{}"\n{}\n'
        said = {"signal": ("LEFD", "speed", "scale = 0.27"), "kph": ("LEFT", "speed", "scale = 1"),
                "kind": ("LEFT", "counter", "scale = 0.27"), "scale": ("LEFT", "speed", "")}  # fmt: skip
        for word, values in said.items():
            self.write("scree.toml", toml.format(*values))
            error = self.scree("decode", self.folder, "--sensor", "encoder", code=1).stderr
            self.assertIn(word.replace("kph", "1 km/h is 0.277778 m/s"), error)
            self.assertEqual(len(error.splitlines()), 1, error)
        self.write("scree.toml", toml.format("LEFT", "speed", "scale = 0.25"))
        lines = self.scree("decode", self.folder, "--sensor", "encoder").stdout.splitlines()
        self.assertEqual(lines[1:], ["5010001000,3000,5"])

    def test_no_encoder_reading_is_one_sentence_and_exit_1(self):
        def said(log):
            self.write("can.log", log)
            error = self.scree("decode", self.folder, "--sensor", "encoder", code=1).stderr
            self.assertEqual(len(error.splitlines()), 1, error)
            return error

        error = self.scree("decode", self.folder, "--sensor", "encoder", code=1).stderr
        self.assertIn("no can.log", error)
        self.assertIn("no frame with identifier 0x1A0", said("(5.0) can0 1A1#01\n"))
        self.assertIn("no frame of can0, but 1 of can7", said("(5.0) can7 1A0#01020304\n"))
        self.assertIn("frame is shorter than the signal", said("(5.0) can0 1A0#0102\n"))
        self.assertIn("error frame", said("(5.0) can0 20000040#0000000000000000\n"))
        self.assertIn("no CAN frame", said(""))
        self.assertIn("not of the form", said("nonsense\n"))

    def test_failures_are_one_sentence_and_exit_1(self):
        empty, foreign = self.write("empty.pcap", ""), self.write("foreign.pcap", "no capture at all")
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
        self.scree("decode", self.capture, "--sensor", "imu", "--pcd", self.folder, code=2)
        self.scree("info", "--help")


if __name__ == "__main__":
    main(sys.argv[2:])
