"""Bags are made of a simulated capture and imported again: what comes out must decode as what went in."""

import csv
import io
import json
import struct
import subprocess
import tomllib
from math import cos, pi, sin
from types import SimpleNamespace

import numpy as np
import pytest

from scree.commands import main

pytest.importorskip("rosbags")
from rosbags import rosbag1, rosbag2  # noqa: E402
from rosbags.typesys import Stores, get_types_from_msg, get_typestore  # noqa: E402

from scree.bag_import import _PACKET, _SCAN, PACKET_NS, packets_of  # noqa: E402

IMU, ODOMETRY, TF = "sensor_msgs/msg/Imu", "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
SCAN = "velodyne_msgs/msg/VelodyneScan"
A_SCAN = 76  # packets


def frames_of(pcap):
    """Times and UDP payloads of a pcap with nanoseconds or microseconds."""
    data = pcap.read_bytes()
    scale = 1 if struct.unpack_from("<I", data)[0] == 0xA1B23C4D else 1000
    at = 24
    while at < len(data):
        seconds, part, size, _ = struct.unpack_from("<IIII", data, at)
        yield seconds * 10**9 + part * scale, data[at + 16 + 42 : at + 16 + size]
        at += 16 + size


class Bag:
    """The messages of a capture in a typestore of ROS 1 or ROS 2."""

    def __init__(self, capture, program, is_1):
        self.store = get_typestore(Stores.ROS1_NOETIC if is_1 else Stores.ROS2_HUMBLE)
        time = "time" if is_1 else "builtin_interfaces/Time"
        self.store.register(
            get_types_from_msg(
                _PACKET.replace("builtin_interfaces/Time", time), "velodyne_msgs/msg/VelodynePacket"
            )
        )
        self.store.register(get_types_from_msg(_SCAN, SCAN))
        if is_1:
            self.store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", TF))
        self.is_1, self.types = is_1, self.store.types
        rows = subprocess.run(
            [program, "decode", capture, "--sensor", "imu"], capture_output=True, text=True, check=True
        )
        self.imu_rows = list(csv.DictReader(io.StringIO(rows.stdout)))
        self.packets = [frame for frame in frames_of(capture / "lidar.pcap") if len(frame[1]) == 1206]

    def header(self, time_ns, frame):
        stamp = self.types["builtin_interfaces/msg/Time"](time_ns // 10**9, time_ns % 10**9)
        more = {"seq": 0} if self.is_1 else {}
        return self.types["std_msgs/msg/Header"](**more, stamp=stamp, frame_id=frame)

    def vector(self, x, y, z):
        return self.types["geometry_msgs/msg/Vector3"](x, y, z)

    def scans(self):
        for i in range(0, len(self.packets), A_SCAN):
            part = self.packets[i : i + A_SCAN]
            packets = [
                self.types["velodyne_msgs/msg/VelodynePacket"](
                    self.header(t, "").stamp, np.frombuffer(data, np.uint8)
                )
                for t, data in part
            ]
            yield (
                "/velodyne_packets",
                SCAN,
                part[-1][0],
                self.types[SCAN](self.header(part[-1][0], "velodyne"), packets),
            )

    def imu(self):
        for row in self.imu_rows:
            v = {key: float(value or 0) for key, value in row.items()}
            turned = self.types["geometry_msgs/msg/Quaternion"](v["qx"], v["qy"], v["qz"], v["qw"])
            time_ns, none = int(row["t_ns"]), np.zeros(9)
            yield (
                "/imu/data",
                IMU,
                time_ns,
                self.types[IMU](
                    self.header(time_ns, "imu_link"),
                    turned,
                    none,
                    self.vector(v["wx"], v["wy"], v["wz"]),
                    none,
                    self.vector(v["ax"], v["ay"], v["az"]),
                    none,
                ),
            )

    def odometry(self):
        types = self.types
        for n in range(100):
            time_ns, none = self.packets[0][0] + n * 20_000_000, np.zeros(36)
            place = types["geometry_msgs/msg/Pose"](
                types["geometry_msgs/msg/Point"](0.0, 0.0, 0.0),
                types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0),
            )
            twist = types["geometry_msgs/msg/Twist"](
                self.vector(0.01 * n - 0.3, 0.0, 0.0), self.vector(0.0, 0.0, 0.0)
            )
            yield (
                "/odom",
                ODOMETRY,
                time_ns,
                types[ODOMETRY](
                    self.header(time_ns, "odom"),
                    "base_link",
                    types["geometry_msgs/msg/PoseWithCovariance"](place, none),
                    types["geometry_msgs/msg/TwistWithCovariance"](twist, none),
                ),
            )

    def transforms(self):
        def of(parent, child, place, q):
            transform = self.types["geometry_msgs/msg/Transform"](
                self.vector(*place), self.types["geometry_msgs/msg/Quaternion"](*q)
            )
            return self.types["geometry_msgs/msg/TransformStamped"](self.header(0, parent), child, transform)

        half = 0.5**0.5
        chain = [
            of("base_link", "mast", (0.5, 0.0, 0.3), (0.0, 0.0, half, half)),  # a quarter turn to the left
            of("mast", "velodyne", (0.2, 0.0, 0.6), (0.0, sin(pi / 12), 0.0, cos(pi / 12))),
        ]
        yield "/tf_static", TF, self.packets[0][0], self.types[TF](chain)

    def messages(self, *parts):
        return sorted((it for part in parts for it in part()), key=lambda it: it[2])

    def write(self, path, messages, storage=None):
        writer = (
            rosbag1.Writer(path) if self.is_1 else rosbag2.Writer(path, version=9, storage_plugin=storage)
        )
        serialize = self.store.serialize_ros1 if self.is_1 else self.store.serialize_cdr
        with writer:
            connections = {}
            for topic, kind, time_ns, message in messages:
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, kind, typestore=self.store)
                writer.write(connections[topic], time_ns, serialize(message, kind))
        return path


def decoded(program, capture, sensor):
    done = subprocess.run(
        [program, "decode", capture, "--sensor", sensor], capture_output=True, text=True, check=True
    )
    return list(csv.DictReader(io.StringIO(done.stdout)))


@pytest.mark.parametrize("kind", ["ros1", "sqlite3", "mcap"])
def test_what_a_bag_holds_decodes_as_it_was_recorded(kind, capture, scree_program, tmp_path):
    bag = Bag(capture, scree_program, kind == "ros1")
    storage = {"sqlite3": rosbag2.StoragePlugin.SQLITE3, "mcap": rosbag2.StoragePlugin.MCAP}.get(kind)
    path = bag.write(
        tmp_path / ("drive.bag" if kind == "ros1" else "drive"),
        bag.messages(bag.scans, bag.imu, bag.odometry, bag.transforms),
        storage,
    )
    if kind == "mcap":
        (path,) = path.glob("*.mcap")  # the file alone is enough
    made = tmp_path / "made"
    assert main(["import", str(path), str(made)]) == 0

    assert [data for _, data in frames_of(made / "lidar.pcap")] == [data for _, data in bag.packets]
    assert [t for t, _ in frames_of(made / "lidar.pcap")] == [t for t, _ in bag.packets]
    was, became = bag.imu_rows, decoded(scree_program, made, "imu")
    assert len(became) == len(was)
    for name in ("qw", "qx", "qy", "qz", "wx", "wy", "wz", "ax", "ay", "az"):
        assert [float(row[name]) for row in became] == pytest.approx(
            [float(row[name]) for row in was], abs=1e-6
        )
    speeds = [float(row["value"]) for row in decoded(scree_program, made, "encoder")]
    assert speeds == pytest.approx([0.01 * n - 0.3 for n in range(100)], abs=1e-4)
    lidar = tomllib.loads((made / "scree.toml").read_text())["lidar"]
    assert lidar["translation"] == pytest.approx([0.5, 0.2, 0.9])
    assert lidar["rpy_deg"] == pytest.approx([0, 30, 90])
    info = subprocess.run([scree_program, "info", made, "--json"], capture_output=True, text=True, check=True)
    assert json.loads(info.stdout)["packets"] == len(bag.packets)


def test_times_of_another_clock_are_laid_before_the_arrival(capture, scree_program, tmp_path):
    bag = Bag(capture, scree_program, False)
    messages = bag.messages(bag.scans)
    for _, _, _, message in messages:
        for packet in message.packets:
            packet.stamp.sec -= 1000
    path = bag.write(tmp_path / "drive", messages, rosbag2.StoragePlugin.SQLITE3)
    assert main(["import", str(path), str(tmp_path / "made")]) == 0
    times = np.array([t for t, _ in frames_of(tmp_path / "made" / "lidar.pcap")])
    assert np.abs(times - np.array([t for t, _ in bag.packets])).max() < 30_000_000
    assert (np.diff(times) > 0).all()


@pytest.mark.parametrize(("mode", "step"), [(0x37, PACKET_NS), (0x38, PACKET_NS), (0x39, 663_552)])
def test_packets_of_two_returns_come_twice_as_often(mode, step):
    packet = SimpleNamespace(stamp=SimpleNamespace(sec=0, nanosec=0), data=bytes(1204) + bytes([mode, 0x22]))
    times = [t for t, _ in packets_of(SimpleNamespace(packets=[packet] * 151), 10**18)]
    assert times == [10**18 - n * step for n in reversed(range(151))]


def test_a_topic_of_another_type_is_refused_and_leaves_nothing(capture, scree_program, tmp_path, capsys):
    bag = Bag(capture, scree_program, False)
    messages = bag.messages(bag.scans, bag.imu, bag.odometry)
    path = bag.write(tmp_path / "drive", messages, rosbag2.StoragePlugin.SQLITE3)
    made = tmp_path / "made"
    for option, topic in (("--packets", "/imu/data"), ("--imu", "/odom"), ("--odometry", "/imu/data")):
        assert main(["import", str(path), str(made), option, topic]) == 1
        assert f"topic {topic} is " in capsys.readouterr().err
        assert not made.exists()
    (made / ".new").mkdir(parents=True)  # of one that was killed
    assert main(["import", str(path), str(made), "--odometry", "/odom"]) == 0
    assert sorted(it.name for it in made.iterdir()) == ["can.log", "imu.pcap", "lidar.pcap", "scree.toml"]


@pytest.mark.parametrize("metadata", [None, b"", b"[", b"a: 1", b"\xff"])
def test_a_broken_folder_is_one_sentence(metadata, tmp_path, capsys):
    bag = tmp_path / "bag"
    bag.mkdir()
    if metadata is not None:
        (bag / "metadata.yaml").write_bytes(metadata)
    assert main(["import", str(bag), str(tmp_path / "made")]) == 1
    (said,) = capsys.readouterr().err.splitlines()
    assert str(bag) in said
    assert metadata is not None or "no metadata.yaml" in said


def test_what_is_missing_is_said(capture, scree_program, tmp_path, capsys):
    bag = Bag(capture, scree_program, False)
    lidar = bag.write(tmp_path / "lidar", bag.messages(bag.scans), rosbag2.StoragePlugin.SQLITE3)
    assert main(["import", str(lidar), str(tmp_path / "made")]) == 0
    assert "set lidar.translation" in capsys.readouterr().err
    assert not (tmp_path / "made" / "can.log").exists()
    assert main(["import", str(lidar), str(tmp_path / "made")]) == 1
    assert "is not empty" in capsys.readouterr().err
    imu = bag.write(tmp_path / "imu", bag.messages(bag.imu), rosbag2.StoragePlugin.SQLITE3)
    assert main(["import", str(imu), str(tmp_path / "none")]) == 1
    assert "no raw packets" in capsys.readouterr().err
    two = bag.write(
        tmp_path / "two",
        [*bag.messages(bag.scans), *((t + "2", *rest) for t, *rest in bag.messages(bag.scans))],
        rosbag2.StoragePlugin.SQLITE3,
    )
    assert main(["import", str(two), str(tmp_path / "none")]) == 1
    assert "several topics" in capsys.readouterr().err
    (tmp_path / "no.bag").write_bytes(b"nothing")
    for path in ("no.bag", "gone.bag"):
        assert main(["import", str(tmp_path / path), str(tmp_path / "none")]) == 1
        assert path in capsys.readouterr().err
