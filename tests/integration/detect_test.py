"""scree detect as a program: python3 detect_test.py SCREE DATA [TEST ...]"""

import json
import math
import os
import random
import re
import struct
import subprocess
import sys

from pcap_file import write_pcap
from programs import ProgramTest, main
from synthetic_capture import PACKET_NS, data_packet, frame

SCREE, DATA = sys.argv[1:3]
PAPER = os.path.join(os.path.dirname(__file__), "..", "..", "config", "paper.toml")
KEYS = ["id", "kind", "confidence", "center", "extent", "yaw", "height", "velocity", "points"]


class DetectTest(ProgramTest):
    def scree(self, *arguments, code=0):
        return self.done(SCREE, *arguments, code=code)

    def detect(self, source, *arguments):
        """The lists, as objects, of `scree detect`."""
        self.scree("detect", source, "--out", self.path("lists.jsonl"), "--force", *arguments)
        with open(self.path("lists.jsonl")) as file:
            return [json.loads(line) for line in file]

    def simulated_cloud(self):
        cloud = self.path("cloud.pcd")
        if not os.path.exists(cloud):
            self.scree("simulate", "--cloud", cloud, "--seed", "5", "--points", "900000")
        return cloud

    def write_pcd(self, name, points, data="ascii", fields="x y z", numbers="F"):
        """A PCD file of tuples; `numbers` gives the type letter of every field."""
        path, count = self.path(name), len(fields.split())
        with open(path, "wb") as file:
            header = (
                f"VERSION 0.7\nFIELDS {fields}\nSIZE {' '.join(['4'] * count)}\n"
                f"TYPE {' '.join(numbers * count)}\nCOUNT {' '.join(['1'] * count)}\n"
                f"WIDTH {len(points)}\nHEIGHT 1\nPOINTS {len(points)}\nDATA {data}\n"
            )
            file.write(header.encode())
            for point in points:
                text = " ".join(repr(value) for value in point) + "\n"
                file.write(text.encode() if data == "ascii" else struct.pack(f"<{count}f", *point))
        return path

    def check_list(self, obstacle_list):
        self.assertEqual(list(obstacle_list), ["stamp_ns", "pose", "obstacles"])
        ids = [obstacle["id"] for obstacle in obstacle_list["obstacles"]]
        self.assertEqual(len(ids), len(set(ids)))
        for obstacle in obstacle_list["obstacles"]:
            evidence = obstacle.get("evidence")
            evidence_key = ["evidence"] if evidence else []
            self.assertEqual(list(obstacle), [*KEYS, *evidence_key, "footprint"])
            self.assertIn(evidence, (None, "inside", "wall", "edge", "shadow"))
            self.assertFalse(obstacle["kind"] == "negative" and evidence is None)
            self.assertTrue(3 <= len(obstacle["footprint"]) <= 16)
            for x, y in obstacle["footprint"]:
                away = math.dist((x, y), obstacle["center"][:2])
                self.assertLess(away, math.dist((0, 0, 0), obstacle["extent"]))
            self.assertGreater(obstacle["id"], 0)
            self.assertIn(obstacle["kind"], ("positive", "negative"))
            self.assertTrue(0 <= obstacle["confidence"] <= 1)
            self.assertEqual((len(obstacle["center"]), len(obstacle["extent"])), (3, 3))
            self.assertTrue(all(math.isfinite(v) for v in obstacle["center"] + obstacle["extent"]))

    def stages(self, *arguments):
        """Counts of the stages by name, and the names of their clouds."""
        done = self.scree("detect", self.simulated_cloud(), "--out", self.path("l.jsonl"), "--force",
                          "--stages", self.path("stages"), *arguments)  # fmt: skip
        counts = {}
        for stage in done.stdout.strip().split(" -> "):
            name, count = stage.rsplit(" ", 1)
            counts[name] = int(count)
        self.assertEqual(counts["input"], 900000)
        self.assertGreater(counts["obstacles"], 0)
        names = sorted(os.listdir(self.path("stages")))
        self.assertEqual(names[0], "0_input.pcd")
        self.assertEqual(names[-1], "7_clusters.pcd")
        return counts, names

    def assert_falling(self, counts, *names):
        falling = [counts[name] for name in names]
        self.assertEqual(falling, sorted(falling, reverse=True), names)

    def test_a_cloud_gives_one_list_that_fits_its_truth(self):
        lists = self.detect(self.simulated_cloud())
        self.assertEqual(len(lists), 1)
        self.check_list(lists[0])
        self.assertEqual(lists[0]["stamp_ns"], 0)
        self.assertEqual(lists[0]["pose"], {"p": [0, 0, 0], "q": [1, 0, 0, 0]})
        with open(self.path("cloud.truth.json")) as file:
            truth = json.load(file)["obstacles"]
        found = 0
        for wanted in truth:
            found += any(
                o["kind"] == wanted["kind"]
                and math.dist(o["center"][:2], wanted["center"][:2]) < 0.7
                for o in lists[0]["obstacles"]
            )
        self.assertGreaterEqual(found, 0.8 * len(truth))
        self.assertLessEqual(len(lists[0]["obstacles"]), 1.4 * len(truth))

    def test_the_same_capture_gives_the_same_bytes(self):
        self.scree("simulate", self.path("capture"), "--seconds", "1", "--seed", "3")
        lists = self.detect(self.path("capture"))
        printed = self.scree("detect", self.path("capture")).stdout
        with open(self.path("lists.jsonl"), "rb") as file:
            self.assertEqual(printed.encode(), file.read())
        self.assertIn(len(lists), (10, 11))
        stamps = [each["stamp_ns"] for each in lists]
        self.assertEqual(stamps, sorted(stamps))
        self.assertAlmostEqual((stamps[-2] - stamps[0]) / (len(stamps) - 2), 1e8, delta=1e6)
        for each in lists:
            self.check_list(each)
        self.assertTrue(any(each["obstacles"] for each in lists))

    def test_a_turn_may_have_several_lists(self):
        capture = self.path("capture")
        self.scree("simulate", capture, "--seconds", "2", "--seed", "3")
        whole = self.detect(capture)
        with open(os.path.join(capture, "scree.toml"), "a") as file:
            file.write("[detect]\nlists_per_turn = 4\n")
        parted = self.detect(capture)
        self.assertGreater(len(parted), 3.5 * len(whole))
        stamps = [each["stamp_ns"] for each in parted]
        self.assertEqual(stamps, sorted(set(stamps)))
        poses = {each["stamp_ns"]: each["pose"] for each in parted}
        for each in whole:
            self.assertEqual(poses[each["stamp_ns"]], each["pose"])
        for each in parted:
            self.check_list(each)
        self.assertTrue(all(each["obstacles"] for each in parted[20:]))

    def cells_of(self, grid):
        """The states of a grid, a text of a sign a cell for each row."""
        rows = []
        for row in grid["states"]:
            runs = re.findall(r"(\d*)([?.#v])", row)
            self.assertEqual("".join(count + sign for count, sign in runs), row)
            rows.append("".join(int(count or 1) * sign for count, sign in runs))
        self.assertEqual([len(row) for row in rows], [grid["columns"]] * grid["rows"])
        return rows

    def test_a_drive_has_a_grid_for_each_list(self):
        capture, file = self.path("capture"), self.path("grids.jsonl")
        self.scree("simulate", capture, "--seconds", "5", "--seed", "7")
        lists = self.detect(capture, "--grid", file)
        with open(file) as lines:
            grids = [json.loads(line) for line in lines]
        self.assertEqual([each["stamp_ns"] for each in grids], [each["stamp_ns"] for each in lists])
        for found, grid in zip(lists, grids):
            self.assertEqual(grid["pose"], found["pose"])
            size, origin, rows = grid["cell_size"], grid["origin"], self.cells_of(grid)
            self.assertEqual((size, len(rows), len(rows[0])), (0.2, 120, 120))
            for place, middle in zip(origin, grid["pose"]["p"]):
                self.assertAlmostEqual(place / size, round(place / size), 6)
                self.assertAlmostEqual(place + 60 * size, middle, delta=size / 2 + 1e-6)
            signs = "".join(rows)
            self.assertEqual(len(grid["ground"]), len(signs) - signs.count("?"))
            covered = 0
            for obstacle in found["obstacles"]:
                for x, y in [obstacle["center"][:2], *obstacle["footprint"]]:
                    column, row = ((place - low) / size for place, low in zip((x, y), origin))
                    # A corner on an edge may count to either side.
                    if min(column % 1, 1 - column % 1, row % 1, 1 - row % 1) < 1e-6:
                        continue
                    if 0 <= column < 120 and 0 <= row < 120:
                        self.assertIn(rows[int(row)][int(column)], "#v")
                        covered += 1
            self.assertEqual(covered > 0, "#" in signs or "v" in signs)
        signs = "".join(self.cells_of(grids[-1]))
        self.assertGreater(signs.count("."), 1000)
        self.assertGreater(signs.count("?"), 3000)
        self.assertGreater(signs.count("#"), 10)

    def test_what_has_no_grid_says_so(self):
        out = ["--out", self.path("l.jsonl"), "--grid", self.path("g.jsonl")]
        refused = self.scree("detect", self.simulated_cloud(), *out, code=1).stderr
        self.assertIn("only the map has a grid", refused)
        capture = self.path("capture")
        self.scree("simulate", capture, "--seconds", "1")
        config = self.write("scree.toml", "[lcm]\ngrid = false\n")
        refused = self.scree("detect", capture, "--config", config, *out, code=1).stderr
        self.assertIn("it needs lcm.grid", refused)

    def test_stages_are_written_and_counted(self):
        counts, names = self.stages()
        # Bodies have level points too, and some without a slope.
        self.assert_falling(counts, "input", "voxel grid", "below clearance", "candidates", "clusters")
        self.assert_falling(counts, "below clearance", "with slope")
        self.assert_falling(counts, "candidates", "kept")  # without lone points
        self.assertNotIn("5_supervoxels.pcd", names)
        # A stage's cloud is a cloud like any other.
        self.detect(self.path("stages/1_voxel_grid.pcd"))

    def test_stages_of_the_paper_fall_one_after_the_other(self):
        counts, names = self.stages("--config", PAPER)
        self.assert_falling(counts, "input", "voxel grid", "below clearance", "with slope",
                            "candidates", "kept", "super-voxels", "large enough", "clusters",
                            "obstacles")  # fmt: skip
        self.assertLess(counts["kept"], counts["candidates"])
        self.assertIn("5_supervoxels.pcd", names)
        self.assertIn("6_centers.pcd", names)

    def test_every_kind_of_pcd_is_read(self):
        draw = random.Random(1)
        points = []
        for _ in range(30000):
            x, y = draw.uniform(-4, 4), draw.uniform(-4, 4)
            height = 0.5 if math.hypot(x - 1, y) < 0.4 else 0.0
            points.append((x, y, height + draw.gauss(0, 0.004), 30.0))
        bare = [point[:3] for point in points]
        lists = [
            self.detect(self.write_pcd("a.pcd", points, fields="x y z intensity")),
            self.detect(self.write_pcd("b.pcd", points, "binary", fields="x y z intensity")),
            self.detect(self.write_pcd("c.pcd", bare)),
            self.detect(self.write_pcd("d.pcd", bare, "binary")),
        ]
        for each in lists:
            self.assertEqual([o["kind"] for o in each[0]["obstacles"]], ["positive"])
            self.assertLess(math.dist(each[0]["obstacles"][0]["center"][:2], (1, 0)), 0.3)

    def test_clouds_with_hardly_anything_were_not_looked_at(self):
        nan, inf = math.nan, math.inf
        for points, words in [
            ([(1.0, 2.0, 3.0)], "at 1 place, too few"),
            ([(1.0, 2.0, 3.0)] * 5000, "at 1 place, too few"),
            ([(0.3 * i, 2.0, 3.0) for i in range(20)], "at 20 places, too few"),
            ([], "holds no points"),
            ([(nan, 0.0, 0.0), (inf, 0.0, 0.0), (0.0, -inf, 0.0)] * 50, "none of its 150 points"),
            ([(nan, 0.0, 0.0)] * 199 + [(1.0, 0.0, 0.0)], "1 of its 200 points can be used"),
        ]:
            for data in ("ascii", "binary"):
                result = self.run_to_end(SCREE, "detect", self.write_pcd("none.pcd", points, data))
                self.assert_fails(result, words)

    def test_a_capture_without_a_return_was_not_looked_at(self):
        def without_returns(number):
            packet = bytearray(data_packet(number))
            for block in range(0, 1200, 100):
                packet[block + 4 : block + 100] = bytes(96)
            return bytes(packet)

        records = ((number * PACKET_NS, frame(without_returns(number), 2368)) for number in range(400))
        write_pcap(self.path("dark.pcap"), records)
        result = self.run_to_end(SCREE, "detect", self.path("dark.pcap"))
        self.assert_fails(result, "dark.pcap: nothing was looked at")

    def test_a_lidar_that_does_not_turn_gives_no_list(self):
        def standing(number):
            packet = bytearray(data_packet(number))
            for block in range(0, 1200, 100):
                packet[block + 2 : block + 4] = b"\x10\x27"
            return bytes(packet)

        records = ((number * PACKET_NS, frame(standing(number), 2368)) for number in range(800))
        write_pcap(self.path("standing.pcap"), records)
        info = json.loads(self.done(SCREE, "info", self.path("standing.pcap"), "--json").stdout)
        self.assertIn("the lidar did not turn in", info["standing"])
        result = self.run_to_end(SCREE, "detect", self.path("standing.pcap"))
        self.assertIn("the lidar did not turn in", result.stderr)
        self.assertLessEqual(len(result.stdout.splitlines()), 1)

    def test_packets_that_are_missing_are_said(self):
        records = ((number * PACKET_NS, frame(data_packet(number), 2368)) for number in range(0, 800, 2))
        write_pcap(self.path("lossy.pcap"), records)
        result = self.run_to_end(SCREE, "detect", self.path("lossy.pcap"))
        self.assertRegex(result.stderr, r"of \d+ packets of the lidar are missing \(50 %\)")

    def test_a_capture_that_has_lost_its_times_is_refused(self):
        records = ((10**18, frame(data_packet(number), 2368)) for number in range(400))
        write_pcap(self.path("timeless.pcap"), records)
        for command in (["detect"], ["decode", "--sensor", "lidar"]):
            result = self.run_to_end(SCREE, *command, self.path("timeless.pcap"))
            self.assert_fails(result, "timeless.pcap: all packets arrived at one time")

    def test_failures_are_one_sentence_and_exit_1(self):
        garbled = self.path("garbled.pcd")
        with open(garbled, "wb") as file:
            file.write(random.Random(2).randbytes(5000))
        cut = self.write_pcd("cut.pcd", [(1.0, 2.0, 3.0)] * 1000, "binary")
        os.truncate(cut, 2000)
        foreign = self.path("foreign.pcap")
        with open(foreign, "wb") as file:
            file.write(b"this is no capture")
        config = self.write("bad.toml", "[detect.cloud]\nnetwork = 'none.txt'\n")
        for arguments in ([garbled], [cut], [foreign], [self.simulated_cloud(), "--config", config]):
            said = self.scree("detect", *arguments, "--out", self.path("l.jsonl"), code=1).stderr
            self.assertEqual(len(said.splitlines()), 1, said)
        self.scree("detect", self.simulated_cloud(), "--out", "/dev/full", code=1)
        for arguments in (["--help"], ["--version"], ["detect", "--help"]):
            with open("/dev/full", "w") as full:
                ended = subprocess.run([SCREE, *arguments], stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(ended.returncode, 1, ended.stderr)
        self.scree("detect", self.simulated_cloud(), "--out", self.path("no/such/l.jsonl"), code=1)

    def test_wrong_usage_exits_2(self):
        self.scree("detect", code=2)
        self.scree("detect", self.path("missing.pcd"), code=2)
        self.scree("detect", "--no-such-option", code=2)
        self.scree("detect", self.simulated_cloud(), "--viewpoint", "nan", "2", "3", code=2)

    def test_recordings_give_a_list_a_sweep(self):
        sweeps = {
            "vlp16/indoor_10hz.pcap": 14,
            "vlp16/indoor_20hz.pcap": 52,
            "vlp16/indoor_dual_return.pcap": 5,
            "captures/interop": 81,
        }
        if not os.path.isdir(DATA):
            self.skipTest(f"the real recordings are not at {DATA}")
        for name, count in sweeps.items():
            lists = self.detect(os.path.join(DATA, name))
            self.assertEqual(len(lists), count, name)
            for each in lists:
                self.check_list(each)
        for name in ("clouds/offroad_marv.pcd", "clouds/offroad_husky.pcd"):
            self.check_list(self.detect(os.path.join(DATA, name))[0])
        foreign = os.path.join(DATA, "vlp16/not_a_vlp16.pcap")
        said = self.scree("detect", foreign, code=1).stderr
        self.assertIn("refused", said)

    def test_what_finds_no_room_and_a_wheel_that_slips_are_said(self):
        capture = self.path("drive")
        self.scree("simulate", capture, "--seed", "9", "--scene", "easy", "--seconds", "2.4")
        self.assertNotIn("map:", self.scree("detect", capture, "--out", self.path("l")).stderr)
        with open(os.path.join(capture, "can.log")) as log:
            frames = log.readlines()
        # This robot's encoder sends its speed in bytes 2 and 3, mm/s; for a while it spins.
        for i in range(len(frames) // 2, len(frames) * 3 // 4):
            frame, payload = frames[i].rstrip().split("#")
            if not frame.endswith("18FF50E5"):
                continue
            data = bytearray.fromhex(payload)
            struct.pack_into("<h", data, 2, struct.unpack_from("<h", data, 2)[0] + 1500)
            frames[i] = f"{frame}#{data.hex().upper()}\n"
        with open(os.path.join(capture, "can.log"), "w") as log:
            log.writelines(frames)
        with open(os.path.join(capture, "scree.toml"), "a") as config:
            config.write("\n[memory]\nmap_voxels = 1024\n")
        said = self.scree("detect", capture, "--out", self.path("l"), "--force").stderr
        self.assertRegex(said, r"map: \d+ points found no room: raise memory.map_voxels")
        self.assertRegex(said, r"map: \d+ sweeps during which the wheel slipped")

    def draw(self, source, lists):
        """What `scree picture` says, and the points that it drew."""
        said = self.scree("picture", source, lists, "--out", self.path("p.png"), "--force").stdout
        with open(self.path("p.png"), "rb") as picture:
            self.assertEqual(picture.read(8), b"\x89PNG\r\n\x1a\n")
        return said, int(re.search(r"(\d+) points", said)[1])

    def test_pictures_show_what_the_detector_had(self):
        capture, lidar, lists = self.path("drive"), self.path("lidar"), self.path("lists.jsonl")
        self.scree("simulate", capture, "--seed", "9", "--scene", "rolling", "--seconds", "1")
        drive = self.detect(capture)
        said, points = self.draw(capture, lists)
        self.assertIn("the ground as it was rebuilt until", said)
        self.assertIn(f"{len(drive[-1]['obstacles'])} obstacles", said)

        os.mkdir(lidar)
        os.link(os.path.join(capture, "lidar.pcap"), os.path.join(lidar, "lidar.pcap"))
        with open(os.path.join(capture, "scree.toml")) as file:
            config = file.read()
        with open(os.path.join(lidar, "scree.toml"), "w") as file:
            file.write(config + "\n[map]\nregistration = false\n")
        self.detect(lidar)
        said, of_sweep = self.draw(lidar, lists)
        self.assertIn("one sweep, ", said)
        self.assertGreater(of_sweep, 5000)
        self.assertGreater(points, 1.5 * of_sweep, "of 10 sweeps")

        cloud = self.write_pcd("few.pcd", [(x / 10, y / 10, 0.0) for x in range(40) for y in range(25)])
        self.detect(cloud)
        self.assertIn("one point cloud, 1000 points", self.draw(cloud, lists)[0])
        none = self.write("none.jsonl", "")
        said = self.scree("picture", cloud, none, "--out", self.path("q.png"), code=1).stderr
        self.assertIn("holds no obstacle list", said)


if __name__ == "__main__":
    main(sys.argv[3:])
