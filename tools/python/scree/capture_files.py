"""Writes the files of a capture: lidar.pcap, imu.pcap, can.log. Their formats are those of tools/README."""

from __future__ import annotations

import struct
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

LINKTYPE_ETHERNET, LINKTYPE_USER0 = 1, 147
DATA_PORT = 2368
LIDAR, HOST = bytes([192, 168, 1, 201]), bytes([255, 255, 255, 255])


class PcapWriter:
    """A pcap file with nanoseconds."""

    def __init__(self, file: Path, link_type: int) -> None:
        self._file: BinaryIO = file.open("wb")
        self._file.write(struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 262144, link_type))

    def __enter__(self) -> PcapWriter:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._file.close()

    def write(self, time_ns: int, data: bytes) -> None:
        head = struct.pack("<IIII", time_ns // 1_000_000_000, time_ns % 1_000_000_000, len(data), len(data))
        self._file.write(head + data)


def lidar_frame(payload: bytes, port: int = DATA_PORT) -> bytes:
    """The payload as an Ethernet frame with IPv4 and UDP, as a Velodyne sends it."""
    udp = struct.pack(">HHHH", port, port, 8 + len(payload), 0)
    ip = bytearray(
        struct.pack(
            ">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp) + len(payload), 0, 0x4000, 255, 17, 0, LIDAR, HOST
        )
    )
    words = sum(struct.unpack(">10H", ip))
    words = (words & 0xFFFF) + (words >> 16)
    struct.pack_into(">H", ip, 10, ~(words + (words >> 16)) & 0xFFFF)
    return bytes.fromhex("ffffffffffff60768820f5b40800") + bytes(ip) + udp + payload


def xsens_message(
    counter: int,
    time_ns: int,
    orientation: tuple[float, float, float, float] | None,
    rate: tuple[float, float, float],
    acceleration: tuple[float, float, float],
) -> bytes:
    """MTData2 as an Xsens MTi sends it (MT0101P): doubles, orientation w x y z in east-north-up."""
    data = struct.pack(">HBH", 0x1020, 2, counter & 0xFFFF)
    data += struct.pack(">HBI", 0x1060, 4, time_ns // 100_000 & 0xFFFFFFFF)
    if orientation is not None:
        data += struct.pack(">HB4d", 0x2013, 32, *orientation)
    data += struct.pack(">HB3d", 0x4023, 24, *acceleration)
    data += struct.pack(">HB3d", 0x8023, 24, *rate)
    body = bytes([0xFF, 0x36, len(data)]) + data
    return b"\xfa" + body + bytes([-sum(body) & 0xFF])


def can_line(time_ns: int, interface: str, can_id: int, data: bytes) -> str:
    """As `candump -L` writes it."""
    seconds, micros = time_ns // 1_000_000_000, time_ns % 1_000_000_000 // 1000
    return f"({seconds}.{micros:06d}) {interface} {can_id:03X}#{data.hex().upper()}\n"
