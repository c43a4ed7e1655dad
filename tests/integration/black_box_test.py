"""What screed keeps in files: python3 black_box_test.py SCREED SCREE [TEST ...]"""

import glob
import json
import os
import re
import signal
import sys
import time

from live_daemon import LiveDaemonTest
from live_sensors import Player
from programs import PATIENCE, main

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]


class BlackBoxTest(LiveDaemonTest):
    def start_all(self, more=""):
        capture = self.simulate()
        with open(self.config, "a") as file:
            file.write(f'[blackbox]\nfolder = "{self.path("box")}"\n{more}[metrics]\nfile = "{self.path("scree.prom")}"\n')
        self.start_daemon()
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        self.player = Player(capture, self.port, self.position_port, self.mti, loop=True)
        self.addCleanup(self.player.stop)
        self.say("health ok")

    def wait_for_lists(self, count):
        end = time.monotonic() + PATIENCE
        wanted = len(self.lists.lines) + count
        while len(self.lists.lines) < wanted:
            self.assertLess(time.monotonic(), end, "no more lists came")
            time.sleep(0.05)

    def log_of(self, reason):
        """The only closed log of that reason, when it is there."""
        end = time.monotonic() + PATIENCE
        while not (found := self.logs_of(reason)):
            self.assertLess(time.monotonic(), end, f"no log of {reason}: {os.listdir(self.path('box'))}")
            time.sleep(0.05)
        return found[-1]

    def logs_of(self, reason):
        return glob.glob(self.path(f"box/*_{reason}.lcm"))

    def watched(self, log):
        """Lists and healths of a log."""
        lines = self.done(self.scree, "watch", log, "--json", "--health").stdout.splitlines()
        lines = [json.loads(line) for line in lines]
        return [it for it in lines if "obstacles" in it], [it for it in lines if "health" in it]

    def test_a_mark_a_crash_and_blindness_are_closed_and_reported(self):
        self.start_all()
        self.wait_for_lists(20)
        marked = self.done(self.scree, "mark", "--config", self.config).stdout.strip()
        self.assertEqual(marked, self.log_of("mark"))
        lists, healths = self.watched(marked)
        self.assertGreater(len(lists), 15)
        self.assertGreater(len(healths), 1)
        said = {json.loads(line)["stamp_ns"]: json.loads(line) for line in self.lists.lines}
        for it in lists:
            self.assertEqual(it, said.get(it["stamp_ns"], it))
        self.assertTrue(any(it["stamp_ns"] in said for it in lists))
        report = self.done(self.scree, "report", marked, "--out", self.path("report.html")).stdout
        self.assertIn(f"{len(lists)} lists", report)

        self.wait_for_lists(10)
        self.daemon.kill()
        self.daemon.wait(PATIENCE)
        self.daemon = self.start(self.screed, "--config", self.config)
        self.assertGreater(len(self.watched(self.log_of("crash"))[0]), 5)

        self.say("health ok", len(self.health.lines))
        self.player.stop()
        lists, healths = self.watched(self.log_of("blind"))
        self.assertEqual(healths[-1]["health"], "blind")
        self.daemon.send_signal(signal.SIGTERM)
        self.assertEqual(self.daemon.wait(PATIENCE), 0)
        self.log_of("end")

    def test_packets_are_kept_where_that_is_asked_for(self):
        self.start_all("packets = true\n")
        self.wait_for_lists(20)
        marked = self.done(self.scree, "mark", "--config", self.config).stdout.strip()
        # Its packets decode as a capture's: a turn has 75 of them.
        info = json.loads(self.done(self.scree, "info", marked, "--json", "--config", self.config).stdout)
        self.assertGreater(info["packets"], 1000)
        self.assertEqual(info["refused"], {})
        again = self.path("again.jsonl")
        self.done(self.scree, "detect", marked, "--out", again, "--config", self.config)
        with open(again) as file:
            lists = [json.loads(line) for line in file]
        self.assertGreater(len(lists), 10)
        self.assertTrue(any(it["obstacles"] for it in lists))
        # Whoever asks a robot that sees to end has not blinded it. A computer that has too much to do
        # was perhaps blind before.
        before = self.logs_of("blind")
        self.daemon.send_signal(signal.SIGTERM)
        self.assertEqual(self.daemon.wait(PATIENCE), 0)
        self.log_of("end")
        self.assertEqual(self.logs_of("blind"), before)

    def test_metrics_say_what_health_says(self):
        self.start_all()
        end = time.monotonic() + PATIENCE
        values = {}
        while values.get("scree_blind") != "0" or float(values["scree_lists_published_total"]) < 10:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.2)
            with open(self.path("scree.prom")) as file:
                values = dict(re.findall(r"^(scree_\S+) (\S+)$", file.read(), re.M))
        self.assertEqual(values['scree_sensor_ok{sensor="lidar"}'], "1")
        self.assertGreater(float(values['scree_sensor_rate_hertz{sensor="lidar"}']), 400)
        self.assertEqual(os.stat(self.path("scree.prom")).st_mode & 0o044, 0o044)

    def test_a_mark_that_nobody_takes_is_said(self):
        config = self.write("robot.toml", f'[blackbox]\nfolder = "{self.path("box")}"\n')
        os.mkdir(self.path("box"))
        self.assert_fails(self.run_to_end(self.scree, "mark", "--config", config), "does screed run")
        self.assertEqual(os.listdir(self.path("box")), [])
        none = self.write("none.toml", "")
        self.assert_fails(self.run_to_end(self.scree, "mark", "--config", none), "blackbox.folder is empty")


if __name__ == "__main__":
    main(sys.argv[3:])
