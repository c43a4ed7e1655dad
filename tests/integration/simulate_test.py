"""scree simulate as a program, held against its own truth by readers written from the formats'
descriptions alone: python3 simulate_test.py SCREE [TEST ...]"""

import json
import math
import os
import re
import struct
import sys
import tomllib

from pcap_file import SERIAL, pcap_records
from programs import ProgramTest, main

SCREE = sys.argv[1]
GRAVITY = 9.81


def serial_bytes(path):
    """The stream of a capture of the IMU's port, and the number of its records."""
    reads = [data for _, data in pcap_records(path, SERIAL)]
    return b"".join(reads), len(reads)


def imu_samples(stream):
    """MTData2 messages as dictionaries of data id to bytes; fails on anything that is no message."""
    samples, at = [], 0
    while at < len(stream):
        assert stream[at : at + 2] == b"\xfa\xff", at
        size = stream[at + 3]
        assert sum(stream[at + 1 : at + 5 + size]) % 256 == 0, at
        if stream[at + 2] == 0x36:
            body, i, sample = stream[at + 4 : at + 4 + size], 0, {}
            while i < len(body):
                key, length = struct.unpack_from(">HB", body, i)
                sample[key] = body[i + 3 : i + 3 + length]
                i += 3 + length
            samples.append(sample)
        at += 5 + size
    return samples


def signal(frame, encoder):
    """A DBC signal of a frame's eight bytes."""
    length, start = encoder["length"], encoder["start_bit"]
    if encoder["byte_order"] == "little_endian":
        value = int.from_bytes(frame, "little") >> start
    else:
        last = 8 * (start // 8) + 7 - start % 8 + length
        value = int.from_bytes(frame, "big") >> (64 - last)
    value &= (1 << length) - 1
    if encoder["signed"] and value >> (length - 1):
        value -= 1 << length
    return value


def tilt_from(quaternion):
    """The vertical in the child's axes."""
    w, x, y, z = quaternion
    return 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


class SimulateTest(ProgramTest):
    def simulate(self, *arguments):
        capture = self.path("capture")
        self.assertEqual(self.done(SCREE, "simulate", capture, "--force", *arguments).stdout, "")
        with open(os.path.join(capture, "truth.json")) as file:
            truth = json.load(file)
        with open(os.path.join(capture, "scree.toml"), "rb") as file:
            return capture, truth, tomllib.load(file)

    def info(self, capture):
        return json.loads(self.done(SCREE, "info", capture, "--json").stdout)

    def path_length(self, truth):
        points = [pose["p"] for pose in truth["poses"]]
        return sum(math.dist(a, b) for a, b in zip(points, points[1:]))

    def test_the_independent_decoder_reads_a_drive_alike(self):
        import compare_velodyne_decoder as reference

        for arguments in (["--scene", "rough"], ["--dual", "--scene", "grass", "--rate", "20"]):
            capture, _, _ = self.simulate("--seconds", "1", "--seed", "21", *arguments)
            points = reference.compare(SCREE, os.path.join(capture, "lidar.pcap"))
            self.assertGreater(points, 50_000)

    def test_imu_agrees_with_the_motion(self):
        capture, truth, config = self.simulate("--seconds", "3", "--seed", "21", "--imu-rate", "200")
        stream, records = serial_bytes(os.path.join(capture, "imu.pcap"))
        samples = imu_samples(stream)
        self.assertGreater(len(samples), 590)
        self.assertGreater(records, 590)
        counters = [int.from_bytes(sample[0x1020], "big") for sample in samples]
        ticks = [int.from_bytes(sample[0x1060], "big") for sample in samples]
        for i in range(1, len(samples)):
            self.assertEqual((counters[i] - counters[i - 1]) % 65536, 1)
            self.assertEqual((ticks[i] - ticks[i - 1]) % 2**32, 50)
        # Standing or driving, on average the specific force is gravity along the vertical that the
        # orientation tells, and the rates add up to the change of heading in the truth.
        force, vertical, turned = [0.0] * 3, [0.0] * 3, 0.0
        for sample in samples:
            up = tilt_from(struct.unpack(">4f", sample[0x2010]))
            rates = struct.unpack(">3f", sample[0x8020])
            turned += sum(a * b for a, b in zip(up, rates)) / 200
            for axis, value in enumerate(struct.unpack(">3f", sample[0x4020])):
                force[axis] += value / len(samples)
                vertical[axis] += GRAVITY * up[axis] / len(samples)
        self.assertLess(math.dist(force, vertical), 0.8)

        def heading(pose):
            w, x, y, z = pose["q"]
            return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

        change = heading(truth["poses"][-1]) - heading(truth["poses"][0])
        change = (change + math.pi) % (2 * math.pi) - math.pi
        self.assertAlmostEqual(turned, change, delta=0.1)

    def test_encoder_agrees_with_the_way(self):
        for seed in ("21", "22", "23", "24"):
            capture, truth, config = self.simulate("--seconds", "4", "--seed", seed, "--speed", "1")
            encoder = config["encoder"]
            first, last = (truth["poses"][i]["t_ns"] * 1e-9 for i in (0, -1))
            counts, times = [], []
            with open(os.path.join(capture, "can.log")) as file:
                for line in file:
                    t, frame_id, data = re.fullmatch(r"\((\d+\.\d{6})\) can0 (\w+)#(\w+)\n", line).groups()
                    if int(frame_id, 16) == encoder["can_id"] and first <= float(t) <= last:
                        counts.append(signal(bytes.fromhex(data), encoder))
                        times.append(float(t))
            self.assertGreater(len(counts), 350)
            if encoder["kind"] == "counter":
                wrap = 1 << encoder["length"]
                steps = [(b - a + wrap // 2) % wrap - wrap // 2 for a, b in zip(counts, counts[1:])]
                driven = sum(steps) * encoder["scale"]
            else:
                spans = [b - a for a, b in zip(times, times[1:])]
                driven = sum(v * dt for v, dt in zip(counts[1:], spans)) * encoder["scale"]
            way = self.path_length(truth)
            self.assertGreater(way, 1)
            self.assertGreater(driven, 0.96 * way - 0.03)
            self.assertLess(driven, 1.12 * way + 0.03)

    def test_every_scene_has_obstacles_in_sight(self):
        in_sight = 0
        for scene in ("easy", "rolling", "rough", "crater", "ditch", "grass", "mixed"):
            _, truth, _ = self.simulate("--seconds", "1", "--seed", "8", "--scene", scene)
            kinds = {obstacle["kind"] for obstacle in truth["obstacles"]}
            self.assertEqual(kinds, {"positive", "negative"}, scene)
            in_sight += any(entry["ids"] for entry in truth["visible"])
        self.assertGreaterEqual(in_sight, 4)

    def test_options_show_in_the_capture(self):
        capture, truth, _ = self.simulate("--seconds", "1", "--seed", "3", "--rate", "5", "--dual",
                                          "--pps", "--packet-loss", "0.1", "--at-rest")  # fmt: skip
        info = self.info(capture)
        self.assertEqual(list(info["return_modes"]), ["dual"])
        self.assertAlmostEqual(info["rpm"], 300, delta=3)
        self.assertGreater(info["lost"], 60)
        self.assertLess(self.path_length(truth), 1e-9)
        self.assertEqual(len(truth["visible"]), 5)

    def test_faults_lie_between_the_sensors_and_the_host(self):
        capture, truth, config = self.simulate("--seconds", "15", "--seed", "4", "--faults",
                                               "--scene", "easy", "--reverse")  # fmt: skip
        lost = self.info(capture)["lost"]
        self.assertAlmostEqual(lost / (15 * 754), 0.01, delta=0.004)

        stream, _ = serial_bytes(os.path.join(capture, "imu.pcap"))
        good, ticks, at = 0, [], 0
        while (at := stream.find(b"\xfa\xff\x36", at)) >= 0:
            message = stream[at : at + 5 + stream[at + 3]] if at + 3 < len(stream) else b""
            if message and sum(message[1:]) % 256 == 0:
                good += 1
                ticks.append(int.from_bytes(message[12:16], "big"))
                at += len(message)
            else:
                at += 1
        sent = (ticks[-1] - ticks[0]) / 100 + 1
        gaps = [(b - a) * 1e-4 for a, b in zip(ticks, ticks[1:])]
        self.assertAlmostEqual(max(gaps), 2, delta=0.05)
        missing = sent - good - 100 * max(gaps)
        self.assertGreater(missing, 3)
        self.assertLess(missing, 30)

        times, counts = [], []
        with open(os.path.join(capture, "can.log")) as file:
            for line in file:
                t, frame_id, data = re.fullmatch(r"\((\d+\.\d{6})\) can0 (\w+)#(\w+)\n", line).groups()
                if int(frame_id, 16) == config["encoder"]["can_id"]:
                    times.append(float(t))
                    counts.append(signal(bytes.fromhex(data), config["encoder"]))
        self.assertAlmostEqual(max(b - a for a, b in zip(times, times[1:])), 3, delta=0.05)
        wrap = 1 << config["encoder"]["length"]
        steps = [(b - a + wrap // 2) % wrap - wrap // 2 for a, b in zip(counts, counts[1:])]
        if config["encoder"]["kind"] == "counter":
            self.assertLess(sum(step for step in steps if step < 0) * config["encoder"]["scale"], -0.2)

    def test_a_gap_is_where_it_was_asked_for(self):
        capture, truth, _ = self.simulate("--seconds", "2", "--seed", "4", "--at-rest",
                                          "--imu-gap", "0.5,0.7", "--encoder-gap", "1,0.4")  # fmt: skip
        stream, _ = serial_bytes(os.path.join(capture, "imu.pcap"))
        ticks = [int.from_bytes(sample[0x1060], "big") for sample in imu_samples(stream)]
        self.assertAlmostEqual(max(b - a for a, b in zip(ticks, ticks[1:])) * 1e-4, 0.7, delta=0.02)

    def test_wrong_usage_exits_2(self):
        for arguments in (["--scene", "swamp"], ["--speed", "9"], ["--rate", "50"],
                          ["--faults", "--seconds", "5"], ["--imu-gap", "3"],
                          ["--imu-corruption", "2"], ["--at-rest", "--reverse"]):  # fmt: skip
            self.done(SCREE, "simulate", self.folder, *arguments, code=2)


if __name__ == "__main__":
    main(sys.argv[2:])
