#!/usr/bin/env python3
"""Compares `scree decode --sensor encoder` with the independent decoder cantools (PyPI), bit for bit.

usage: compare_cantools.py SCREE [LOG.log DBC.dbc]

Random signals in random frames, classic and FD, described by configuration keys and by DBC files in
turn; some frames are too short for the signal and must give no line. Then each signal of the given
DBC file over the whole log.

Exit code 77: skipped, and why.
"""

import csv
import os
import random
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
try:
    import cantools
except ImportError as missing:
    print(f"skipped: {missing}; see tests/requirements.txt")
    sys.exit(SKIPPED)

LAYOUTS, FRAMES = 400, 6
SIZES = [1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64]
EXTENDED = 0x80000000


def last_byte(start, length, is_little):
    """The index of the last byte that the signal touches."""
    for _ in range(length - 1):
        start += 1 if is_little else (15 if start % 8 == 0 else -1)
    return start // 8


def random_layout(rng):
    """A signal somewhere in a frame of some size."""
    while True:
        size, is_little = rng.choice(SIZES), rng.random() < 0.5
        start, length = rng.randrange(8 * size), rng.randint(1, min(64, 8 * size))
        if last_byte(start, length, is_little) >= size:
            continue
        is_extended = rng.random() < 0.5
        frame_id = rng.randrange(0x800, 0x20000000) if is_extended else rng.randrange(0x800)
        return {
            "size": size, "start": start, "length": length, "is_little": is_little,
            "is_signed": rng.random() < 0.5, "id": frame_id, "is_extended": is_extended,
            "factor": rng.choice([1, 0.01, 0.5, -2, 1e-3]), "offset": rng.choice([0, 0, -40, 1.5]),
        }  # fmt: skip


def dbc_of(layout):
    order, sign = "1" if layout["is_little"] else "0", "-" if layout["is_signed"] else "+"
    frame_id = layout["id"] + (EXTENDED if layout["is_extended"] else 0)
    return (
        f'VERSION ""\n\nBU_: A\n\nBO_ {frame_id} Wheel: {layout["size"]} A\n SG_ Count : '
        f'{layout["start"]}|{layout["length"]}@{order}{sign} ({layout["factor"]:g},{layout["offset"]:g}) '
        f'[0|0] "" A\n'
    )


def settings_of(layout):
    """By keys, which know neither factor nor offset."""
    layout["factor"], layout["offset"] = 1, 0
    order = "little_endian" if layout["is_little"] else "big_endian"
    return (
        f'[encoder]\ncan_id = {layout["id"]}\nstart_bit = {layout["start"]}\n'
        f'length = {layout["length"]}\nbyte_order = "{order}"\nscale = 1\n'
        f'signed = {"true" if layout["is_signed"] else "false"}\n'
    )


def log_line(t_us, layout, data):
    name = f'{layout["id"]:08X}' if layout["is_extended"] else f'{layout["id"]:03X}'
    mark = "##1" if layout["size"] > 8 else "#"
    return f"({t_us // 1_000_000:010}.{t_us % 1_000_000:06}) can0 {name}{mark}{data.hex().upper()}\n"


def decoded(scree, folder):
    """(time in us, raw, value) of each line; nothing where Scree says that there is no signal."""
    out = os.path.join(folder, "out.csv")
    run = subprocess.run([scree, "decode", folder, "--sensor", "encoder", "--out", out, "--force"],
                         capture_output=True, text=True)  # fmt: skip
    assert run.returncode == 0 or "no signal" in run.stderr, run.stderr
    with open(out) as file:
        return [(int(row["t_ns"]) // 1000, int(row["raw"]), float(row["value"]))
                for row in csv.DictReader(file)]  # fmt: skip


def close(a, b):
    return abs(a - b) <= 1e-12 * max(abs(a), abs(b), 1e-3)


def compare(ours, theirs):
    assert [t for t, _, _ in ours] == [t for t, _, _ in theirs], "other frames were read"
    for (t_us, raw, value), (_, their_raw, their_value) in zip(ours, theirs):
        assert raw == their_raw, f"at {t_us} us: raw {raw}, cantools {their_raw}"
        assert close(value, their_value), f"at {t_us} us: {value}, cantools {their_value}"
    return len(ours)


def compare_layout(scree, folder, rng, by_dbc):
    layout = random_layout(rng)
    if by_dbc:
        settings = '[encoder]\ndbc = "robot.dbc"\nsignal = "Wheel.Count"\nscale = 1\n'
    else:
        settings = settings_of(layout)
    text = dbc_of(layout)
    with open(os.path.join(folder, "robot.dbc"), "w") as file:
        file.write(text)
    with open(os.path.join(folder, "scree.toml"), "w") as file:
        file.write(settings)
    message = cantools.database.load_string(text, "dbc").messages[0]
    needed = last_byte(layout["start"], layout["length"], layout["is_little"]) + 1
    theirs = []
    with open(os.path.join(folder, "can.log"), "w") as log:
        for i in range(FRAMES):
            t_us, data = 1_000_000 * (i + 1) + 7, rng.randbytes(layout["size"])
            if i == FRAMES - 1:
                data = data[: rng.randint(0, needed - 1)]
            else:
                raw = message.decode(data, scaling=False)["Count"]
                theirs.append((t_us, raw, float(message.decode(data)["Count"])))
            log.write(log_line(t_us, layout, data))
    try:
        return compare(decoded(scree, folder), theirs)
    except AssertionError as difference:
        raise AssertionError(f"{difference}\n{settings}\n{text}") from None


def compare_recording(scree, folder, log, dbc):
    """Each signal of the file that is a speed."""
    database, compared = cantools.database.load_file(dbc), 0
    with open(log) as file:
        lines = [re.match(r"\((\d+)\.(\d{6})\) \S+ ([0-9A-F]+)#([0-9A-F]*)$", line) for line in file]
    for name in ("can.log", "robot.dbc"):
        if not os.path.lexists(os.path.join(folder, name)):
            os.symlink(os.path.abspath(log if name == "can.log" else dbc), os.path.join(folder, name))
    for message in database.messages:
        for signal in message.signals:
            if signal.unit != "kph":
                continue
            theirs = []
            for seconds, micros, frame_id, data in (line.groups() for line in lines if line):
                if int(frame_id, 16) != message.frame_id:
                    continue
                data = bytes.fromhex(data)
                theirs.append((int(seconds) * 1_000_000 + int(micros),
                               message.decode(data, scaling=False)[signal.name],
                               float(message.decode(data)[signal.name]) * 0.25))  # fmt: skip
            with open(os.path.join(folder, "scree.toml"), "w") as file:
                file.write(f'[encoder]\ndbc = "robot.dbc"\nsignal = "{message.name}.{signal.name}"\n'
                           f'kind = "speed"\nscale = 0.25\n')  # fmt: skip
            compared += compare(decoded(scree, folder), theirs)
            print(f"{message.name}.{signal.name}: {len(theirs)} frames of the log agree")
    return compared


def main():
    scree, recording = sys.argv[1], sys.argv[2:]
    rng = random.Random(1)
    try:
        with tempfile.TemporaryDirectory() as folder:
            values = sum(compare_layout(scree, folder, rng, i % 2 == 1) for i in range(LAYOUTS))
            print(f"{LAYOUTS} random layouts with {values} values agree")
        assert values == LAYOUTS * (FRAMES - 1), values
        if all(os.path.exists(file) for file in recording) and recording:
            with tempfile.TemporaryDirectory() as folder:
                assert compare_recording(scree, folder, *recording) > 0, "nothing was compared"
        else:
            print("the recording of a car is not there to compare on")
    except AssertionError as difference:
        print(f"failed: {difference}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
