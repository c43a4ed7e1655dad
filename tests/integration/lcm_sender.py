"""Sends messages of Scree's own types on LCM, again and again: what screed does, without it. Written
from LCM's description of its UDP protocol alone."""

import re
import socket
import struct
import threading


class Sender:
    """@param messages by channel: each is sent every 100 ms until stop()"""

    def __init__(self, url, messages):
        group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
        self.to = (group, int(port))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.messages = messages
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._send, daemon=True)
        self.thread.start()

    def stop(self):
        self.stopped.set()
        self.thread.join()
        self.socket.close()

    def _send(self):
        number = 0
        while not self.stopped.wait(0.1):
            for channel, message in self.messages.items():
                short = struct.pack(">II", 0x4C433032, number) + channel.encode() + b"\0"
                self.socket.sendto(short + message.encode(), self.to)
                number += 1
