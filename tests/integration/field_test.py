"""Files that users of such programs had trouble with: python3 field_test.py SCREE DATA [TEST ...]"""

import json
import math
import os
import re
import shutil
import socket
import struct
import sys

from pcap_file import ETHERNET, SERIAL, pcap_records, write_pcap
from programs import SANITIZED, ProgramTest, main

SCREE, DATA = sys.argv[1:3]


class FieldTest(ProgramTest):
    def field(self, name):
        path = os.path.join(DATA, "field", name)
        if not os.path.exists(path):
            self.skipTest(f"{path} is not there")
        return path

    def detect(self, source):
        """The lists, as objects, of `scree detect`."""
        result = self.done(SCREE, "detect", source)
        return [json.loads(line) for line in result.stdout.splitlines()]

    def info_of(self, capture):
        return json.loads(self.done(SCREE, "info", capture, "--json").stdout)

    def info(self, name):
        return self.info_of(self.field(name))

    def test_a_cloud_far_from_the_origin_has_its_obstacles_in_its_own_coordinates(self):
        folder = self.field("pcd_far_from_origin")
        near = self.detect(os.path.join(folder, "local.pcd"))[0]["obstacles"]
        far = self.detect(os.path.join(folder, "utm.pcd"))[0]["obstacles"]
        self.assertEqual([o["kind"] for o in near], ["positive"])
        self.assertEqual([o["kind"] for o in far], ["positive"])
        with open(os.path.join(folder, "utm.pcd"), "rb") as file:
            x, y, z = struct.unpack("<3d", file.read().split(b"DATA binary\n", 1)[1][:24])
        with open(os.path.join(folder, "local.pcd"), "rb") as file:
            first = struct.unpack("<3f", file.read().split(b"DATA binary\n", 1)[1][:12])
        moved = [a - b for a, b in zip((x, y, z), first)]
        center = [a - b for a, b in zip(far[0]["center"], moved)]
        self.assertLess(math.dist(center, near[0]["center"]), 0.1)
        corner = [a - b for a, b in zip(far[0]["footprint"][0], moved)]
        self.assertLess(math.dist(corner, near[0]["center"][:2]), 1)

    def test_captures_of_several_interfaces_are_whole(self):
        for name in ("two_link_types.pcapng", "two_snaplens.pcapng"):
            self.assertEqual(self.info("pcapng_interfaces/" + name)["packets"], 302, name)
            capture = self.field("pcapng_interfaces/" + name)
            self.done(SCREE, "slice", capture, self.path(name))
            info = self.info_of(self.path(name))
            self.assertEqual(info["packets"], 302, name)

    def test_fragments_disorder_and_the_full_hour_cost_no_packet(self):
        self.assertEqual(self.info("ip_fragments/frag.pcap")["packets"], 168)
        for capture in ("reordered_datagrams/a.pcap", "hour_timestamp/beyond.pcap"):
            info = self.info(capture)
            self.assertEqual((info["lost"], info["refused"]), (0, {}), capture)
        self.assertEqual(self.info("reordered_datagrams/a.pcap")["packets"], 200)

    def wheel(self, name):
        """The values of the encoder in a folder of the field."""
        return [float(row[-1]) for row in self.decoded(SCREE, self.field(name), "encoder")]

    def test_dbc_files_of_other_programs_are_read_or_named(self):
        self.assertEqual(len(self.wheel("j1939_source_address")), 50)
        self.assertGreater(len(self.wheel("dbc/float")), 10)
        self.assertAlmostEqual(self.wheel("dbc/utf8name")[0], 10 / 3.6, places=4)
        for name, words in {
            "units3": "1 KPH is 0.277778 m/s",
            "commentq": "wheel.dbc:9: ",
            "dashname": "wheel.dbc:9: the line cannot be read",
            "utf16": "save it as UTF-8",
        }.items():
            result = self.run_to_end(
                SCREE, "decode", self.field(f"dbc/{name}"), "--sensor", "encoder"
            )  # fmt: skip
            self.assert_fails(result, words)

    def test_logs_of_candump_are_read_whatever_their_form(self):
        folder = self.field("candump_kinds")
        counts = {}
        for name in ("ta.log", "bom.log"):
            config = os.path.join(folder, "enc.toml")
            log = os.path.join(folder, name)
            counts[name] = self.decoded(SCREE, log, "encoder", "--config", config)
        self.assertGreater(len(counts["ta.log"]), 10)
        self.assertEqual(counts["ta.log"], counts["bom.log"])

    def test_times_that_are_differences_are_said(self):
        with open(self.field("candump_kinds/ta.log")) as file:
            frames = [re.match(r" \((.*?)\)(.*)", line).groups() for line in file]
        lines, before = [], float(frames[0][0])
        for stamp, frame in frames:
            lines.append(f" ({float(stamp) - before:010.6f}){frame}\n")
            before = float(stamp)
        log = self.write("td.log", "".join(lines))
        config = self.field("candump_kinds/enc.toml")
        arguments = ["--sensor", "encoder", "--config", config, "--out", self.path("td.csv")]
        said = self.done(SCREE, "decode", log, *arguments).stderr
        self.assertIn("candump -td", said)

    def test_a_log_by_another_clock_is_said_with_both_times(self):
        log = self.field("can_log_other_clock/tz.can.log")
        drive = os.path.join(DATA, "captures/interop")
        self.done(SCREE, "slice", drive, self.path("part"), "--to", "3")
        shutil.copyfile(log, self.path("part/can.log"))
        said = self.done(SCREE, "detect", self.path("part"), "--out", self.path("l.jsonl")).stderr
        self.assertRegex(said, "encoder's frames lie outside the lidar's time .1970-01-01 .* 2020-08-28")

    def test_of_two_lidars_on_one_port_one_is_taken(self):
        for name, words in {
            "two_senders/two.pcap": ("192.168.1.20", "lidar.sender"),
            "lcm_log/two_lidars.log": ("several channels", "lidar.sender"),
        }.items():
            info = self.info(name)
            self.assertLess(info["rpm"], 1300, name)
            self.assertEqual((info["lost"], info["refused"]), (0, {}), name)
            for word in words:
                self.assertIn(word, info["two_senders"])
            result = self.done(SCREE, "detect", self.field(name))
            self.assertIn("lidar.sender", result.stderr)

    def test_files_are_known_by_their_content(self):
        folder = self.field("file_kinds")
        for name in ("CLOUD.PCD", "cloud_without_suffix"):
            self.assertEqual(len(self.detect(os.path.join(folder, name))), 1, name)
        result = self.run_to_end(SCREE, "info", os.path.join(folder, "cap.pcap.gz"))
        self.assert_fails(result, "is packed with gzip: unpack it first")

    def test_a_step_of_the_hosts_clock_of_any_size_changes_nothing(self):
        make = self.field("clock_step/make.py")
        drive = os.path.join(DATA, "captures", "interop")
        last = {}
        steps = ("0", "-5") if SANITIZED else ("0", "2", "-0.3", "-86400")
        for step in steps:
            out = self.path("step" + step)
            self.done(sys.executable, make, drive, out, step)
            result = self.done(SCREE, "detect", out)
            lines = [json.loads(line) for line in result.stdout.splitlines()]
            stamps = [line["stamp_ns"] for line in lines]
            self.assertEqual(stamps, sorted(stamps), step)
            last[step] = lines[-1]
            self.assertEqual("the host's clock was set" in result.stderr, step != "0", step)
        for step, line in last.items():
            apart = math.dist(line["pose"]["p"], last["0"]["pose"]["p"])
            self.assertLess(apart, 0.005, step)
            self.assertEqual(len(line["obstacles"]), len(last["0"]["obstacles"]), step)

    def simulated(self):
        drive = self.path("drive")
        if not os.path.exists(drive):
            self.done(SCREE, "simulate", drive, "--scene", "easy", "--seconds", "5")
        return drive

    def interrupted(self, name, gap, step, of_all):
        """A drive whose lidar, or of which everything, is away for `gap` seconds while the host's clock
        is set by `step` seconds."""
        drive, out = self.simulated(), self.path(name)
        os.mkdir(out)
        shutil.copy(os.path.join(drive, "scree.toml"), out)
        middle = next(pcap_records(os.path.join(drive, "lidar.pcap")))[0] + 25 * 10**8

        def set_clock(stamp):
            return stamp + (round(step * 1e9) if stamp >= middle else 0)

        def is_away(stamp):
            return middle <= stamp < middle + gap * 1e9

        for file, link_type in (("lidar.pcap", ETHERNET), ("imu.pcap", SERIAL)):
            records = [
                (set_clock(stamp), data)
                for stamp, data in pcap_records(os.path.join(drive, file), link_type)
                if not (is_away(stamp) and (of_all or link_type == ETHERNET))
            ]
            write_pcap(os.path.join(out, file), records, link_type)
        with open(os.path.join(drive, "can.log")) as log, open(os.path.join(out, "can.log"), "w") as copy:
            for line in log:
                time, rest = line[1:].split(")", 1)
                stamp = round(float(time) * 1e6) * 1000
                if not (of_all and is_away(stamp)):
                    copy.write(f"({set_clock(stamp) / 1e9:.6f}){rest}")
        return out

    def test_a_step_of_the_hosts_clock_in_a_gap_changes_nothing(self):
        cases = [(1, 0.5, True), (0.6, -1, True), (1, 2, False)]
        for gap, step, of_all in cases[:1] if SANITIZED else cases:
            poses = []
            for by in (0, step):
                out = self.interrupted(f"{gap}_{step}_{by}", gap, by, of_all)
                result = self.done(SCREE, "detect", out)
                lines = [json.loads(line) for line in result.stdout.splitlines()]
                stamps = [line["stamp_ns"] for line in lines]
                self.assertEqual(stamps, sorted(stamps), (gap, by))
                self.assertEqual("the host's clock was set" in result.stderr, by != 0)
                poses.append(lines[-1]["pose"]["p"])
            self.assertLess(math.dist(*poses), 0.02, (gap, step))

    def test_two_recordings_joined_the_wrong_way_round_keep_the_order_of_time(self):
        drive, joined = self.simulated(), self.path("joined.pcap")
        records = list(pcap_records(os.path.join(drive, "lidar.pcap")))[:3000]
        write_pcap(joined, records[1500:] + records[:1500])
        result = self.done(SCREE, "detect", joined)
        stamps = [json.loads(line)["stamp_ns"] for line in result.stdout.splitlines()]
        self.assertEqual(stamps, sorted(stamps))
        self.assertIn("the host's clock was set by -", result.stderr)

    def test_every_command_takes_a_step_of_the_hosts_clock_out(self):
        make = self.field("clock_step/make.py")
        drive = os.path.join(DATA, "captures", "interop")
        for step in ("0", "-5", "3600"):
            out, part = self.path("step" + step), self.path("part" + step)
            self.done(sys.executable, make, drive, out, step)
            info = self.info_of(out)
            self.assertAlmostEqual(info["seconds"], 8, delta=0.1, msg=step)
            self.assertAlmostEqual(info["rpm"], 600, delta=1, msg=step)
            self.assertEqual(info["clock"]["host_steps"], int(step != "0"))
            self.assertEqual(info["encoder"]["refused"], {}, step)
            self.done(SCREE, "slice", out, part, "--from", "2", "--to", "6")
            self.assertEqual(self.info_of(part)["packets"], 3014, step)
            for sensor, rows in (("imu", 799), ("encoder", 799)):
                csv = self.path(sensor + step)
                self.done(SCREE, "decode", out, "--sensor", sensor, "--out", csv)
                with open(csv) as file:
                    times = [int(line.split(",")[0]) for line in file.readlines()[1:]]
                self.assertEqual(times, sorted(times), step)
                self.assertGreater(len(times), rows)
                self.assertLess(times[-1] - times[0], 9e9, step)

    def test_a_capture_is_replayed_over_a_step_of_the_hosts_clock(self):
        capture = self.field("replay_clock_jump/forward_1h.pcap")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
            listener.bind(("127.0.0.1", 0))
            address = "127.0.0.1:%d" % listener.getsockname()[1]
            result = self.run_to_end(SCREE, "replay", capture, "--address", address)
        self.assertIn("sent 150 data packets", result.stderr)
        self.assertEqual(self.info("replay_clock_jump/forward_1h.pcap")["rpm"], 600)

    def test_headers_that_other_programs_write_are_read(self):
        folder = self.field("pcd_headers")
        for name in ("bom.pcd", "lower_case_types.pcd"):
            self.assertEqual(len(self.detect(os.path.join(folder, name))), 1, name)
        result = self.run_to_end(SCREE, "detect", os.path.join(folder, "one_line_short.pcd"))
        self.assert_fails(result, "1999 of 2000 points")


if __name__ == "__main__":
    main(sys.argv[3:])
