"""The sensors of a capture, live: a lidar over UDP, an MTi on a pseudo-terminal, an encoder on a
virtual CAN bus. Written from the formats' descriptions alone."""

import os
import re
import select
import socket
import struct
import threading
import time

from pcap_file import pcap_records


def xbus_message(message_id, data):
    """A message of an Xsens device (MT0101P, "Xbus message"): preamble, bus identifier, checksum."""
    body = bytes([0xFF, message_id, len(data)]) + data
    return b"\xfa" + body + bytes([-sum(body) % 256])


class EmulatedMti:
    """The device's side of an MTi's start (MT0101P, "States"), on a port of that name. What it is
    given to send goes out while it measures."""

    def __init__(self, port):
        self.port = port
        self.measures = threading.Event()
        self.master = None
        self.lock = threading.Lock()

    def plug_in(self):
        self.master, slave = os.openpty()
        os.symlink(os.ttyname(slave), self.port)
        os.close(slave)
        self.answers = threading.Thread(target=self._answer, daemon=True)
        self.answers.start()

    def unplug(self):
        with self.lock:
            self.measures.clear()
            os.remove(self.port)
            os.close(self.master)
            self.master = None
        self.answers.join()

    def send(self, data):
        with self.lock:
            if self.measures.is_set():
                try:
                    os.write(self.master, data)
                except OSError:  # nobody has the port open
                    self.measures.clear()

    def _answer(self):
        heard = b""
        while True:
            time.sleep(0.005)
            with self.lock:
                if self.master is None:
                    return
                if not select.select([self.master], [], [], 0)[0]:
                    continue
                try:
                    heard = self._respond(heard + os.read(self.master, 4096))
                except OSError:  # nobody has the port open
                    self.measures.clear()

    def _respond(self, heard):
        """Answers all whole messages; gives what is left."""
        while (match := re.search(rb"\xfa\xff(.)(.)", heard, re.S)) is not None:
            end = match.end() + match[2][0] + 1
            if len(heard) < end:
                break
            request, data = match[1][0], heard[match.end() : end - 1]
            heard = heard[end:]
            if request == 0x30:  # GoToConfig
                self.measures.clear()
            answer = {0x00: b"\x07\x71\x23\x45", 0xC0: data}.get(request, b"")
            os.write(self.master, xbus_message(request + 1, answer))
            if request == 0x10:  # GoToMeasurement
                self.measures.set()
        return heard


def can_frames(path):
    """(nanoseconds, frame as a SocketCAN socket takes it) of a candump log of classic frames."""
    with open(path) as file:
        for line in file:
            stamp, identifier, data = re.match(r"\((.*?)\) \S+ (.*)#(.*)\s", line).groups()
            number = int(identifier, 16) | (0x80000000 if len(identifier) == 8 else 0)
            payload = bytes.fromhex(data)
            yield round(float(stamp) * 1e6) * 1000, struct.pack("<IB3x8s", number, len(payload), payload)


def can_socket(interface):
    """A socket on that interface; None, and why, where there is none."""
    try:
        bus = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        bus.bind((interface,))
        return bus, ""
    except OSError as error:
        return None, f"no CAN interface {interface} on this machine: {error}"


class Player:
    """Plays the files of a capture to ports of this computer, in real time and in time with one
    another; again and again with loop. `later_ns` is how much later than recorded."""

    def __init__(self, capture, port, position_port, mti, can=None, loop=False):
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        ports = {2368: port, 8308: position_port}
        events = []
        for stamp, frame in pcap_records(os.path.join(capture, "lidar.pcap")):
            to = ("127.0.0.1", ports[struct.unpack_from(">H", frame, 36)[0]])
            events.append((stamp, lambda data=frame[42:], to=to: self.send_lidar(data, to)))
        for stamp, data in pcap_records(os.path.join(capture, "imu.pcap")):
            events.append((stamp, lambda data=data: self.send_imu(data)))
        if can is not None:
            for stamp, frame in can_frames(os.path.join(capture, "can.log")):
                events.append((stamp, lambda frame=frame: can.send(frame)))
        self.events = sorted(events, key=lambda event: event[0])
        self.mti, self.loop = mti, loop
        self.late = 0  # seconds by which all is held up on its way
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._play, daemon=True)
        self.thread.start()

    def send_lidar(self, data, to):
        self.udp.sendto(data, to)

    def send_imu(self, data):
        self.mti.send(data)

    def wait(self):
        self.thread.join()

    def stop(self):
        self.stopped.set()
        self.thread.join()
        self.udp.close()

    def _play(self):
        while True:
            start, first = time.monotonic(), self.events[0][0]
            self.later_ns = time.time_ns() - first
            for stamp, send in self.events:
                early = start + self.late + (stamp - first) * 1e-9 - time.monotonic()
                if early > 0:
                    time.sleep(early)
                if self.stopped.is_set():
                    return
                send()
                self.last_sent = time.monotonic()
            if not self.loop:
                return
