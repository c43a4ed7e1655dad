"""What a robot's safety rests on, while the world stalls: python3 safety_test.py SCREED SCREE [TEST ...]"""

import json
import os
import resource
import signal
import subprocess
import sys
import time

from live_daemon import Lines, LiveDaemonTest
from live_sensors import Player
from programs import PATIENCE, SANITIZED, fill, main

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]


def limited(**limits):
    """For subprocess: sets these limits, as in soft=hard."""

    def set_limits():
        for name, value in limits.items():
            resource.setrlimit(getattr(resource, "RLIMIT_" + name), (value, value))

    return set_limits


class SafetyTest(LiveDaemonTest):
    def start_all(self):
        capture = self.simulate()
        self.start_daemon()
        self.player = Player(capture, self.port, self.position_port, self.mti, loop=True)
        self.addCleanup(self.player.stop)
        self.say("health ok")

    def watch_all(self):
        """Lists and health in the order in which the daemon sends them."""
        return Lines(self.start(self.scree, "watch", "--url", self.url, "--json", "--health").stdout)

    def said(self, lines, health, since=0):
        """When the daemon first says so, by its own clock: on a busy computer it comes here late. And where."""
        line, at = lines.first(lambda line: json.loads(line).get("health") == health, since)
        return json.loads(line)["stamp_ns"], at

    def test_a_log_that_nobody_reads_delays_nothing(self):
        capture = self.simulate()
        read_end, write_end = os.pipe()
        self.addCleanup(os.close, read_end)
        os.set_blocking(write_end, False)
        fill(write_end)
        os.set_blocking(write_end, True)
        daemon = subprocess.Popen([self.screed, "--config", self.config], stderr=write_end)
        self.addCleanup(daemon.wait)
        self.addCleanup(daemon.kill)
        os.close(write_end)
        said = self.watch_all()
        self.said(said, "blind")
        self.mti.plug_in()
        player = Player(capture, self.port, self.position_port, self.mti, loop=True)
        self.addCleanup(player.stop)
        self.said(said, "ok")
        at = len(said.lines)
        player.stop()
        stopped = time.time_ns()
        late = (self.said(said, "blind", at)[0] - stopped) / 1e9
        print(f"BLIND was said {late:.3f} s after the last packet")
        self.assertLess(late, 1)
        daemon.terminate()
        self.assertEqual(daemon.wait(timeout=PATIENCE), 0)

    def sees_fresh_data(self, lines, since):
        """When it first sees after it was blind; then by its own stamps its newest list is not old."""
        at = self.said(lines, "blind", since)[1]
        sees, at = self.said(lines, "ok", at)
        before = [json.loads(line) for line in lines.lines[:at]]
        newest = max(line["stamp_ns"] for line in before if "obstacles" in line)
        self.assertGreater(newest, sees - 600_000_000)
        return sees

    def test_what_comes_late_is_no_sight(self):
        self.start_all()
        said = self.watch_all()
        self.said(said, "ok")
        at = len(said.lines)
        self.player.late = 0.8
        self.sees_fresh_data(said, at)

    def test_after_a_pause_of_the_process_old_lists_are_no_sight(self):
        self.start_all()
        said = self.watch_all()
        self.said(said, "ok")
        for pause in (1, 4):
            at = len(said.lines)
            self.daemon.send_signal(signal.SIGSTOP)
            time.sleep(pause)
            goes_on = time.time_ns()
            self.daemon.send_signal(signal.SIGCONT)
            sees = self.sees_fresh_data(said, at)
            print(f"sees again {(sees - goes_on) / 1e9:.2f} s after a pause of {pause} s")

    def test_asked_to_end_while_it_starts_it_ends_with_0(self):
        self.simulate()
        ended = 0
        for delay in (0.02, 0.05, 0.1, 0.2, 0.4, 0.8):
            daemon = self.start(self.screed, "--config", self.config)
            time.sleep(delay)
            with open(f"/proc/{daemon.pid}/status") as status:
                blocked = next(line.split()[1] for line in status if line.startswith("SigBlk"))
            daemon.terminate()
            code = daemon.wait(timeout=PATIENCE)
            # Before that the loader is at work, and nothing has begun.
            if int(blocked, 16) >> (signal.SIGTERM - 1) & 1:
                self.assertEqual(code, 0, f"after {delay} s: {daemon.stderr.read()}")
                ended += 1
        self.assertGreater(ended, 0)

    def test_who_reads_the_log_may_go(self):
        self.simulate()
        daemon = self.start(self.screed, "--config", self.config)
        self.read_until(daemon.stderr, "publishing on")
        daemon.stderr.close()
        self.mti.plug_in()  # is said in the log
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        time.sleep(1.5)
        self.assertIsNone(daemon.poll())
        daemon.terminate()
        self.assertEqual(daemon.wait(timeout=PATIENCE), 0)
        daemon.stderr = open(os.devnull)

    def ends_or_runs(self, limits):
        """One sentence and 1, or it runs and ends when asked to."""
        options = {"env": {**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}}
        daemon = self.start(self.screed, "--config", self.config, preexec_fn=limits, **options)
        log = Lines(daemon.stderr)
        end = time.monotonic() + PATIENCE
        while daemon.poll() is None and time.monotonic() < end:
            if any("publishing on" in line for line in log.lines):
                time.sleep(0.3)  # until its threads run, or do not
                daemon.terminate()
                break
            time.sleep(0.02)
        code = daemon.wait(timeout=PATIENCE)
        log.thread.join()
        said = "".join(log.lines)
        if code == 0:
            self.assertIn("stopping", said)
            return None
        self.assertIn(code, (1, 127), said)  # 127: the loader has not got so far
        self.assertTrue(said.strip())
        return said.strip().splitlines()[-1]

    def test_with_few_descriptors_it_says_so_or_runs(self):
        if SANITIZED:
            self.skipTest("a sanitizer needs descriptors of its own")
        self.simulate()
        said = {self.ends_or_runs(limited(NOFILE=files)) for files in range(4, 34, 2)}
        self.assertIn(None, said)
        self.assertTrue(any("descriptor" in (line or "") or "open files" in (line or "")
                            for line in said), said)  # fmt: skip

    def test_with_little_memory_it_says_so(self):
        if SANITIZED:
            self.skipTest("a sanitizer's shadow memory needs all the addresses")
        self.simulate()
        said = [self.ends_or_runs(limited(AS=size << 20)) for size in range(60, 1300, 124)]
        self.assertIsNone(said[-1])
        sentences = [line for line in said if line and "memory" in line]
        self.assertTrue(sentences, said)
        self.assertTrue(any("[memory]" in line for line in sentences), said)

    def test_settings_that_need_more_than_the_computer_has_are_refused(self):
        if SANITIZED:
            self.skipTest("a sanitizer's shadow memory needs all the addresses")
        self.simulate()
        with open(self.config, "a") as file:
            file.write("[memory]\nmap_voxels = 12000000\n")
        said = self.ends_or_runs(limited(AS=1 << 30))
        self.assertIsNotNone(said)
        self.assertIn("GB are left", said)

    def test_with_few_threads_it_says_so(self):
        if os.geteuid() == 0:
            self.skipTest("root may have any number of threads")
        self.simulate()
        self.ends_or_runs(limited(NPROC=1))


if __name__ == "__main__":
    main(sys.argv[3:])
