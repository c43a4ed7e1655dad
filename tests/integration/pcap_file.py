"""Captures of nanoseconds as pcap files, written from the format's description alone."""

import struct

MAGIC = 0xA1B23C4D  # of nanoseconds, in this computer's byte order
ETHERNET, SERIAL = 1, 147  # link types; 147 is for private use, here the reads of a serial port


def pcap_records(path, link_type=None):
    """(nanoseconds, bytes) of each record; the link type is checked where one is given."""
    with open(path, "rb") as file:
        data = file.read()
    assert struct.unpack_from("<I", data)[0] == MAGIC, path
    assert link_type in (None, struct.unpack_from("<I", data, 20)[0]), path
    at = 24
    while at + 16 <= len(data):
        seconds, nanoseconds, size, _ = struct.unpack_from("<IIII", data, at)
        yield seconds * 10**9 + nanoseconds, data[at + 16 : at + 16 + size]
        at += 16 + size


def write_pcap(path, records, link_type=ETHERNET):
    """The records are pairs as pcap_records gives them."""
    with open(path, "wb") as file:
        file.write(struct.pack("<IHHiIII", MAGIC, 2, 4, 0, 0, 65535, link_type))
        for time_ns, data in records:
            file.write(struct.pack("<IIII", *divmod(time_ns, 10**9), len(data), len(data)) + data)
