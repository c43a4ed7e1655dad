"""A capture's sensors, live, with whatever may be wrong between them and the daemon."""

import os
import random
import socket
import struct
import threading
import time

from live_sensors import Player
from pcap_file import pcap_records

DATA_PACKET = 1206
TIMESTAMP = 1200  # where a data packet has its time stamp, microseconds past the hour
HOUR_US = 3_600_000_000


def stamp_of(packet):
    return struct.unpack_from("<I", packet, TIMESTAMP)[0]


def first_stamp(capture):
    payloads = (frame[42:] for _, frame in pcap_records(capture))
    return next(stamp_of(data) for data in payloads if len(data) == DATA_PACKET)


class FaultyPlayer(Player):
    """`full_hour`: how many seconds after its start the lidar's stamps pass the full hour; without
    it they are the capture's."""

    def __init__(self, capture, port, position_port, mti, full_hour=None, loop=False):
        self.random = random.Random(45)
        self.loss = self.disorder = self.doubles = 0  # shares of the lidar's packets
        self.lidar_cut = self.imu_cut = self.lidar_is_garbage = self.imu_is_garbage = False
        self.stamp_shift_us = 0
        if full_hour is not None:
            first = first_stamp(os.path.join(capture, "lidar.pcap"))
            self.stamp_shift_us = HOUR_US - round(full_hour * 1e6) - first
        self.held = None  # packets that a network keeps back
        self.overtaken = []  # packets on a longer way, and how many are still to overtake each
        super().__init__(capture, port, position_port, mti, loop=loop)

    def send_lidar(self, data, to):
        if self.lidar_cut or self.random.random() < self.loss:
            return
        if len(data) == DATA_PACKET:
            stamp = (stamp_of(data) + self.stamp_shift_us) % HOUR_US
            data = data[:TIMESTAMP] + struct.pack("<I", stamp) + data[TIMESTAMP + 4 :]
        if self.lidar_is_garbage:
            data = self.random.randbytes(len(data))
        if self.held is not None:
            self.held.append((data, to))
        elif self.random.random() < self.disorder:
            self.overtaken.append([3, data, to])
        else:
            self.udp.sendto(data, to)
            if self.random.random() < self.doubles:
                self.udp.sendto(data, to)
            self._let_overtaken_go()

    def _let_overtaken_go(self):
        for packet in list(self.overtaken):
            packet[0] -= 1
            if packet[0] == 0:
                self.overtaken.remove(packet)
                self.udp.sendto(*packet[1:])

    def release(self):
        """What was held comes at once."""
        held, self.held = self.held, None
        for data, to in held:
            self.udp.sendto(data, to)

    def send_imu(self, data):
        if not self.imu_cut:
            super().send_imu(self.random.randbytes(len(data)) if self.imu_is_garbage else data)


class Flood:
    """Datagrams of somebody else to the lidar's port, as fast as 2000 a second."""

    def __init__(self, port, size):
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._send, args=[port, size], daemon=True)
        self.thread.start()

    def _send(self, port, size):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.bind(("127.0.0.2", 0))
            while not self.stopped.is_set():
                sender.sendto(os.urandom(size), ("127.0.0.1", port))
                time.sleep(0.0005)

    def stop(self):
        self.stopped.set()
        self.thread.join()
