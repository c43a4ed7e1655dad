"""Writes logs as lcm-logger does."""

import struct


def write_log(path, events):
    """Of (microseconds, channel, message), as the LCM documentation describes its log format."""
    with open(path, "wb") as file:
        for number, (stamp, channel, message) in enumerate(events):
            file.write(struct.pack(">IqqII", 0xEDA1DA01, number, stamp, len(channel), len(message)))
            file.write(channel.encode() + message)
