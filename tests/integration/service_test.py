"""screed as systemd's service, with this test in systemd's place:
python3 service_test.py SCREED [TEST ...]"""

import os
import signal
import socket
import subprocess
import sys
import time

from hung_thread import hung
from programs import PATIENCE, ProgramTest, main

SCREED = sys.argv[1]
WATCHDOG = 1.0  # seconds


class ServiceTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.config = self.path("robot.toml")
        self.configure("")
        self.manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.manager.close)
        self.manager.bind(self.path("notify"))

    def configure(self, more):
        others = f'[imu]\ndevice = "{self.path("imu")}"\n[lcm]\nurl = "{self.url}"\n'
        self.write("robot.toml", self.lidar_here() + others + more)

    def start_service(self):
        told = {"NOTIFY_SOCKET": self.path("notify"), "WATCHDOG_USEC": str(int(WATCHDOG * 1e6))}
        self.daemon = self.start(SCREED, "--config", self.config, env={**os.environ, **told})
        self.assertEqual(self.told("READY="), "READY=1")

    def told(self, what, seconds=PATIENCE):
        """The next message that begins so; None when none came in time."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.manager.settimeout(left)
            try:
                message = self.manager.recv(4096).decode()
            except TimeoutError:
                return None
            if message.startswith(what):
                return message
        return None

    def reload(self):
        self.daemon.send_signal(signal.SIGHUP)
        message = self.told("RELOADING=")
        self.assertRegex(message, r"^RELOADING=1\nMONOTONIC_USEC=\d+$")
        self.assertEqual(self.told("READY="), "READY=1")

    def test_systemd_is_told_how_it_fares(self):
        self.start_service()
        status = self.told("STATUS=blind")
        self.assertEqual(status, f"STATUS=blind: nothing has come on UDP port {self.port}")
        for _ in range(3):
            self.assertIsNotNone(self.told("WATCHDOG=1"))
        self.daemon.terminate()
        self.assertEqual(self.told("STOPPING="), "STOPPING=1")
        self.assertEqual(self.daemon.wait(PATIENCE), 0)

    def test_a_hung_thread_starves_the_watchdog(self):
        self.start_service()
        for name in ["lidar", "imu", "encoder", "detector", "publisher"]:
            self.assertIsNotNone(self.told("WATCHDOG=1"))
            try:
                with hung(self.daemon.pid, name):
                    # One message may be on its way.
                    self.told("WATCHDOG=1", WATCHDOG)
                    self.assertIsNone(self.told("WATCHDOG=1", 2 * WATCHDOG), name)
            except PermissionError as error:
                self.skipTest(f"no thread can be stopped here: {error}")
            self.read_until(self.daemon.stderr, f"the {name} thread hangs")
            self.read_until(self.daemon.stderr, "all threads go round again")

    def test_a_reload_takes_over_what_can_change(self):
        self.start_service()
        self.configure("[stop]\nlength = 4.5\n[track]\nreach = 5.0\n[map]\nvoxel = 0.07\n")
        self.reload()
        line = self.read_until(self.daemon.stderr, "reloaded")
        self.assertIn("changed are stop.length, track.reach", line)
        self.read_until(self.daemon.stderr, "needs a restart: map.voxel")
        self.reload()
        self.read_until(self.daemon.stderr, "nothing that can change now has")
        self.read_until(self.daemon.stderr, "needs a restart: map.voxel")

    def test_a_bad_file_is_refused_and_the_daemon_goes_on(self):
        self.start_service()
        self.configure("[stop]\nlength = -1.0\n")
        self.reload()
        line = self.read_until(self.daemon.stderr, "not reloaded, the old settings stay")
        self.assertIn(f"{self.config}:10: stop.length", line)
        os.remove(self.config)
        self.reload()
        self.read_until(self.daemon.stderr, "cannot read ")
        self.configure("[stop]\nlength = 4.5\n")
        self.reload()
        self.read_until(self.daemon.stderr, "changed are stop.length")

    def test_check_config_starts_nothing(self):
        check = [SCREED, "--check-config", "--config", self.config]
        result = self.run_to_end(*check)
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.configure("[stop]\nlength = -1.0\n")
        self.assert_fails(self.run_to_end(*check), f"{self.config}:10: stop.length")
        self.configure("")
        with open(self.config) as file:
            text = file.read()
        self.write("robot.toml", text.replace("[imu]\n", "[imu]\nrate = 400\nbaud = 9600\n"))
        self.assert_fails(self.run_to_end(*check), "more than imu.baud = 9600")
        self.configure('[detect.map]\nnetwork = "none.txt"\n')
        self.assert_fails(self.run_to_end(*check), "none.txt")
        self.configure('[gpio]\nstop = "gpiochip0"\n')
        self.assert_fails(self.run_to_end(*check), 'gpio.stop: "gpiochip0" must be CHIP:LINE')
        for table, key, value in [
            ("lidar", "sender", "192.168.1.201:2368"),
            ("lidar", "sender", "velodyne.local"),
            ("lidar", "address", "239.1.2.3"),
            ("lcm", "url", "udpm://127.0.0.1:7667?ttl=0"),
            ("lcm", "url", "pigeon://coop"),
        ]:
            config = self.write("wrong.toml", f'[{table}]\n\n{key} = "{value}"\n')
            for arguments in [[], ["--check-config"]]:
                result = self.run_to_end(SCREED, *arguments, "--config", config)
                self.assert_fails(result, f"{config}:3: {table}.{key}: ", value)

    def test_check_config_refuses_what_this_computer_has_not(self):
        for table, key, value in [
            ("lidar", "address", "192.0.2.77"),
            ("gpio", "stop", "gpiochip77:3"),
        ]:
            config = self.write("elsewhere.toml", f'[{table}]\n{key} = "{value}"\n')
            said = [
                self.run_to_end(SCREED, *arguments, "--config", config).stderr.splitlines()[-1]
                for arguments in [[], ["--check-config"]]
            ]
            self.assertIn(value, said[1])
            self.assertEqual(said[0], said[1])

    def test_the_journal_gets_levels(self):
        with open(self.path("log"), "w") as log:
            place = os.fstat(log.fileno())
            journal = {"JOURNAL_STREAM": f"{place.st_dev}:{place.st_ino}"}
            daemon = subprocess.Popen(
                [SCREED, "--config", self.config], stderr=log, env={**os.environ, **journal}
            )
            self.addCleanup(daemon.wait)
            self.addCleanup(daemon.kill)
            end = time.monotonic() + PATIENCE
            text = ""
            while "no packets" not in text and time.monotonic() < end:
                time.sleep(0.1)
                with open(self.path("log")) as file:
                    text = file.read()
        self.assertIn("\n<6>publishing on", text)
        self.assertIn("\n<4>no packets on", text)


if __name__ == "__main__":
    main(sys.argv[2:])
