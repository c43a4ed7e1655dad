"""A lidar.pcap of a VLP-16 on flat ground, just enough for the daemon to see packets and sweeps."""

import math
import struct

from pcap_file import write_pcap

ELEVATIONS_DEG = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]
PACKET_NS = 1_327_104
SENSOR_HEIGHT_M = 0.95
TURNS_PER_SECOND = 10


def data_packet(number):
    """The data packet that the sensor sends as its `number`-th."""
    returns = b""
    for elevation in ELEVATIONS_DEG:
        metres = SENSOR_HEIGHT_M / math.sin(math.radians(-elevation)) if elevation < 0 else 0
        returns += struct.pack("<HB", round(metres * 500), 40)
    step = PACKET_NS * 1e-9 / 12 * TURNS_PER_SECOND * 36000
    blocks = b"".join(
        struct.pack("<HH", 0xEEFF, round((number * 12 + block) * step) % 36000) + 2 * returns
        for block in range(12)
    )
    return blocks + struct.pack("<IBB", number * PACKET_NS // 1000, 0x37, 0x22)


def position_packet(number):
    return bytes(198) + struct.pack("<I", number * PACKET_NS // 1000) + bytes(310)


def frame(payload, port):
    """The Ethernet frame of a datagram, broadcast as the sensor does it."""
    udp = struct.pack(">HHHH", port, port, 8 + len(payload), 0) + payload
    ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp), 0, 0, 64, 17, 0,
                     bytes([192, 168, 1, 201]), b"\xff" * 4)  # fmt: skip
    return b"\xff" * 6 + bytes(6) + b"\x08\x00" + ip + udp


def records(seconds):
    for number in range(int(seconds * 1e9 / PACKET_NS)):
        time_ns = 1_598_601_600 * 1_000_000_000 + number * PACKET_NS
        yield time_ns, frame(data_packet(number), 2368)
        if number % 10 == 0:
            yield time_ns, frame(position_packet(number), 8308)


def write_capture(path, seconds):
    write_pcap(path, records(seconds))
