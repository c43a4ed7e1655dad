"""scree evaluate as a program: python3 evaluate_test.py SCREE DATA [TEST ...]"""

import json
import math
import os
import random
import sys

from programs import ProgramTest, main

try:
    import reference_scoring as reference
except ImportError:  # shapely is not there
    reference = None

SCREE, DATA = sys.argv[1:3]


class EvaluateTest(ProgramTest):
    def write(self, name, content):
        return super().write(name, content if isinstance(content, str) else json.dumps(content))

    def scree(self, *arguments, code=0):
        return self.done(SCREE, *arguments, code=code)

    def evaluate(self, *files):
        return json.loads(self.scree("evaluate", *files, "--json").stdout)

    def example(self, **changes):
        truth = {
            "obstacles": [
                {"id": 1, "kind": "positive", "center": [5, 0, 0.2], "height": 0.4,
                 "footprint": [[4.5, -0.5], [5.5, -0.5], [5.5, 0.5], [4.5, 0.5]]},
            ],
            "poses": [{"t_ns": 0, "p": [0, 0, 0], "q": [1, 0, 0, 0]}],
            "visible": [{"t_ns": 0, "ids": [1], "ignore": []}],
        }  # fmt: skip
        return {**truth, **changes}

    def line(self, **changes):
        obstacle = {"id": 1, "kind": "positive", "confidence": 0.9, "center": [5, 0, 0.2],
                    "extent": [0.6, 0.5, 0.4], "yaw": 0.2, "height": 0.4, "points": 90}  # fmt: skip
        pose = {"p": [0, 0, 0], "q": [1, 0, 0, 0]}
        return {"stamp_ns": 0, "pose": pose, "obstacles": [{**obstacle, **changes}]}

    def check_against_reference(self, truth, detections):
        if reference is None:
            self.skipTest("shapely is not installed")
        counts, covered, unmet = reference.score(*reference.read(truth, detections))
        ours = self.evaluate(truth, detections)
        for kind, expected in counts.items():
            found = [ours[kind][name] for name in
                     ("true_positives", "false_positives", "false_negatives")]  # fmt: skip
            self.assertEqual(found, expected, kind)
        self.assertEqual((ours["covered"], ours["lists_without_entry"]), (covered, unmet))
        return ours

    def test_agrees_with_the_reference_on_the_interop_capture(self):
        capture = os.path.join(DATA, "captures/interop")
        if not os.path.isdir(capture):
            self.skipTest(f"the capture is not at {DATA}")
        self.scree("detect", capture, "--out", self.path("lists.jsonl"))
        truth, lists = os.path.join(capture, "truth.json"), self.path("lists.jsonl")
        ours = self.evaluate(truth, lists)
        self.assertEqual((ours["entries"], ours["covered"]), (81, 81))
        self.assertTrue(ours["counts"])
        self.assertGreater(ours["all"]["f1"], 0.97)
        self.assertLess(ours["pose_error"][0]["final_share_of_way"], 0.01)
        # An obstacle keeps its id: far fewer ids than obstacles reported.
        with open(lists) as file:
            obstacles = [each for line in file for each in json.loads(line)["obstacles"]]
        ids = {obstacle["id"] for obstacle in obstacles}
        self.assertLess(len(ids), len(obstacles) / 10)
        self.check_against_reference(truth, lists)

    def test_agrees_with_the_reference_on_a_simulated_capture(self):
        self.scree("simulate", self.path("run"), "--seconds", "2", "--seed", "4")
        self.scree("detect", self.path("run"), "--out", self.path("lists.jsonl"))
        self.check_against_reference(self.path("run/truth.json"), self.path("lists.jsonl"))

    def test_agrees_with_the_reference_on_random_worlds(self):
        draw = random.Random(7)
        turn = lambda: [math.cos(a := draw.uniform(-3, 3)), 0.02, -0.03, math.sin(a)]  # noqa: E731
        unit = lambda q: [c / math.hypot(*q) for c in q]  # noqa: E731
        kind = lambda: draw.choice(["positive", "negative"])  # noqa: E731
        for number in range(25):
            obstacles = []
            for i in range(30):
                x, y, r = draw.uniform(-6, 6), draw.uniform(-6, 6), draw.uniform(0.2, 1.2)
                corners = draw.randrange(3, 12)
                outline = []
                for k in range(corners):
                    angle, reach = 2 * math.pi * k / corners, r * draw.uniform(0.6, 1)
                    outline.append([x + reach * math.cos(angle), y + reach * math.sin(angle)])
                obstacles.append({"id": i, "kind": kind(), "center": [x, y, draw.uniform(-1, 1)],
                                  "footprint": outline, "height": 0.5})  # fmt: skip
            poses, visible, lines = [], [], []
            for k in range(12):
                p = [draw.uniform(-1, 1) for _ in range(3)]
                poses.append({"t_ns": k * 90_000_000, "p": p, "q": unit(turn())})
                ids = draw.sample(range(30), 20)
                visible.append({"t_ns": k * 100_000_000, "ids": ids[:12], "ignore": ids[12:]})
                pose = {"p": [draw.uniform(-1, 1) for _ in range(3)], "q": unit(turn())}
                line = {"stamp_ns": k * 100_000_000 + draw.randrange(0, 90_000_000),
                        "pose": pose, "obstacles": []}  # fmt: skip
                for i in range(25):
                    extent = [draw.uniform(0, 3), draw.uniform(0, 2), 1]
                    center = [draw.uniform(-6, 6), draw.uniform(-6, 6), draw.uniform(-1, 1)]
                    line["obstacles"].append(
                        {"id": i, "kind": kind(), "confidence": 1, "center": center,
                         "extent": extent, "yaw": draw.uniform(-1.5, 1.5), "height": 0.3,
                         "points": 5})  # fmt: skip
                    if i % 2 == 0:
                        line["obstacles"][-1]["footprint"] = [
                            [center[0] + extent[0] * math.cos(k), center[1] + math.sin(k)]
                            for k in range(6)
                        ]
                lines.append(json.dumps(line) + "\n")
            truth = {"obstacles": obstacles, "poses": poses, "visible": visible}
            self.check_against_reference(
                self.write("truth.json", truth), self.write("lists.jsonl", "".join(lines))
            )

    def test_several_pairs_are_summed_up(self):
        truth, lists = self.write("t.json", self.example()), self.write("l.jsonl", self.line())
        missed = self.write("m.jsonl", {**self.line(), "obstacles": []})
        summed = self.evaluate(truth, lists, truth, missed, truth, lists)
        self.assertEqual(summed["runs"], 3)
        self.assertEqual(summed["all"]["true_positives"], 2)
        self.assertEqual(summed["all"]["false_negatives"], 1)
        self.assertAlmostEqual(summed["all"]["f1"], 0.8)
        self.assertIsNone(summed["negative"]["f1"])
        table = self.scree("evaluate", truth, lists, truth, missed).stdout
        self.assertIn("coverage 1.000: 2 of 2 visible entries", table)

    def test_drift_of_the_pose_is_a_share_of_the_way_and_degrees_a_minute(self):
        poses, visible, lines = [], [], []
        for i, (yaw_deg, aside) in enumerate([(0, 0), (1, 0.4), (2, 0.9), (-0.5, -0.3)]):
            t_ns, half = i * 10_000_000_000, math.radians(yaw_deg) / 2
            poses.append({"t_ns": t_ns, "p": [10 * i, 0, 0], "q": [1, 0, 0, 0]})
            visible.append({"t_ns": t_ns, "ids": [], "ignore": []})
            pose = {"p": [10 * i, aside, 0], "q": [math.cos(half), 0, 0, math.sin(half)]}
            lines.append(json.dumps({"stamp_ns": t_ns, "pose": pose, "obstacles": []}) + "\n")
        truth = self.write("t.json", self.example(poses=poses, visible=visible))
        lists = self.write("l.jsonl", "".join(lines))
        (error,) = self.evaluate(truth, lists)["pose_error"]
        expected = {"way": 30, "seconds": 30, "final": 0.3, "most": 0.9,
                    "final_share_of_way": 0.01, "most_share_of_way": 0.03,
                    "yaw_deg": -0.5, "most_yaw_deg": 2,
                    "yaw_deg_per_minute": -1, "most_yaw_deg_per_minute": 4}  # fmt: skip
        self.assertEqual(list(error), list(expected))
        for key, value in expected.items():
            self.assertAlmostEqual(error[key], value, msg=key)
        table = self.scree("evaluate", truth, lists).stdout.splitlines()
        columns = [line.split()[2:] for line in table if line.startswith("drive 1")]
        self.assertEqual(columns, ["30.00 0.300 0.900 1.00 3.00 -0.50 2.00 -1.00 4.00".split()])

    def test_a_footprint_counts_instead_of_the_box(self):
        truth = self.write("t.json", self.example())
        aside = {"center": [5, 1, 0.2], "extent": [0.2, 0.2, 0.4]}
        wide = [[4.4, -0.6], [5.6, -0.6], [5.6, 1.2], [4.4, 1.2]]
        box = self.write("box.jsonl", self.line(**aside))
        self.assertEqual(self.evaluate(truth, box)["all"]["true_positives"], 0)
        for corners in [wide, wide[::-1], [*wide, wide[0]], [*wide, [5, 0]]]:
            lists = self.write("l.jsonl", self.line(**aside, footprint=corners))
            self.assertEqual(self.evaluate(truth, lists)["all"]["true_positives"], 1, corners)
        none = self.write("l.jsonl", self.line(**aside, footprint=[], evidence="edge"))
        self.assertEqual(self.evaluate(truth, none)["all"]["true_positives"], 0)

    def test_no_list_at_all_does_not_count(self):
        truth, empty = self.write("t.json", self.example()), self.write("l.jsonl", "")
        self.assertFalse(self.evaluate(truth, empty)["counts"])
        self.assertIn("does not count", self.scree("evaluate", truth, empty).stdout)

    def test_bad_files_are_one_sentence_and_exit_1(self):
        good_truth, good_lists = json.dumps(self.example()), json.dumps(self.line())
        first = self.example()["obstacles"][0]
        bad_truths = [
            good_truth[:70],
            "{}",
            "null",
            "[" * 5000,
            good_truth.replace("0.4", "NaN"),
            self.example(poses=[]),
            self.example(obstacles=[{**first, "footprint": []}]),
            self.example(obstacles=[{**first, "kind": "flying"}]),
            self.example(obstacles=[first, first]),
            self.example(visible=[{"t_ns": 0, "ids": [2], "ignore": []}]),
            self.example(visible=[{"t_ns": 5, "ids": [], "ignore": []},
                                  {"t_ns": 4, "ids": [], "ignore": []}]),
        ]  # fmt: skip
        lists = self.write("l.jsonl", good_lists)
        for bad in bad_truths:
            said = self.scree("evaluate", self.write("t.json", bad), lists, code=1).stderr
            self.assertEqual(len(said.splitlines()), 1, said)
            self.assertIn("t.json", said)
        later = json.dumps({**self.line(), "stamp_ns": 5})
        bad_lists = [
            good_lists[:50],
            "\n",
            good_lists + "\n\n" + good_lists,
            later + "\n" + good_lists,
            self.line(kind="flying"),
            self.line(center=[1, 2]),
            self.line(center=[1, 2, None]),
            self.line(extent=[1, -2, 1]),
            self.line(confidence="high"),
            self.line(evidence="rumour"),
            self.line(footprint=[[1, 2], [3]]),
            good_lists.replace("0.9", "NaN"),
            {**self.line(), "pose": {"p": [0, 0, 0], "q": [0, 0, 0, 0]}},
            {**self.line(), "stamp_ns": 1.5},
            {**self.line(), "obstacles": {}},
        ]
        truth = self.write("t.json", good_truth)
        for blank in ("\n\n", "\r\n \n"):
            spaced = self.scree("evaluate", truth, self.write("b.jsonl", good_lists + blank))
            self.assertEqual(spaced.stdout, self.scree("evaluate", truth, lists).stdout)
        for bad in bad_lists:
            said = self.scree("evaluate", truth, self.write("b.jsonl", bad), code=1).stderr
            self.assertEqual(len(said.splitlines()), 1, said)
            self.assertIn("b.jsonl:", said)

    def test_wrong_usage_exits_2(self):
        truth = self.write("t.json", self.example())
        self.scree("evaluate", code=2)
        self.scree("evaluate", truth, code=2)
        self.scree("evaluate", truth, self.path("none.jsonl"), code=2)
        self.scree("evaluate", truth, truth, truth, code=2)
        self.scree("evaluate", truth, self.folder, code=2)


if __name__ == "__main__":
    main(sys.argv[3:])
