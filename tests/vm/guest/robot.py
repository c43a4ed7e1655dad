"""A robot's sensors and lines in the virtual machine, and the configuration for them."""

import fcntl
import grp
import os
import re
import subprocess
import termios
import threading
import time

from live_sensors import EmulatedMti, Player, can_socket
from steps import GpioChip, run

CONFIG = "/etc/scree/scree.toml"
# A coarse and narrow map, so that lists come in time on an emulated machine too.
REACH = 5.0
MAP = f"registration = false\nreach = {REACH}\nsearch_reach = {REACH}\n"
BUS_OFF = b"\x40\x00\x00\x20" + b"\x08\x00\x00\x00" + bytes(8)  # an error frame of SocketCAN


class PtyMti(EmulatedMti):
    """An IMU on a pseudo-terminal that the service's group may open, as udev has it for a real one."""

    def plug_in(self):
        super().plug_in()
        os.chown(self.port, -1, grp.getgrnam("dialout").gr_gid)
        os.chmod(self.port, 0o660)

    def _answer(self):
        # Unlike a real port, a pseudo-terminal stays locked when the process that has locked it dies.
        threading.Thread(target=self._unlock, args=[self.master], daemon=True).start()
        super()._answer()

    def _unlock(self, master):
        while self.master == master:
            try:
                port = os.open(self.port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
                fcntl.ioctl(port, termios.TIOCNXCL)
                os.close(port)
            except OSError:
                return  # it is unplugged
            time.sleep(0.5)


class SerialMti(EmulatedMti):
    """An IMU at the other end of the USB adapter's serial line."""

    def plug_in(self):
        run("stty -F /dev/ttyS1 raw -echo 115200")
        self.master = os.open("/dev/ttyS1", os.O_RDWR | os.O_NOCTTY)
        self.answers = threading.Thread(target=self._answer, daemon=True)
        self.answers.start()


class Bus:
    """A CAN interface that may be away: what is sent then is lost."""

    def __init__(self):
        run("modprobe vcan")
        self.add()

    def add(self):
        run("ip link add vcan0 type vcan; ip link set vcan0 up")
        self.socket, reason = can_socket("vcan0")
        assert self.socket, reason

    def remove(self):
        run("ip link delete vcan0")

    def send(self, frame):
        try:
            self.socket.send(frame)
        except OSError:
            pass


class Robot:
    def __init__(self, capture):
        self.capture = capture
        run("ip link set lo multicast on; ip route add 224.0.0.0/4 dev lo")
        self.can = Bus()
        self.chip = GpioChip("rig", ["pps", "stop", "heartbeat"])
        self.mti = PtyMti("/dev/robot-imu")
        self.player = None

    def configure(self, stop="length = 0.1\nwidth = 0.1\nhold = 0.0", device=None, voxel=0.2):
        with open(os.path.join(self.capture, "scree.toml")) as file:
            text = file.read()
        text = re.sub(r'device = ".*"', f'device = "{device or self.mti.port}"', text)
        text = text.replace('interface = "can0"', 'interface = "vcan0"')
        text = re.sub(r"max_range = .*", f"max_range = {REACH + 1}", text)
        lines = (
            f'[gpio]\npps = "{self.chip.name}:pps"\nstop = "rig:stop"\n'
            'heartbeat = "rig:2"\n'
        )
        with open(CONFIG, "w") as file:
            file.write(f"{text}{lines}[stop]\n{stop}\n[lcm]\ngrid = false\n[map]\n{MAP}voxel = {voxel}\n")

    def play(self):
        self.player = Player(self.capture, 2368, 8308, self.mti, self.can, loop=True)

    def silence(self):
        self.player.stop()

    def pulse(self, times):
        for _ in range(times):
            self.chip.pull("pps", "up")
            time.sleep(0.1)
            self.chip.pull("pps", "down")
            time.sleep(0.9)


def usb_adapter(plugged):
    """Unplugs the USB serial adapter, or plugs it in."""
    (port,) = subprocess.run(
        "grep -l IMU0 /sys/bus/usb/devices/*/serial", shell=True, capture_output=True, text=True
    ).stdout.split()
    with open(f"{os.path.dirname(port)}/authorized", "w") as file:
        file.write("1" if plugged else "0")
