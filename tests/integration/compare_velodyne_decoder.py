#!/usr/bin/env python3
"""Compares `scree decode` with the independent decoder velodyne-decoder (PyPI), point by point.

usage: compare_velodyne_decoder.py SCREE CAPTURE.pcap...

Every return is compared: packet, laser, reflectivity, time within the packet, x, y, z.
What velodyne-decoder 3.1.0 does in its own way, found by reading and by experiment:

- Frame: x forward at azimuth 0, y left, z up, as here. Its ring counts lasers from the lowest
  upwards; here a channel is the laser id.
- Vertical correction: the manual's lens distance of 41.91 mm times the tangent of the elevation; the
  manual's table, used here, is the same rounded to 0.1 mm. z may differ by 0.05 mm.
- Azimuth between blocks: it turns every shot by the packet's mean step a block and rounds to
  0.01 degrees; here each block turns towards the next one, as the manual says. From the azimuths
  on the wire the difference is known exactly, and it is taken off before comparing; what remains is
  its rounding, half of 0.01 degrees.
- Dual returns: of two equal returns of a shot it lists one. `scree decode` lists what is on the wire,
  so equal ones are joined here.
- It leaves out ranges under 0.1 m unless told otherwise, and product byte 0x21 is an HDL-32E to it:
  the byte is set to a VLP-16's where Scree accepts the packets.

Exit code 77: skipped, and why.
"""

import subprocess
import sys
import tempfile

SKIPPED = 77
try:
    import dpkt
    import numpy as np
    import velodyne_decoder as vd
except ImportError as missing:
    print(f"skipped: {missing}; see tests/requirements.txt")
    sys.exit(SKIPPED)

DATA_PORT, PACKET_SIZE, BLOCKS, DUAL = 2368, 1206, 12, 0x39
BLOCK_SECONDS = 110.592e-6
ROUNDING_DEG = 0.005 + 0.0008  # its rounding to 0.01 degrees, and single precision
CORRECTION_M = 0.00005 + 0.000015  # the table's rounding to 0.1 mm, and single precision
MODELS = {0x21: "VLP16", 0x22: "VLP16", 0x24: "PuckHiRes"}
CSV = np.dtype(
    [("t_ns", "i8"), ("packet", "i8"), ("block", "i4"), ("channel", "i4"), ("azimuth_deg", "f8"),
     ("range_m", "f8"), ("reflectivity", "f8"), ("x", "f8"), ("y", "f8"), ("z", "f8")])
POINT = np.dtype(
    [("packet", "i8"), ("ring", "i4"), ("seconds", "f8"), ("horizontal", "f8"), ("azimuth_deg", "f8"),
     ("z", "f8"), ("reflectivity", "f8")])


def wrapped(degrees):
    return (degrees + 180.0) % 360.0 - 180.0


def data_packets(capture):
    """(arrival in seconds, bytes) of the data packets, without repeated ones."""
    last_stamp = None
    with open(capture, "rb") as file:
        for arrival, frame in dpkt.pcap.Reader(file):
            ip = dpkt.ethernet.Ethernet(frame).data
            udp = getattr(ip, "data", None)
            if not isinstance(udp, dpkt.udp.UDP) or udp.dport != DATA_PORT:
                continue
            data = bytearray(udp.data)
            if len(data) == PACKET_SIZE and data[1200:1204] != last_stamp:
                last_stamp = data[1200:1204]
                yield float(arrival), data


def wire_steps(packet):
    """For each block (with dual returns: pair): the step to the next, and the packet's mean step."""
    stride = 2 if packet[1204] == DUAL else 1
    raw = [int.from_bytes(packet[100 * i + 2:100 * i + 4], "little") for i in range(0, BLOCKS, stride)]
    azimuth = np.array(raw) % 36000 / 100.0
    step = np.diff(azimuth) % 360.0
    return np.append(step, step[-1]), step.sum() / len(step)


def reference_points(packets, model):
    """What velodyne-decoder reads, one packet at a time, its azimuth as the manual has it."""
    config = vd.Config(model=getattr(vd.Model, model))
    config.min_range, config.max_range = 0.0, 1000.0
    decoder = vd.ScanDecoder(config)
    parts = []
    for index, (arrival, data) in enumerate(packets):
        steps, mean = wire_steps(data)
        data[1205] = 0x24 if model == "PuckHiRes" else 0x22
        one = vd.PacketVector()
        one.append(vd.VelodynePacket(arrival, list(data)))
        _, values = decoder.decode(one)
        part = np.zeros(len(values), POINT)
        part["packet"], part["ring"], part["reflectivity"] = index, values[:, 6], values[:, 3]
        part["seconds"], part["z"] = values[:, 4], values[:, 2]
        x, y = values[:, 0].astype(float), values[:, 1].astype(float)
        part["horizontal"] = np.hypot(x, y)
        blocks = (part["seconds"] + 1e-9) / BLOCK_SECONDS  # its times are single precision
        block = blocks.astype(int)
        known_difference = (blocks - block) * (steps[block] - mean)
        part["azimuth_deg"] = np.degrees(np.arctan2(-y, x)) + known_difference
        parts.append(part)
    return np.concatenate(parts)


def our_points(scree, capture, model, folder):
    """What `scree decode` lists, or None where it accepts no packet."""
    config, out = f"{folder}/scree.toml", f"{folder}/out.csv"
    with open(config, "w") as file:
        file.write(f'[lidar]\nmodel = "{"puck_hires" if model == "PuckHiRes" else "vlp16"}"\n')
    run = subprocess.run(
        [scree, "decode", capture, "--sensor", "lidar", "--out", out, "--config", config],
        stderr=subprocess.PIPE, text=True)
    if run.returncode != 0:
        print(f"{capture}: not compared, Scree refuses it ({run.stderr.strip()})")
        return None
    rows = np.loadtxt(out, dtype=CSV, delimiter=",", skiprows=1)
    points = np.zeros(len(rows), POINT)
    for name in ("packet", "z", "reflectivity"):
        points[name] = rows[name]
    points["ring"] = np.where(rows["channel"] % 2 == 0, rows["channel"] // 2, 8 + rows["channel"] // 2)
    points["horizontal"] = np.hypot(rows["x"], rows["y"])
    points["azimuth_deg"] = np.degrees(np.arctan2(-rows["y"], rows["x"]))
    first = np.full(rows["packet"].max() + 1, np.iinfo("i8").max)
    np.minimum.at(first, rows["packet"], rows["t_ns"])
    points["seconds"] = (rows["t_ns"] - first[rows["packet"]]) * 1e-9
    return np.unique(points) if any_dual(rows) else points


def any_dual(rows):
    """Whether two returns share a laser and a time."""
    keys = rows[["t_ns", "channel"]]
    return len(np.unique(keys)) < len(keys)


def in_order(points):
    """By packet, time and laser; two returns of a shot by distance."""
    return points[np.lexsort((points["horizontal"], points["ring"],
                              np.round(points["seconds"] * 1e9), points["packet"]))]


def compare(scree, capture):
    """The number of points compared, or None; raises AssertionError where they differ."""
    packets = list(data_packets(capture))
    model = MODELS.get(packets[0][1][1205], "VLP16") if packets else "VLP16"
    with tempfile.TemporaryDirectory() as folder:
        ours = our_points(scree, capture, model, folder)
    if ours is None:
        return None
    theirs = reference_points(packets, model)
    first = np.full(len(packets), np.inf)
    np.minimum.at(first, theirs["packet"], theirs["seconds"])
    theirs["seconds"] -= first[theirs["packet"]]
    ours, theirs = in_order(ours), in_order(theirs)

    assert len(ours) == len(theirs), f"{len(ours)} points, not {len(theirs)}"
    for name in ("packet", "ring", "reflectivity"):
        assert (ours[name] == theirs[name]).all(), f"{name} differs"
    worst = {
        "seconds": (np.abs(ours["seconds"] - theirs["seconds"]).max(), 1e-9),
        "azimuth_deg": (np.abs(wrapped(ours["azimuth_deg"] - theirs["azimuth_deg"])).max(), ROUNDING_DEG),
        "horizontal": (np.abs(ours["horizontal"] - theirs["horizontal"]).max(), 2e-5),
        "z": (np.abs(ours["z"] - theirs["z"]).max(), CORRECTION_M),
    }
    print(f"{capture}: {len(ours)} points agree; largest differences: "
          + ", ".join(f"{name} {value:.3g}" for name, (value, _) in worst.items()))
    for name, (value, tolerance) in worst.items():
        assert value <= tolerance, f"{name} differs by {value:.3g}, more than {tolerance:.3g}"
    return len(ours)


def main():
    scree, captures = sys.argv[1], sys.argv[2:]
    if not captures:
        print("skipped: no recordings to compare on")
        return SKIPPED
    results, failed = [], False
    for capture in captures:
        try:
            results.append(compare(scree, capture))
        except AssertionError as difference:
            print(f"{capture}: {difference}")
            failed = True
    if not failed and not any(results):
        print("failed: nothing was compared")
        failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
