"""scree's command line: python3 command_line_test.py SCREE PYTHON_TYPES [TEST ...]"""

import json
import os
import pty
import subprocess
import sys

from lcm_log_file import write_log
from lcm_sender import Sender
from programs import PATIENCE, ProgramTest, main

SCREE, PYTHON_TYPES = sys.argv[1:3]
sys.path.insert(0, PYTHON_TYPES)
import scree  # noqa: E402


def list_at(stamp_ns):
    rock = scree.obstacle_t()
    rock.id, rock.kind, rock.confidence, rock.center, rock.extent = 7, 1, 0.9, [4, 3, 0.2], [1, 1, 0.4]
    found = scree.obstacle_list_t()
    found.stamp_ns, found.q, found.size, found.obstacles = stamp_ns, [1, 0, 0, 0], 1, [rock]
    return found


def health_of(state, stop):
    health = scree.health_t()
    health.state, health.stop, health.reason = state, stop, "" if state else "no packets"
    return health


class CommandLineTest(ProgramTest):
    def scree(self, *arguments, code=0):
        return self.done(SCREE, *arguments, code=code)

    def on_terminal(self, *arguments):
        """What it writes when standard output and error are a terminal."""
        ours, theirs = pty.openpty()
        process = subprocess.Popen([SCREE, *arguments], stdout=theirs, stderr=theirs)
        os.close(theirs)
        text = b""
        try:
            while part := os.read(ours, 65536):
                text += part
        except OSError:  # the terminal has no writer any more
            pass
        self.assertEqual(process.wait(PATIENCE), 0, text)
        return text.decode()

    def simulate(self, seconds):
        capture = self.path("capture")
        self.scree("simulate", capture, "--seconds", str(seconds), "--scene", "easy")
        return capture

    def test_nothing_is_overwritten_without_force(self):
        capture, lists = self.simulate(1), self.path("lists.jsonl")
        truth = os.path.join(capture, "truth.json")
        cloud, decoded, picture = self.path("c.pcd"), self.path("d.csv"), self.path("p.png")
        commands = [
            ["simulate", capture, "--seconds", "1"],
            ["simulate", "--cloud", cloud, "--points", "1000"],
            ["detect", capture, "--out", lists],
            ["decode", capture, "--sensor", "imu", "--out", decoded],
            ["picture", capture, lists, "--out", picture],
            ["slice", capture, self.path("part")],
        ]
        for command in commands[1:]:
            self.scree(*command)
        for command in commands:
            with open(truth, "rb") as file:
                before = file.read()
            refused = self.run_to_end(SCREE, *command)
            self.assert_fails(refused, "is there already", "--force overwrites it")
            with open(truth, "rb") as file:
                self.assertEqual(file.read(), before)
            self.scree(*command, "--force")
        self.scree("decode", capture, "--sensor", "imu", "--out", "/dev/null")

    def test_what_is_read_is_never_overwritten(self):
        capture, lists = self.simulate(1), self.path("lists.jsonl")
        self.scree("detect", capture, "--out", lists)
        lidar, truth = (os.path.join(capture, name) for name in ("lidar.pcap", "truth.json"))
        for command in (
            ["detect", capture, "--out", lidar],
            ["decode", capture, "--sensor", "lidar", "--out", lidar],
            ["report", capture, "--out", lidar],
            ["report", lists, "--out", lists],
            ["picture", capture, lists, "--out", lists],
            ["evaluate", truth, lists, "--matches", lists],
            ["evaluate", truth, lists, "--matches", truth],
        ):
            self.assert_fails(self.run_to_end(SCREE, *command, "--force"), "it cannot be written, too")
        for folder in (capture, os.path.join(capture, ".")):
            refused = self.run_to_end(SCREE, "slice", lidar, folder, "--force")
            self.assert_fails(refused, "a part cannot take the place")
        both = os.path.join(self.path("both"), "..", "both")
        refused = self.run_to_end(SCREE, "detect", capture, "--out", self.path("both"), "--grid", both)
        self.assert_fails(refused, "cannot")
        self.scree("detect", capture, "--grid", "-", code=2)
        self.scree("detect", capture, "--viewpoint", "1", "2", "3", code=2)
        self.scree("evaluate", truth, lists)

    def test_a_failure_leaves_what_was_there(self):
        capture = self.simulate(1)
        with open(os.path.join(capture, "lidar.pcap"), "rb") as file:
            begin = file.read(30)
        broken, kept = self.path("broken.pcap"), self.write("kept", "kept")
        with open(broken, "wb") as file:
            file.write(begin)
        for command in (["detect"], ["decode", "--sensor", "lidar"]):
            self.scree(*command, broken, "--out", kept, "--force", code=1)
            self.assertEqual(self.read(kept), "kept")
            self.scree(*command, broken, "--out", self.path("none"), code=1)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("none")], [])
        self.scree("detect", capture, "--out", kept, "--force")
        self.assertIn("obstacles", self.read(kept))

    def test_a_line_is_no_file_name_and_a_folder_no_file(self):
        capture = self.simulate(1)
        for command in (["picture", capture, capture], ["report", capture], ["simulate"]):
            out = "--cloud" if command == ["simulate"] else "--out"
            self.assert_fails(self.run_to_end(SCREE, *command, out, "-", "--force"), "no name of a file")
        printed = self.scree("decode", capture, "--sensor", "imu", "--out", "-").stdout
        self.assertEqual(printed, self.scree("decode", capture, "--sensor", "imu").stdout)
        self.assert_fails(self.run_to_end(SCREE, "train", "--out", capture, "--force"), "is a folder")

    def test_sweeps_of_two_runs_do_not_mix(self):
        capture, part, folder = self.simulate(2), self.path("part"), self.path("sweeps")
        self.scree("slice", capture, part, "--to", "1")
        for command in (["decode", "--sensor", "lidar", "--out", "/dev/null", "--pcd"],
                        ["detect", "--out", "/dev/null", "--stages"]):  # fmt: skip
            counts = []
            for source in (part, capture, part):
                self.scree(*command, folder, source, "--force")
                counts.append(len(os.listdir(folder)))
            self.assertEqual(counts[0], counts[2])
            self.assertLess(counts[0], counts[1])

    def test_a_picture_needs_a_list_of_its_time(self):
        capture, lists = self.simulate(1), self.path("lists.jsonl")
        self.scree("detect", capture, "--out", lists)
        with open(lists) as file:
            last = json.loads(file.read().splitlines()[-1])
        for seconds, code in [(0.05, 0), (5, 1), (3600, 0)]:
            moved = {**last, "stamp_ns": last["stamp_ns"] + int(seconds * 1e9)}
            other = self.write("moved.jsonl", json.dumps(moved) + "\n")
            self.scree("picture", capture, other, "--out", self.path("p.png"), "--force", code=code)

    def test_a_picture_needs_points(self):
        lists = self.path("lists.jsonl")
        self.scree("detect", self.simulate(1), "--out", lists)
        header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA ascii\n"
        empty = self.write("empty.pcd", "# .PCD v0.7\n" + header)
        said = self.scree("picture", empty, lists, "--out", self.path("p.png"), code=1).stderr
        self.assertIn("empty.pcd: holds no points", said)

    def test_the_nearest_command_and_option_are_named(self):
        self.assertIn('no command "detct"; did you mean "detect"?', self.scree("detct", code=2).stderr)
        said = self.scree("detect", "/tmp", "--otu", "x", code=2).stderr
        self.assertIn('detect has no option "--otu"; did you mean "--out"?', said)
        for words, meant in [
            (["simulate", self.path("c"), "--scene", "woood"], "did you mean wood?"),
            (["study", "detecton", "--out", self.path("c")], "did you mean detection?"),
            (["decode", "/tmp", "--sensor", "imuu"], "did you mean imu?"),
        ]:
            self.assertIn(meant, self.scree(*words, code=2).stderr)
        for words, listed in [
            (["xyzzy"], "`scree --help`"),
            (["detect", "/tmp", "--xyzzy"], "`scree detect --help`"),
        ]:
            said = self.scree(*words, code=2).stderr
            self.assertIn(f": {listed} lists them", said)
            self.assertNotIn("did you mean", said)
        said = self.scree("--hepl", code=2).stderr
        self.assertIn('scree has no option "--hepl"; did you mean "--help"?', said)

    def test_help_is_a_word_too(self):
        self.assertEqual(self.scree("help").stdout, self.scree("--help").stdout)
        self.assertEqual(self.scree("help", "detect").stdout, self.scree("detect", "--help").stdout)

    def test_words_of_a_choice_stand_in_help_and_errors(self):
        for command, option, word in [("train", "--profile", "sweep"), ("train", "--counts", "log1p"),
                                      ("simulate", "--scene", "grass"),
                                      ("decode", "--sensor", "encoder")]:  # fmt: skip
            text = self.scree(command, "--help").stdout
            self.assertRegex(text, rf"{option} TEXT:{{\S*{word}")
            self.assertTrue(text.replace("\n", "").isprintable(), command)
            self.assertIn(word, self.scree(command, option, "moon", code=2).stderr)

    def test_progress_is_shown_on_a_terminal_alone(self):
        capture = self.simulate(8)
        piped = self.scree("detect", capture, "--out", self.path("a.jsonl"))
        self.assertNotIn("left", piped.stderr)
        shown = self.on_terminal("detect", capture, "--out", self.path("b.jsonl"))
        self.assertRegex(shown, r"\[#+ *\] +\d+ %, \d+ s left")
        self.assertTrue(shown.endswith("\r\x1b[K"), "and it goes at the end")

    def test_info_tells_imu_encoder_and_truth(self):
        capture = self.simulate(3)
        info = json.loads(self.scree("info", capture, "--json").stdout)
        self.assertAlmostEqual(info["imu"]["messages_per_second"], 100, delta=8)
        self.assertEqual(info["imu"]["with_orientation"], info["imu"]["messages"])
        self.assertGreater(info["encoder"]["samples"], 100)
        with open(os.path.join(capture, "truth.json")) as file:
            truth = json.load(file)
        self.assertAlmostEqual(abs(info["encoder"]["distance_m"]), info["truth"]["way_m"], delta=0.3)
        kinds = [obstacle["kind"] for obstacle in truth["obstacles"]]
        self.assertEqual(info["truth"]["positive"], kinds.count("positive"))
        self.assertEqual(info["truth"]["negative"], kinds.count("negative"))
        table = self.scree("info", capture).stdout
        for row in ("IMU ", "encoder ", "truth "):
            self.assertIn(f"\n{row}", table)
        lidar = os.path.join(capture, "lidar.pcap")
        self.assertIsNone(json.loads(self.scree("info", lidar, "--json").stdout)["truth"])

    def test_status_is_health_once(self):
        self.assert_fails(self.run_to_end(SCREE, "status", "--url", self.url), "no health came")
        for state, stop, words in [(1, False, "health ok:"), (1, True, "stop (stop counts: "),
                                   (0, True, "BLIND (no packets), stop")]:  # fmt: skip
            sender = Sender(self.url, {"SCREE_HEALTH": health_of(state, stop)})
            self.addCleanup(sender.stop)
            code = 0 if state else 1
            self.assertIn(words, self.scree("status", "--url", self.url, code=code).stdout)
            said = self.scree("status", "--url", self.url, "--json", code=code).stdout
            sender.stop()
            health = json.loads(said)
            self.assertEqual((health["health"], health["stop"]), ("ok" if state else "blind", stop))
            self.assertEqual(health["lidar"]["state"], "never seen")

    def test_watch_changes_in_place_on_a_terminal(self):
        messages = {"SCREE_OBSTACLES": list_at(1), "SCREE_HEALTH": health_of(1, False)}
        sender = Sender(self.url, messages)
        self.addCleanup(sender.stop)
        shown = self.on_terminal("watch", "--url", self.url, "--count", "3")
        screens = shown.split("\x1b[H")[1:]
        self.assertGreaterEqual(len(screens), 4)
        self.assertIn("health ok", screens[-1])
        self.assertEqual(screens[-1].count("1 obstacle"), 1)
        lines = self.scree("watch", "--url", self.url, "--json", "--health", "--count", "2").stdout
        objects = [json.loads(line) for line in lines.splitlines()]
        self.assertTrue(any("health" in each for each in objects))
        self.assertEqual(sum("obstacles" in each for each in objects), 2)
        alone = self.scree("watch", "--url", self.url, "--json", "--count", "2").stdout
        self.assertNotIn('"health"', alone)

    def test_logs_of_lists_are_taken_as_lists(self):
        capture, lists = self.simulate(1), self.path("lists.jsonl")
        self.scree("detect", capture, "--out", lists)
        with open(lists) as file:
            stamps = [json.loads(line)["stamp_ns"] for line in file]
        log = self.path("drive.lcm")
        events = [(stamp // 1000, "SCREE_OBSTACLES", list_at(stamp).encode()) for stamp in stamps]
        write_log(log, [(1, "SCREE_HEALTH", health_of(1, False).encode()), *events])
        watched = self.scree("watch", log, "--json").stdout.splitlines()
        self.assertEqual([json.loads(line)["stamp_ns"] for line in watched], stamps)
        self.assertIn("health ok", self.scree("watch", log).stdout)
        truth = os.path.join(capture, "truth.json")
        score = json.loads(self.scree("evaluate", truth, log, "--json").stdout)
        with open(self.path("watched.jsonl"), "w") as file:
            file.write(self.scree("watch", log, "--json", "--health").stdout)
        same = self.scree("evaluate", truth, self.path("watched.jsonl"), "--json").stdout
        self.assertEqual(json.loads(same), score)
        said = self.scree("picture", capture, log, "--out", self.path("p.png")).stdout
        self.assertIn(", 1 obstacles", said)
        write_log(log, [(1, "POSE", b"x")])
        self.assert_fails(self.run_to_end(SCREE, "watch", log), "neither lists nor health")
        self.assert_fails(self.run_to_end(SCREE, "evaluate", truth, log), "no list on")

    def test_doctor_speaks_json(self):
        config = self.write("robot.toml", self.lidar_here())
        said = self.run_to_end(SCREE, "doctor", "--config", config, "--seconds", "0.1", "--json")
        findings = json.loads(said.stdout)
        self.assertEqual(findings[0]["subject"], "configuration")
        self.assertEqual(findings[0]["verdict"], "ok")
        self.assertIn("wrong", {finding["verdict"] for finding in findings})


if __name__ == "__main__":
    main(sys.argv[3:])
