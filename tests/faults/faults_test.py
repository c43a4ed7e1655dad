"""screed on a drive on which one thing after another goes wrong, also in pairs:
python3 faults_test.py SCREED SCREE [TEST ...]"""

import contextlib
import json
import os
import signal
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "integration"))

from faulty_player import FaultyPlayer, Flood  # noqa: E402
from hung_thread import hang, let_go  # noqa: E402
from live_daemon import Lines, LiveDaemonTest  # noqa: E402
from live_sensors import EmulatedMti  # noqa: E402
from programs import PATIENCE, main  # noqa: E402
from surroundings import (  # noqa: E402
    Descriptors, LogReader, Processor, Route, SmallDisk, take_namespaces,
)

LiveDaemonTest.screed, LiveDaemonTest.scree = sys.argv[1:3]

SECONDS = 90  # of the drive
FULL_HOUR = 3.6  # seconds into the drive
SAID_WITHIN = 0.3  # seconds
# What is here besides the daemon: the scheduler of a busy test machine and the way to this program.
SLACK = 0.15
PAIRS = [
    ("lidar cut", "IMU cut"),
    ("IMU cut", "33 % of the packets lost"),
    ("process stopped", "flood of foreign packets"),
    ("lidar starts anew", "garbage in place of the IMU"),
    ("detector hangs", "IMU cut"),
    ("lidar cut", "reload"),
    ("lidar cut", "nobody reads the log"),
    ("reload", "no new descriptors"),
]
# What says that the machine was too slow for the daemon, and not what went wrong.
SLOW = ("the detector is late", "no list of the last half second", "no whole turns")


class Fault:
    """One thing that goes wrong, what health must say of it, and what the log.

    `may_blind`: it takes from the daemon what it needs to see."""

    def __init__(self, name, begin, end, says=None, seconds=0.7, recovers_within=1.0, slow=0,
                 logs=None, may_blind=False):  # fmt: skip
        self.name, self.begin, self.end, self.says = name, begin, end, says
        self.seconds, self.recovers_within, self.slow = seconds, recovers_within, slow
        self.logs, self.may_blind = logs, may_blind or says is not None


class FaultsTest(LiveDaemonTest):
    def read_log(self):
        self.reader = LogReader(self.daemon)
        self.addCleanup(self.reader.stop)
        return self.reader.lines

    def start_drive(self):
        self.has_namespaces = take_namespaces()
        self.capture = capture = os.environ.get("SCREE_FAULTS_DRIVE") or self.path("capture")
        if not os.path.exists(capture):
            simulate = [self.scree, "simulate", capture, "--seconds", str(SECONDS), "--scene", "rolling"]
            self.done(*simulate, "--seed", "45")
        self.mti = EmulatedMti(self.path("imu"))
        self.config = self.write_config_here(capture, self.mti.port)
        with open(self.config) as file:
            text = file.read()
        box = self.path("blackbox")
        self.disk = SmallDisk(box) if self.has_namespaces else None
        if self.disk:
            self.addCleanup(self.disk.unmount)
        text += f'[blackbox]\nfolder = "{box}"\npackets = true\nmegabytes = 24\n'
        self.write("robot.toml", text.replace('"vcan0"', '""'))
        self.start_daemon()
        self.states = Lines(self.start(self.scree, "watch", "--url", self.url, "--json", "--health").stdout)
        self.assertTrue(self.mti.measures.wait(PATIENCE))
        self.player = FaultyPlayer(capture, self.port, self.position_port, self.mti, FULL_HOUR)
        self.addCleanup(self.player.stop)
        self.sees(0)

    def sees(self, since):
        """Where health first says so, from there on."""
        return self.states.first(lambda line: is_well(health_of(line)), since)[1]

    def faults(self):
        player = self.player
        set_ = lambda **values: lambda: [setattr(player, *item) for item in values.items()]  # noqa: E731
        stop = lambda: self.daemon.send_signal(signal.SIGSTOP)  # noqa: E731
        go_on = lambda: self.daemon.send_signal(signal.SIGCONT)  # noqa: E731
        nothing = lambda: None  # noqa: E731
        return [
            Fault("the lidar's full hour", nothing, nothing, seconds=FULL_HOUR - 1),
            Fault("33 % of the packets lost", set_(loss=0.33), set_(loss=0), "lidar slow", 2.3, 2.5, 2.0),
            Fault("10 % of the packets overtaken", set_(disorder=0.1), set_(disorder=0)),
            Fault("10 % of the packets doubled", set_(doubles=0.1), set_(doubles=0)),
            Fault("lidar cut", set_(lidar_cut=True), set_(lidar_cut=False), "blind"),
            Fault("lidar starts anew", set_(lidar_cut=True),
                  set_(lidar_cut=False, stamp_shift_us=1_234_567_890), "blind"),
            Fault("packets held up, then at once", set_(held=[]), player.release, "blind"),
            Fault("garbage in place of the lidar", set_(lidar_is_garbage=True),
                  set_(lidar_is_garbage=False), "blind"),
            Fault("IMU cut", set_(imu_cut=True), set_(imu_cut=False), "imu silent"),
            Fault("garbage in place of the IMU", set_(imu_is_garbage=True), set_(imu_is_garbage=False),
                  "imu wrong data"),
            Fault("IMU unplugged", self.mti.unplug, self.mti.plug_in, "imu silent", 0.7, 3.0),
            Fault("flood of foreign packets", self.flood(1206), self.end_flood),
            Fault("flood of foreign datagrams", self.flood(80), self.end_flood),
            Fault("reload", self.reload, nothing),
            Fault("reload of a bad file", self.reload_badly, nothing),
            Fault("process stopped", stop, go_on, "blind after", 1.0, 1.0),
            Fault("detector hangs", self.hang("detector"), self.let_go, "blind", 0.7, 1.0),
            Fault("IMU's thread hangs", self.hang("imu"), self.let_go, "imu silent", 0.7, 1.0),
            Fault("lidar's thread hangs", self.hang("lidar"), self.let_go, "blind", 0.7, 1.0),
            self.loss_of("nobody reads the log", self.reader),
            self.loss_of("no new descriptors", Descriptors(self.daemon.pid)),
            self.loss_of("half of the processor", Processor(self.daemon.pid), seconds=2,
                         recovers_within=2, may_blind=True),
        ]

    def loss_of(self, name, thing, **options):
        return Fault(name, thing.begin, thing.end, **options)

    def faults_of_namespaces(self):
        """Those that need routes and a disk of their own."""
        if not self.has_namespaces:
            print("not tried: a full disk and a lost route need root")
            return []
        return [
            self.loss_of("disk of the black box full", self.disk, logs="is the disk full?"),
            self.loss_of("route of LCM gone", Route(), logs="messages that LCM did not take",
                         seconds=1.5, may_blind=True),
        ]

    def flood(self, size):
        def begin():
            self.flooding = Flood(self.port, size)

        return begin

    def end_flood(self):
        self.flooding.stop()

    def hang(self, thread):
        def begin():
            self.hung = hang(self.daemon.pid, thread)

        return begin

    def let_go(self):
        let_go(self.hung)

    def reload(self):
        self.daemon.send_signal(signal.SIGHUP)

    def reload_badly(self):
        with open(self.config) as file:
            good = file.read()
        self.write("robot.toml", good + "\n[lidra]\nport = 1\n")
        self.reload()
        self.log.first(lambda line: "not reloaded, the old settings stay" in line)
        self.write("robot.toml", good)

    def when_said(self, words, since, begun):
        """Seconds until health says it."""
        while time.monotonic() < begun + 5:
            for line in self.states.lines[since:]:
                if says(health_of(line), words):
                    return time.monotonic() - begun
            time.sleep(0.002)
        return None

    def reasons(self, since):
        states = [health_of(line) for line in self.states.lines[since:]]
        return {health["reason"] for health in states if says(health, "blind")}

    def go_through(self, faults):
        """One row of the table, and what is wrong with it."""
        since, logged = len(self.states.lines), len(self.log.lines)
        begun = time.monotonic()
        for fault in faults:
            fault.begin()
        first = faults[0]
        words, said = first.says, None
        if words and not words.endswith(" after"):
            said = self.when_said(words, since, begun)
        time.sleep(max(0, begun + first.seconds - time.monotonic()))
        for fault in faults:
            fault.end()
        ended, at = time.monotonic(), len(self.states.lines)
        if words and words.endswith(" after"):
            said = self.when_said(words.removesuffix(" after"), since, ended)
        recovered = self.when_recovered(at, ended)
        wrong = self.judge(faults, said, recovered, since)
        log = "".join(self.log.lines[logged:])
        wrong += [f"not in the log: {fault.logs}" for fault in faults if (fault.logs or "") not in log]
        return {"name": " and ".join(fault.name for fault in faults), "said": said,
                "recovered": recovered, "wrong": wrong, "reasons": self.reasons(since)}

    def when_recovered(self, since, ended):
        """Seconds until the robot sees, and lidar and IMU are well."""
        while time.monotonic() < ended + 5:
            if any(is_well(health_of(line)) for line in self.states.lines[since:]):
                return time.monotonic() - ended
            time.sleep(0.002)
        return None

    def judge(self, faults, said, recovered, since):
        first = faults[0]
        wrong = []
        if first.says and (said is None or said > SAID_WITHIN + SLACK + first.slow):
            wrong.append(f"said after {said}")
        longest = max(fault.recovers_within for fault in faults)
        if recovered is None or recovered > longest + 1 + SLACK:  # health comes once a second
            wrong.append(f"recovered after {recovered}")
        if not any(fault.may_blind for fault in faults) and any(
            says(health_of(line), "blind") for line in self.states.lines[since:]
        ):
            wrong.append("BLIND, though nothing is lost")
        if self.daemon.poll() is not None:
            wrong.append("the daemon has ended")
        return wrong

    def score(self, calm):
        """F1 of the lists while nothing was wrong."""
        lists = []
        for line in self.lists.lines:
            found = json.loads(line)
            found["stamp_ns"] -= self.player.later_ns
            if any(begin <= found["stamp_ns"] <= end for begin, end in calm):
                lists.append(json.dumps(found))
        file = self.write("calm.jsonl", "\n".join(lists) + "\n")
        truth = os.path.join(self.capture, "truth.json")
        result = self.run_to_end(self.scree, "evaluate", truth, file, "--json")
        return json.loads(result.stdout)["all"]["f1"], len(lists)

    def test_whatever_goes_wrong_is_said_and_gone_again(self):
        self.start_drive()
        time.sleep(2)
        faults = self.faults()
        named = {fault.name: fault for fault in faults}
        rows, calm = [], []
        groups = [[fault] for fault in faults + self.faults_of_namespaces()]
        groups += [[named[name] for name in pair] for pair in PAIRS]
        for group in groups:
            if not self.player.thread.is_alive():
                break  # everything took long
            with contextlib.suppress(PermissionError):  # no thread can be stopped here
                rows.append(self.go_through(group))
                time.sleep(1)
                now = time.time_ns() - self.player.later_ns
                calm.append((now - 1_000_000_000, now))
        f1, lists = self.score(calm)
        print_table(rows, f1, lists)
        wrong = [row for row in rows if row["wrong"]]
        if wrong and all(any(slow in reason for reason in row["reasons"] for slow in SLOW) for row in wrong):
            self.skipTest("this machine was too slow: lists were late without a fault of the detector")
        self.assertEqual(wrong, [])
        self.assertGreaterEqual(len(rows), len(groups) - 4, "the drive ended before: make it longer")
        # Of whole drives through this scene it is 0.97; a second after a fault the map is young.
        self.assertGreater(f1, 0.8)
        self.daemon.terminate()
        self.assertEqual(self.daemon.wait(timeout=PATIENCE), 0)


def health_of(line):
    """As an object; None where the line is a list."""
    return json.loads(line) if '"health"' in line else None


def says(health, words):
    """"blind", or a sensor and its state."""
    if health is None or words == "blind":
        return health is not None and health["health"] == "blind"
    sensor, _, state = words.partition(" ")
    return health[sensor]["state"] == state


def is_well(health):
    return health is not None and not says(health, "blind") and all(
        says(health, sensor + " ok") for sensor in ("lidar", "imu")
    )


def print_table(rows, f1, lists):
    print("| what goes wrong | said after, s | well again after, s |\n|---|---|---|")
    for row in rows:
        said = "" if row["said"] is None else f"{row['said']:.2f}"
        recovered = "never" if row["recovered"] is None else f"{row['recovered']:.2f}"
        print(f"| {row['name']} | {said} | {recovered} |")
        if row["wrong"]:
            print("   ", *row["wrong"], *row["reasons"], sep="; ")
    print(f"F1 of {lists} lists a second after each: {f1:.3f}")


if __name__ == "__main__":
    main(sys.argv[3:])
