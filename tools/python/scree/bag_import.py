"""Makes a capture of a bag: ROS 1, ROS 2 or MCAP with raw lidar packets, sensor_msgs/Imu and wheel odometry."""

from __future__ import annotations

import shutil
import struct
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from math import asin, atan2, degrees, isfinite
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from .capture_files import LINKTYPE_ETHERNET, LINKTYPE_USER0, PcapWriter, can_line, lidar_frame, xsens_message
from .read import ReadError
from .records import Pose, Vector

DATA_PACKET = 1206  # bytes
PACKET_NS = 1_327_104  # from one packet of a VLP-16 to the next
MODE_AT, DUAL = 1204, 0x39  # factory byte: a dual-return packet has half as many shots, each twice
CAN_ID, SPEED_SCALE = 0x1A0, 1e-4
NEAR_NS = 5_000_000_000
IMU = "sensor_msgs/msg/Imu"
ODOMETRY = (
    "nav_msgs/msg/Odometry",
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/TwistWithCovarianceStamped",
)
TRANSFORMS = "tf2_msgs/msg/TFMessage"

# Bags of older ROS 2 have no definitions in them.
_PACKET = "builtin_interfaces/Time stamp\nuint8[1206] data\n"
_SCAN = "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n"


@dataclass
class Imported:
    """What was taken, and what was not and why."""

    packets: int = 0
    imu: int = 0
    odometry: int = 0
    topics: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    refused: Counter[str] = field(default_factory=Counter)


def _typestore() -> Any:
    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg(_PACKET, "velodyne_msgs/msg/VelodynePacket"))
    store.register(get_types_from_msg(_SCAN, "velodyne_msgs/msg/VelodyneScan"))
    return store


def _stamp(time: Any) -> int:
    return int(time.sec) * 1_000_000_000 + int(time.nanosec)


def packets_of(message: Any, arrival_ns: int) -> Iterator[tuple[int, bytes]]:
    """The lidar's packets with their times, of a VelodyneScan and whatever else has a list of packets.

    A scan arrives as a whole. Its packets have the driver's times; where those are of another clock
    (GPS), they are laid before the arrival by what a VLP-16 needs for each.
    """
    packets = [(_stamp(it.stamp), bytes(it.data)) for it in message.packets]
    is_near = all(abs(stamp - arrival_ns) < NEAR_NS for stamp, _ in packets)
    time_ns = arrival_ns - sum(_duration(data) for _, data in packets)
    for stamp, data in packets:
        time_ns += _duration(data)
        yield (stamp if is_near else time_ns), data


def _duration(packet: bytes) -> int:
    is_dual = len(packet) == DATA_PACKET and packet[MODE_AT] == DUAL
    return PACKET_NS // 2 if is_dual else PACKET_NS


def speed_of(message: Any) -> float:
    """Ahead, m/s: of an Odometry or a Twist with or without covariance."""
    twist = message.twist
    while hasattr(twist, "twist"):
        twist = twist.twist
    return float(twist.linear.x)


def _choose(reader: Any, kinds: tuple[str, ...], wanted: str | None, what: str) -> str | None:
    """The topic as named, else the only one of its kind."""
    topics = sorted({it.topic for it in reader.connections if it.msgtype in kinds})
    if wanted is not None:
        there = {it.topic: it.msgtype for it in reader.connections}
        if wanted not in there:
            raise ReadError(f"the bag has no topic {wanted}")
        if wanted not in topics:
            raise ReadError(f"topic {wanted} is {there[wanted]}: it cannot be the {what}")
        return wanted
    if len(topics) > 1:
        raise ReadError(f"several topics could be the {what}: {', '.join(topics)}; name one")
    return topics[0] if topics else None


def _packet_topic(reader: Any, wanted: str | None) -> str:
    kinds = tuple(
        {
            it.msgtype
            for it in reader.connections
            if wanted or it.msgtype.rsplit("/", 1)[-1].endswith(("VelodyneScan", "Packets"))
        }
    )
    topic = _choose(reader, kinds, wanted, "lidar's packets")
    if topic is None:
        clouds = [it.topic for it in reader.connections if it.msgtype.endswith("PointCloud2")]
        hint = f": {clouds[0]} is a finished cloud, without the packets' times" if clouds else ""
        raise ReadError(f"the bag has no raw packets of a lidar (velodyne_msgs/VelodyneScan){hint}")
    return topic


def import_bag(
    bag: str | Path,
    folder: str | Path,
    packets_topic: str | None = None,
    imu_topic: str | None = None,
    odometry_topic: str | None = None,
    base: str = "base_link",
    model: str = "vlp16",
) -> Imported:
    """Writes a capture into a folder that is not there yet or empty. ReadError in one sentence."""
    bag, folder = Path(bag), Path(folder)
    made = folder / ".new"  # what is in it moves up when all is there
    was_there = folder.exists()
    if was_there and any(it != made for it in folder.iterdir()):
        raise ReadError(f"{folder} is not empty")
    if not bag.exists():
        raise ReadError(f"there is no bag {bag}")
    if bag.is_dir() and not (bag / "metadata.yaml").exists():
        raise ReadError(f"{bag} is no bag of ROS 2: it has no metadata.yaml")
    try:
        with AnyReader([bag], default_typestore=_typestore()) as reader:
            lidar = _packet_topic(reader, packets_topic)
            imu = _choose(reader, (IMU,), imu_topic, "IMU")
            odometry = _choose(reader, ODOMETRY, odometry_topic, "wheel odometry")
            shutil.rmtree(made, ignore_errors=True)
            made.mkdir(parents=True)
            done = _Import(reader, made, lidar, imu, odometry, base, model).run()
        for file in list(made.iterdir()):
            file.rename(folder / file.name)
        return done
    except (ReadError, OSError):
        raise
    except Exception as error:  # over a broken bag rosbags throws its own errors and those of what it uses
        raise ReadError(f"{bag} cannot be read: {' '.join(str(error).split())}") from error
    finally:
        shutil.rmtree(made, ignore_errors=True)
        if not was_there:
            with suppress(OSError):  # it is there where it has a capture
                folder.rmdir()


class _Import:
    def __init__(
        self,
        reader: Any,
        folder: Path,
        lidar: str,
        imu: str | None,
        odometry: str | None,
        base: str,
        model: str,
    ):
        self.reader, self.folder, self.base, self.model = reader, folder, base, model
        self.lidar, self.imu, self.odometry = lidar, imu, odometry
        self.done = Imported(
            topics={k: v for k, v in (("lidar", lidar), ("imu", imu), ("odometry", odometry)) if v}
        )
        self.frames: dict[str, str] = {}  # of lidar and IMU
        self.mounts: dict[str, tuple[str, Pose]] = {}  # parent and place of each frame
        self.last_imu_ns = 0

    def run(self) -> Imported:
        wanted = {*self.done.topics.values(), "/tf_static"}
        connections = [it for it in self.reader.connections if it.topic in wanted]
        with (
            PcapWriter(self.folder / "lidar.pcap", LINKTYPE_ETHERNET) as self.lidar_file,
            PcapWriter(self.folder / "imu.pcap", LINKTYPE_USER0) as self.imu_file,
            (self.folder / "can.log").open("w") as self.can_file,
        ):
            for connection, arrival_ns, raw in self.reader.messages(connections=connections):
                self._take(connection, arrival_ns, self.reader.deserialize(raw, connection.msgtype))
        for name, count in (("imu.pcap", self.done.imu), ("can.log", self.done.odometry)):
            if count == 0:
                (self.folder / name).unlink()
        if self.done.packets == 0:
            raise ReadError(f"no message on {self.lidar} holds a packet of {DATA_PACKET} bytes")
        (self.folder / "scree.toml").write_text(self._config())
        return self.done

    def _take(self, connection: Any, arrival_ns: int, message: Any) -> None:
        if connection.topic == self.lidar:
            if not hasattr(message, "packets"):
                raise ReadError(f"topic {self.lidar} is {connection.msgtype}: it has no raw packets")
            self.frames.setdefault("lidar", message.header.frame_id if hasattr(message, "header") else "")
            self._take_packets(message, arrival_ns)
        elif connection.topic == self.imu:
            self.frames.setdefault("imu", message.header.frame_id)
            self._take_imu(message, arrival_ns)
        elif connection.topic == self.odometry:
            self._take_speed(speed_of(message), arrival_ns)
        elif connection.msgtype == TRANSFORMS:
            for it in message.transforms:
                t, r = it.transform.translation, it.transform.rotation
                place = Pose((t.x, t.y, t.z), (r.w, r.x, r.y, r.z))
                self.mounts[it.child_frame_id.lstrip("/")] = it.header.frame_id.lstrip("/"), place

    def _take_packets(self, message: Any, arrival_ns: int) -> None:
        for time_ns, data in packets_of(message, arrival_ns):
            if len(data) != DATA_PACKET:
                self.done.refused[f"packets of {len(data)} bytes"] += 1
                continue
            self.lidar_file.write(time_ns, lidar_frame(data))
            self.done.packets += 1

    def _take_imu(self, message: Any, arrival_ns: int) -> None:
        q, w, a = message.orientation, message.angular_velocity, message.linear_acceleration
        values = (q.w, q.x, q.y, q.z, w.x, w.y, w.z, a.x, a.y, a.z)
        if not all(map(isfinite, values)):
            self.done.refused["IMU messages that are no numbers"] += 1
            return
        length = sum(value * value for value in values[:4]) ** 0.5
        has_orientation = message.orientation_covariance[0] != -1 and length > 0.5
        orientation = tuple(value / length for value in values[:4]) if has_orientation else None
        if not has_orientation:
            self.done.refused["orientations that the IMU does not have"] += 1
        stamp_ns = _stamp(message.header.stamp)
        self.imu_file.write(
            arrival_ns, xsens_message(self.done.imu, stamp_ns, orientation, values[4:7], values[7:])
        )
        self.done.imu += 1

    def _take_speed(self, speed: float, arrival_ns: int) -> None:
        if not isfinite(speed) or abs(speed) > 100:
            self.done.refused["speeds that are no numbers"] += 1
            return
        data = struct.pack("<i", round(speed / SPEED_SCALE))
        self.can_file.write(can_line(arrival_ns, "can0", CAN_ID, data))
        self.done.odometry += 1

    def _mount(self, sensor: str) -> Pose | None:
        """Where a sensor sits on the robot, by the chain of static transforms."""
        frame = self.frames.get(sensor, "").lstrip("/")
        place = Pose()
        for _ in range(len(self.mounts) + 1):
            if frame == self.base:
                return place
            if frame not in self.mounts:
                return None
            frame, parent = self.mounts[frame]
            place = _chained(parent, place)
        return None

    def _config(self) -> str:
        parts = [f'[lidar]\nmodel = "{self.model}"\n' + self._mount_lines("lidar")]
        if self.done.imu:
            parts.append("[imu]\n" + self._mount_lines("imu"))
        if self.done.odometry:
            parts.append(
                f'[encoder]\ninterface = "can0"\ncan_id = 0x{CAN_ID:X}\nstart_bit = 0\nlength = 32\n'
                f'byte_order = "little_endian"\nsigned = true\nkind = "speed"\nscale = {SPEED_SCALE}\n'
            )
        return "\n".join(parts)

    def _mount_lines(self, sensor: str) -> str:
        mount = self._mount(sensor)
        if mount is None:
            self.done.notes.append(
                f"the bag does not say where the {sensor} ({self.frames.get(sensor, '')}) sits on {self.base}: "
                f"set {sensor}.translation and {sensor}.rpy_deg in scree.toml"
            )
            return ""
        x, y, z = mount.p
        roll, pitch, yaw = _angles(mount)
        return f"translation = [{x:.4f}, {y:.4f}, {z:.4f}]\nrpy_deg = [{roll:.3f}, {pitch:.3f}, {yaw:.3f}]\n"


def _chained(parent: Pose, child: Pose) -> Pose:
    (w, x, y, z), (a, b, c, d) = parent.q, child.q
    q = (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )
    return Pose(parent.apply(child.p), q)


def _angles(pose: Pose) -> Vector:
    """Roll, pitch and yaw of Rz(yaw) Ry(pitch) Rx(roll), degrees."""
    w, x, y, z = pose.q
    pitch = asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    roll = atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return degrees(roll), degrees(pitch), degrees(pose.yaw)
