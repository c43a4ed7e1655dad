"""LCM logs as captures, and what LCM's own programs do with ours:
python3 lcm_log_test.py SCREED SCREE [TEST ...]"""

import json
import os
import shutil
import signal
import struct
import sys

from lcm_log_file import write_log
from pcap_file import pcap_records
from programs import PATIENCE, ProgramTest, free_port, main
from synthetic_capture import write_capture

SCREED, SCREE = sys.argv[1:3]

# How drivers put a packet into a message: bare, as {utime, length, data}, or several in a list.
FINGERPRINT, TIME = b"\x12\x34\x56\x78\x9a\xbc\xde\xf0", struct.pack(">q", 1)
FORMS = {
    "bare": (1, lambda packets: packets[0]),
    "raw_t": (1, lambda packets: FINGERPRINT + TIME + struct.pack(">i", len(packets[0])) + packets[0]),
    "list_t": (3, lambda packets: FINGERPRINT + TIME + struct.pack(">i", len(packets))
               + b"".join(TIME + b"\x01" + struct.pack(">i", len(one)) + one for one in packets)),
}  # fmt: skip


class LcmLogTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.pcap = self.path("lidar.pcap")
        write_capture(self.pcap, seconds=1)

    def done(self, *command):
        return super().done(SCREE, *command)

    def log(self, form, sizes=(1206, 512)):
        count, pack = FORMS[form]
        packets = [(stamp, frame[42:]) for stamp, frame in pcap_records(self.pcap)
                   if len(frame) - 42 in sizes]  # fmt: skip
        events = [(packets[0][0] // 1000, "POSE", FINGERPRINT + bytes(100))]
        for at in range(0, len(packets), count):
            batch = packets[at : at + count]
            events.append((batch[-1][0] // 1000, "VELODYNE", pack([packet for _, packet in batch])))
        write_log(self.path(form), events)
        return self.path(form)

    def info(self, capture):
        return json.loads(self.done("info", capture, "--json").stdout)

    def rows(self):
        with open(self.path("out.csv")) as file:
            return [line.split(",", 1)[1] for line in file]

    def test_a_log_of_any_form_is_a_capture(self):
        wanted = self.info(self.pcap)
        self.done("decode", self.pcap, "--sensor", "lidar", "--out", self.path("out.csv"))
        returns = self.rows()
        for form in FORMS:
            # Only of the data packets a list is known.
            log = self.log(form, (1206,) if form == "list_t" else (1206, 512))
            found = self.info(log)
            for key in ["packets", "sweeps", "lost", "refused", "points"]:
                self.assertEqual(found[key], wanted[key], f"{form}: {key}")
            if form != "list_t":
                self.assertEqual(found["position"]["packets"], wanted["position"]["packets"])
            self.assertEqual(found["frames"]["not_udp"], 1)
            self.done("decode", log, "--sensor", "lidar", "--out", self.path("out.csv"), "--force")
            self.assertEqual(self.rows(), returns, form)
            lists = self.run_to_end(SCREE, "detect", log, "--out", self.path("lists.jsonl"), "--force")
            self.assertEqual(lists.returncode, 0, lists.stderr)

    def test_a_log_is_replayed_and_sliced(self):
        log = self.log("raw_t")
        part = self.path("part")
        self.done("slice", log, part, "--from", "0.5")
        info = self.info(part)
        self.assertAlmostEqual(info["packets"] / self.info(log)["packets"], 0.5, delta=0.05)
        config = self.write(
            "robot.toml",
            f'[lidar]\naddress = "127.0.0.1"\nport = {self.port}\nposition_port = {self.position_port}\n',
        )
        recorder = self.start(SCREE, "record", self.path("recording"), "--config", config)
        self.read_until(recorder.stderr, "recording to")
        self.done("replay", log, "--address", f"127.0.0.1:{self.port}", "--position-port",
                  str(self.position_port))  # fmt: skip
        recorder.send_signal(signal.SIGINT)
        recorder.communicate(timeout=PATIENCE)
        # Which of the two ports is read first is the recorder's.
        for port in [2368, 8308]:
            wanted = self.payloads(self.pcap, port)
            here = self.port if port == 2368 else self.position_port
            self.assertEqual(self.payloads(self.path("recording/lidar.pcap"), here), wanted)

    @staticmethod
    def payloads(path, port):
        return [frame[42:] for _, frame in pcap_records(path)
                if struct.unpack_from(">H", frame, 36)[0] == port]  # fmt: skip

    def test_a_log_without_packets_and_one_that_breaks_off_are_said(self):
        write_log(self.path("poses"), [(1, "POSE", bytes(99)), (2, "POSE", bytes(99))])
        result = self.run_to_end(SCREE, "decode", self.path("poses"), "--sensor", "lidar",
                                 "--out", self.path("out.csv"))  # fmt: skip
        self.assert_fails(result, "none of its 2 LCM messages holds a packet of the lidar")
        log = self.log("raw_t")
        os.truncate(log, os.path.getsize(log) - 7)
        self.assertIn("bytes belong to no whole message", self.info(log)["broken_off"])

    def test_what_lcm_logger_logs_of_us_lcm_logplayer_plays(self):
        for program in ["lcm-logger", "lcm-logplayer"]:
            if shutil.which(program) is None:
                self.skipTest(f"there is no {program}")
        config = self.write(
            "robot.toml",
            f'[lidar]\naddress = "127.0.0.1"\nport = {self.port}\n'
            f'position_port = {self.position_port}\n[lcm]\nurl = "{self.url}"\n',
        )
        log = self.path("events")
        logger = self.start("lcm-logger", f"--lcm-url={self.url}", "-q", log)
        daemon = self.start(SCREED, "--config", config)
        self.read_until(daemon.stderr, "publishing on")
        watch = self.start(SCREE, "watch", "--url", self.url, "--json", "--count", "5")
        replay = self.start(SCREE, "replay", self.pcap, "--loop", "--address",
                            f"127.0.0.1:{self.port}", "--position-port", str(self.position_port))  # fmt: skip
        live, complaint = watch.communicate(timeout=PATIENCE)
        self.assertEqual(watch.returncode, 0, complaint)
        for program in [replay, daemon, logger]:
            program.send_signal(signal.SIGINT)
            program.communicate(timeout=PATIENCE)

        elsewhere = f"udpm://239.255.76.67:{free_port()}?ttl=0"
        # More lists than the log has: of the first round it may miss those before it listens.
        watch = self.start(SCREE, "watch", "--url", elsewhere, "--json", "--count", "30",
                           "--seconds", str(PATIENCE))  # fmt: skip
        health = self.start(SCREE, "watch", "--url", elsewhere)
        again = []
        while watch.poll() is None:
            again.append(self.run_to_end("lcm-logplayer", "-l", elsewhere, "-s", "5", log))
        self.assertEqual([one.returncode for one in again], [0] * len(again))
        played, complaint = watch.communicate(timeout=PATIENCE)
        self.assertEqual(watch.returncode, 0, complaint)
        self.assertLessEqual(set(live.splitlines()[:1]), set(played.splitlines()))
        self.read_until(health.stdout, "health")


if __name__ == "__main__":
    main(sys.argv[3:])
