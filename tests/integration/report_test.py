"""scree report as a program, its page in a browser: python3 report_test.py SCREE TYPES [TEST ...]"""

import base64
import json
import os
import re
import struct
import sys
import zlib

from browser import Page
from lcm_log_file import write_log
from programs import ProgramTest, main

SCREE, TYPES = sys.argv[1:3]
sys.path.insert(0, TYPES)
import scree  # noqa: E402

BEGIN = 1_600_000_000_000_000_000
STEP = 100_000_000


def unpacked(path):
    """What a page holds, by the description in report_data.hpp."""
    with open(path) as file:
        text = re.search(r'id="data">([^<]*)<', file.read()).group(1)
    data = zlib.decompress(base64.b64decode(text))
    (length,) = struct.unpack("<I", data[:4])
    return json.loads(data[4 : 4 + length]), data[4 + length :]


class ReportTest(ProgramTest):
    def capture(self, *arguments):
        capture = self.path("capture")
        self.done(SCREE, "simulate", capture, "--seconds", "5", "--scene", "rough", *arguments)
        return capture

    def report(self, source, *arguments):
        out = self.path("report.html")
        self.done(SCREE, "report", source, "--out", out, "--force", *arguments)
        return out

    def obstacle_list(self, number, obstacles=()):
        return {
            "stamp_ns": BEGIN + number * STEP,
            "pose": {"p": [0.1 * number, 0, 0], "q": [1, 0, 0, 0]},
            "obstacles": list(obstacles),
        }

    def rock(self, identity=7, x=5.0, kind="positive", height=0.5):
        return {"id": identity, "kind": kind, "confidence": 0.9, "center": [x, 1, height / 2],
                "extent": [1, 0.8, abs(height)], "yaw": 0, "height": height, "velocity": [0, 0], "points": 50,
                "footprint": [[x - 0.5, 0.6], [x + 0.5, 0.6], [x + 0.5, 1.4], [x - 0.5, 1.4]]}  # fmt: skip

    def write_lines(self, name, lines):
        return self.write(name, "".join(json.dumps(line) + "\n" for line in lines))

    def test_a_capture_with_truth_in_the_browser(self):
        capture = self.capture("--people", "1")
        out = self.report(capture, "--truth")
        lists = self.path("lists.jsonl")
        self.done(SCREE, "detect", capture, "--out", lists)
        truth = os.path.join(capture, "truth.json")
        score = json.loads(self.done(SCREE, "evaluate", truth, lists, "--json").stdout)["all"]
        with open(lists) as file:
            said = [json.loads(line) for line in file]

        page = Page(self, f"file://{out}")
        print(f"shown after {page.of('document.body.dataset.took')} s")
        figures = page.text("#figures")
        self.assertIn(f"{len(said)} lists", figures)
        self.assertIn(f"{len({it['id'] for one in said for it in one['obstacles']})} obstacles", figures)
        self.assertIn(f"{score['f1']:.3f} F1", figures)
        page.click("#tab-Truth")
        row = page.text("#panel table tbody tr:first-child").split()
        self.assertEqual([int(number) for number in row[-3:]],
                         [score[key] for key in ("true_positives", "false_positives", "false_negatives")])  # fmt: skip
        for number in (0, len(said) // 2, len(said) - 1):
            page.of(f"page.show({number})")
            seen = page.of("page.list().obstacles.map((it) => it.id)")
            self.assertEqual(seen, [it["id"] for it in said[number]["obstacles"]])
            # Judged one by one as the scoring does it in sum.
        counts = page.of("page.report.lists.map((it) => [it.right, it.invented, it.missed].map((x) => x?.length || 0))")
        self.assertEqual([sum(column) for column in zip(*counts)],
                         [score[key] for key in ("true_positives", "false_positives", "false_negatives")])  # fmt: skip
        page.click("#tab-Health")
        self.assertIn("accepted", page.text("#panel"))
        page.click("#layer-unknown")
        page.screenshot(self.path("page.png"))
        self.assertEqual(page.complaints, [])
        self.assertEqual([url for url in page.asked_for if not url.startswith("file://")], [])

    def test_half_of_the_lists_make_no_score_and_keys_of_the_browser_stay_its_own(self):
        capture = self.capture()
        lists = self.path("half.jsonl")
        self.done(SCREE, "detect", capture, "--out", lists)
        with open(lists) as file:
            lines = file.readlines()
        self.write("half.jsonl", "".join(lines[: len(lines) // 2]))
        out = self.path("half.html")
        truth = os.path.join(capture, "truth.json")
        self.done(SCREE, "report", lists, "--truth", truth, "--out", out)
        page = Page(self, f"file://{out}")
        self.assertIn("F1, does not count", page.text("#figures"))
        page.click("#tab-Truth")
        self.assertIn("this score does not count", page.text("#panel"))
        press = "document.dispatchEvent(new KeyboardEvent('keydown', {key: '%s', ctrlKey: %s, cancelable: true}))"
        page.of("page.show(0)")
        self.assertTrue(page.of(press % ("ArrowRight", "true")))
        self.assertEqual(page.of("page.now"), 0)
        self.assertFalse(page.of(press % ("ArrowRight", "false")))
        self.assertEqual(page.of("page.now"), 1)

    def test_the_ground_shows_a_hole_darker_and_where_nothing_was_seen(self):
        rows = []
        states, ground = [], []
        for row in range(40):  # 8 m, a pit of 1 m in the middle, half a metre deep; a strip unknown
            states.append("5?35.")
            for column in range(5, 40):
                is_pit = abs(row - 20) < 3 and abs(column - 20) < 3
                ground.append(-50 if is_pit else 0)
        rows.append({"stamp_ns": BEGIN, "pose": {"p": [0, 0, 0], "q": [1, 0, 0, 0]}, "origin": [-4, -4],
                     "cell_size": 0.2, "columns": 40, "rows": 40, "states": states, "ground": ground})  # fmt: skip
        lists = self.write_lines("lists.jsonl", [self.obstacle_list(n) for n in range(3)])
        page = Page(self, f"file://{self.report(lists, '--grid', self.write_lines('grid.jsonl', rows))}")
        page.click("#layer-way")
        flat, pit, unseen = (page.colour_at(x, y) for x, y in [(2.1, 2.1), (0.1, 0.1), (-3.95, 1.1)])
        self.assertEqual(flat[0], flat[1])
        self.assertLess(pit[0], flat[0] - 40)
        self.assertNotEqual(unseen[0], unseen[2])  # hatched, not grey
        self.assertEqual(page.complaints, [])

    def test_health_of_a_watch_is_told(self):
        lines = []
        for number in range(60):
            blind = 20 <= number < 40
            if not blind:
                lines.append(self.obstacle_list(number, [self.rock()]))
            if number % 10 == 0:
                health = "blind" if blind else "ok"
                lines.append({"stamp_ns": BEGIN + number * STEP, "health": health, "version": "1",
                              "reason": "no packets <b>" if blind else "", "setup": [], "stop": blind,
                              "lidar": {"state": "silent" if blind else "ok", "rate": 0 if blind else 754},
                              "latency": {"p99_ms": 61.5}})  # fmt: skip
        page = Page(self, f"file://{self.report(self.write_lines('watch.jsonl', lines))}")
        page.click("#tab-Health")
        events = page.of("page.report.health.events")
        self.assertEqual([(it["kind"], it["from"], it["to"]) for it in events if it["kind"] == "blind"], [("blind", 2, 4)])
        self.assertIn("no packets <b>", page.text("#panel"))
        self.assertIn("2.0 s blind", page.text("#figures"))
        page.of("page.goTo(4)")
        self.assertIn("no packets", page.text("#state"))
        names = page.of("page.report.health.series.map((it) => it.name)")
        self.assertIn("lidar packets", names)
        self.assertIn("latency, 99 % of the lists", names)
        self.assertEqual(page.complaints, [])

    def test_a_log_of_lcm_logger_is_told(self):
        events = []
        for number in range(30):
            found = scree.obstacle_list_t()
            found.stamp_ns, found.p, found.q = BEGIN + number * STEP, [0, 0, 0], [1, 0, 0, 0]
            events.append((BEGIN // 1000 + number * 100_000, "SCREE_OBSTACLES", found.encode()))
        health, grid = scree.health_t(), scree.grid_t()
        health.stamp_ns, health.state, health.reason = BEGIN, health.BLIND, "the sensor is covered"
        grid.stamp_ns, grid.q, grid.origin, grid.cell_size = BEGIN, [1, 0, 0, 0], [0, 0], 0.2
        grid.columns, grid.rows, grid.cells = 2, 3, 6
        grid.state, grid.ground = bytes([1] * 6), [10] * 6
        events += [(BEGIN // 1000, "SCREE_HEALTH", health.encode()), (BEGIN // 1000, "SCREE_GRID", grid.encode())]
        grid.columns = 120  # contradicts the number of cells: passed over
        events.append((BEGIN // 1000 + 1, "SCREE_GRID", grid.encode()))
        log = self.path("log.lcm")
        write_log(log, events)
        report, blob = unpacked(self.report(log))
        self.assertEqual(len(report["lists"]), 30)
        self.assertEqual(report["health"]["events"][0]["text"], "the sensor is covered")
        self.assertEqual(len(report["grids"]), 1)
        begin, size = report["ground"]["heights"]
        self.assertEqual(struct.unpack("<6h", blob[begin : begin + size]), (10,) * 6)
        self.assertEqual((report["ground"]["columns"], report["ground"]["rows"]), (2, 3))

    def test_an_obstacle_has_a_history_a_click_away(self):
        lines = [self.obstacle_list(n, [self.rock(), self.rock(9, 3, "negative", -0.4)] if n > 9 else [self.rock()])
                 for n in range(20)]  # fmt: skip
        page = Page(self, f"file://{self.report(self.write_lines('lists.jsonl', lines))}")
        page.click("#tab-Obstacles")
        page.page.click("#panel tr:has-text('hole')")
        self.assertEqual(page.of("page.now"), 10)
        page.click("#tab-Now")
        self.assertIn("In 10 lists, from 1.0 to 1.9 s. First told at 2.2 m", page.text("#panel"))
        page.click("#on")
        self.assertEqual(page.of("page.now"), 11)
        page.page.keyboard.press("End")
        self.assertIn("list 20 of 20", page.text("#clock"))
        page.click("#play")
        page.wait_for("page.now > 2 && page.now < 19")
        self.assertEqual(page.complaints, [])

    def test_a_narrow_window_shows_all_of_it(self):
        lists = self.write_lines("lists.jsonl", [self.obstacle_list(0, [self.rock()]), self.obstacle_list(1)])
        page = Page(self, f"file://{self.report(lists)}", width=400, height=800)
        self.assertEqual(page.of("[...document.querySelectorAll('#layers input')].map((it) => it.id)"),
                         ["layer-way", "layer-obstacles", "layer-labels", "layer-past"])  # fmt: skip
        self.assertGreater(page.of("document.getElementById('slider').clientWidth"), 300)
        self.assertLessEqual(page.of("document.documentElement.scrollWidth"), 400)
        for seen in ("fit", "play", "tabs", "slider"):
            self.assertTrue(
                page.of(
                    f"""(() => {{ const sought = document.getElementById("{seen}");
                    const box = sought.getBoundingClientRect();
                    const at = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
                    return sought.contains(at); }})()"""
                ),
                seen,
            )

    def test_what_cannot_be_reported_is_refused(self):
        out = self.path("report.html")
        one = self.write_lines("lists.jsonl", [self.obstacle_list(0)])
        for arguments, words in [
            ([one, "--truth"], "has no truth.json"),
            ([self.write("bad.jsonl", '{"stamp_ns": 1}\n')], "bad.jsonl:1"),
            ([self.write("empty.pcap", "")], "empty.pcap"),
            ([one, "--grid", self.write("grid.jsonl", '{"stamp_ns": 1, "pose": 3}\n')], "grid.jsonl:1"),
        ]:
            with self.subTest(words):
                self.assert_fails(self.run_to_end(SCREE, "report", *arguments, "--out", out), words)
                self.assertFalse(os.path.exists(out))
        self.report(one)
        self.assert_fails(self.run_to_end(SCREE, "report", one, "--out", out), "--force")


if __name__ == "__main__":
    main(sys.argv[3:])
