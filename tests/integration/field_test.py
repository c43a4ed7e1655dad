"""Files that users of such programs had trouble with: python3 field_test.py SCREE DATA [TEST ...]"""

import json
import math
import os
import struct
import sys

from programs import ProgramTest, main

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

    def test_files_are_known_by_their_content(self):
        folder = self.field("file_kinds")
        for name in ("CLOUD.PCD", "cloud_without_suffix"):
            self.assertEqual(len(self.detect(os.path.join(folder, name))), 1, name)
        result = self.run_to_end(SCREE, "info", os.path.join(folder, "cap.pcap.gz"))
        self.assert_fails(result, "is packed with gzip: unpack it first")

    def test_headers_that_other_programs_write_are_read(self):
        folder = self.field("pcd_headers")
        for name in ("bom.pcd", "lower_case_types.pcd"):
            self.assertEqual(len(self.detect(os.path.join(folder, name))), 1, name)
        result = self.run_to_end(SCREE, "detect", os.path.join(folder, "one_line_short.pcd"))
        self.assert_fails(result, "1999 of 2000 points")


if __name__ == "__main__":
    main(sys.argv[3:])
