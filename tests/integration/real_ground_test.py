"""scree detect on real ground: python3 real_ground_test.py SCREE DATA [TEST ...]

What is surely true of each recording stands beside its test.
"""

import json
import math
import os
import sys

try:
    import numpy
except ImportError:
    numpy = None

from programs import ProgramTest, main

SCREE, DATA = sys.argv[1:3]


class RealGroundTest(ProgramTest):
    def lists(self, *names):
        source = os.path.join(DATA, *names)
        if not os.path.exists(source):
            self.skipTest(f"no such recording: {os.path.join(*names)}")
        out = self.path("lists.jsonl")
        self.done(SCREE, "detect", source, "--out", out, "--force")
        with open(out) as file:
            return [json.loads(line)["obstacles"] for line in file]

    def cloud(self, *names):
        return self.lists(*names)[0]

    def of_kind(self, kind, obstacles):
        return [obstacle for obstacle in obstacles if obstacle["kind"] == kind]

    def test_off_road_scenes_have_bushes_and_no_deep_hole(self):
        # By the photos, and by whoever recorded them. The sixth is a bare lot.
        for number, bushes in ((0, 10), (3, 10), (5, 10), (7, 10), (9, 10), (11, 0)):
            with self.subTest(scene=number):
                found = self.cloud("real", "offroad", f"scene_{number}.pcd")
                deep = [hole for hole in found if hole["height"] < -0.3]
                self.assertEqual(deep, [])
                tall = [each for each in found if each["height"] > 0.5]
                self.assertGreaterEqual(len(tall), bushes)

    def test_a_building_has_no_holes_in_its_floor(self):
        for name in ("indoor_20hz.pcap", "indoor_dual_return.pcap"):
            for obstacles in self.lists("vlp16", name):
                self.assertEqual(self.of_kind("negative", obstacles), [], name)

    def test_a_cliff_is_one_edge(self):
        # Made so: level ground for x < 2, and level ground 1.5 m lower beyond.
        edges = self.cloud("field", "dropoff", "cliff_1.5m.pcd")
        self.assertEqual(len(edges), 1)
        self.assertEqual(edges[0]["evidence"], "edge")
        self.assertAlmostEqual(edges[0]["height"], -1.5, delta=0.1)
        self.assertAlmostEqual(edges[0]["center"][0], 2.15, delta=0.2)
        self.assertGreater(edges[0]["extent"][0], 9)

    def test_a_ditch_is_a_hole_whatever_its_length(self):
        # Made so: 2 m wide, 0.7 m deep; one crosses the cloud.
        for name in ("ditch_6m.pcd", "ditch_40m.pcd"):
            holes = self.of_kind("negative", self.cloud("field", "long_ditch_cloud", name))
            self.assertEqual(len(holes), 1, name)
            self.assertAlmostEqual(holes[0]["height"], -0.7, delta=0.1)

    def test_a_ditch_in_a_thin_or_tilted_cloud_is_the_same(self):
        if numpy is None:
            self.skipTest("numpy is missing")
        path = os.path.join(DATA, "field", "long_ditch_cloud", "ditch_40m.pcd")
        if not os.path.isfile(path):
            self.skipTest("no such recording: field/long_ditch_cloud")
        with open(path, "rb") as file:
            head, body = file.read().split(b"DATA binary\n")
        fields = head.split(b"FIELDS ")[1].split(b"\n")[0].split()
        points = numpy.frombuffer(body, "<f4").reshape(-1, len(fields))[:, :3].astype(float)
        tilted = points + numpy.outer(points[:, 1], [0, 0, 0.05])
        for cloud in (points[::2], points[::3], 0.9 * points, tilted):
            holes = self.of_kind("negative", self.of_points(cloud))
            self.assertEqual(len(holes), 1)
            self.assertAlmostEqual(holes[0]["height"], -0.7, delta=0.1)

    def test_points_below_seen_ground_are_no_hole(self):
        # Made so: level ground without a gap, and points scattered below a part of it.
        self.assertEqual(self.cloud("field", "ghosts_below_seen_ground", "ghosts.pcd"), [])

    def test_two_thirds_of_the_craters_in_sand_are_a_hole_and_flat_sand_has_none(self):
        # Each depth map (mm, 2.8 mm a pixel) shows one crater, or none. Enlarged 30 times, a crater
        # is deepest at its middle; those shallower than 0.2 m are ground. A camera that was held a
        # little askew sees the same.
        if numpy is None:
            self.skipTest("numpy is missing")
        folder = os.path.join(DATA, "real", "craters")
        if not os.path.isdir(folder):
            self.skipTest("no such recording: real/craters")
        for tilt in (0, 0.05):
            found = craters = 0
            for name in sorted(os.listdir(folder)):
                heights = -0.03 * numpy.load(os.path.join(folder, name))["depthmap"].astype(float)
                row, column = numpy.unravel_index(numpy.nanargmin(heights), heights.shape)
                heights += tilt * 0.084 * numpy.arange(heights.shape[1])
                holes = self.of_kind("negative", self.of_surface(heights, 0.084))
                if name.startswith("plane"):
                    self.assertEqual(holes, [], name)
                    continue
                craters += 1
                found += any(
                    math.dist(hole["center"][:2], (0.084 * column, 0.084 * row)) < 1.5
                    and hole["extent"][0] > 1
                    for hole in holes
                )
            self.assertGreaterEqual(3 * found, 2 * craters, tilt)

    def of_surface(self, heights, pixel):
        rows, columns = numpy.nonzero(numpy.isfinite(heights))
        return self.of_points(numpy.column_stack((columns * pixel, rows * pixel, heights[rows, columns])))

    def of_points(self, points):
        cloud = self.path("points.pcd")
        with open(cloud, "wb") as file:
            head = (
                "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
                f"WIDTH {len(points)}\nHEIGHT 1\nPOINTS {len(points)}\nDATA binary\n"
            )
            file.write(head.encode() + points.astype("<f4").tobytes())
        return self.cloud(cloud)

    def test_a_log_with_ground_seen_below_it_is_an_obstacle(self):
        # Made so: 0.3 m thick, its underside 0.3 m above the ground.
        found = self.cloud("field", "overhang_cloud", "log_0.3m_thick_at_0.45m.pcd")
        self.assertEqual(len(self.of_kind("positive", found)), 1)


if __name__ == "__main__":
    main(sys.argv[3:])
