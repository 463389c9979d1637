"""Right logs of unlike vehicles, in the formats of other programs: none may be refused.

python evidence/right_logs.py --logs 50 --out out/right

Vehicles of 1 to 4 unlike quadrotors are simulated by `other_body.py`, by no code of the package, and written as these
programs write them: a table, a ULog of PX4, ArduPilot's DataFlash, the CSV of a Crazyflie's client, `rostopic echo -p`,
an MCAP, an MDF 4, and Betaflight's blackbox beside a take of Motive or Vicon, two recorders whose clocks differ by a
second, joined by the turn of the one body. Each has the rates and the roundings of its program. A log is read, and its
streams are tried against each other for the mission of about such a vehicle; none may be refused.
"""

from __future__ import annotations

import argparse
import json
import shutil
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from mistaken_maps import FORCE, RATES, SPEEDS, Instruments, flights, start_of
from other_body import log_of

import tandemlift as tl
from tandemlift.analysis.logs.causes import check_streams
from tandemlift.analysis.logs.joining import joined
from tandemlift.analysis.logs.log import JOINTS, MOTION, Log, conjugate, rotated
from tandemlift.core.errors import InputError

FIRST_SEED, SECONDS = 61000, 20.0
POSITION, VELOCITY, ATTITUDE = MOTION
DOWN, G = np.array([1.0, -1.0, -1.0]), 9.80665
EPOCH, LATE = 1_700_000_000 * 10**9, 7_000_000  # ns
Map = dict[str, Any]


def stamps(log: Log, name: str, unit: float, first: int = 0) -> list[int]:
    """Whole stamps of a stream."""
    return [first + int(t) for t in np.round(log[name].time / unit)]


def lines(path: Path, names: list[str], *columns: Any) -> None:
    """A table of text."""
    body = [",".join(f"{x:.9g}" if x % 1 else f"{int(x)}" for x in row) for row in np.column_stack(columns).tolist()]
    path.write_text("\n".join([",".join(names), *body]) + "\n")


def angles(q: np.ndarray) -> np.ndarray:
    """Roll, pitch, yaw [deg] of quaternions w, x, y, z."""
    w, x, y, z = q.T
    roll, pitch = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), np.arcsin(2 * (w * y - z * x))
    return np.degrees(np.column_stack([roll, pitch, np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))]))


def table(log: Log, folder: Path, chance: np.random.Generator) -> Log:
    """A table of strange instruments with its map."""
    own = Instruments(log, chance)
    own.write(folder / "table.csv")
    return tl.read_log(folder / "table.csv", own.map)


def px4(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """A ULog: north, east, down, and odometry that arrives 8 ms late."""
    n, imu = log[SPEEDS].values.shape[1], log[RATES]
    began = 5_000_000  # us
    felt = zip(stamps(log, RATES, 1e-6, began), imu.values * DOWN, log[FORCE].at(imu.time) * DOWN, strict=True)
    turned = log[ATTITUDE].values * [1, 1, -1, -1]
    seen = zip(
        stamps(log, POSITION, 1e-6, began),
        log[POSITION].values * DOWN,
        turned,
        log[VELOCITY].values * DOWN,
        strict=True,
    )
    speeds = zip(stamps(log, SPEEDS, 1e-6, began), log[SPEEDS].values * 30 / np.pi, strict=True)
    imu_fields = "float[3] gyro_rad;int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2"
    odometry = "uint64_t timestamp_sample;float[3] position;float[4] q;float[3] velocity;uint8_t velocity_frame"
    topics = {
        "sensor_combined": (imu_fields, "Q3fi3f", [(t, *w, 0, *f) for t, w, f in felt]),
        "vehicle_visual_odometry": (odometry, "QQ3f4f3fB", [(t + 8000, t, *p, *q, *v, 1) for t, p, q, v in seen]),
        "esc": (f"float[{n}] rpm", f"Q{n}f", [(t, *u) for t, u in speeds]),
    }
    texts = [f"{name}:uint64_t timestamp;{fields};".encode() for name, (fields, *_) in topics.items()]
    parts = [b"\x55\x4c\x6f\x67\x01\x12\x35\x01" + struct.pack("<Q", 0), struct.pack("<HB", 40, ord("B")) + bytes(40)]
    parts += [struct.pack("<HB", len(text), ord("F")) + text for text in texts]
    parts += [struct.pack("<HBBH", 3 + len(n), ord("A"), 0, i) + n.encode() for i, n in enumerate(topics)]
    events = [
        (row[0], struct.pack("<HBH" + letters, 2 + struct.calcsize("<" + letters), ord("D"), i, *row))
        for i, (_, letters, rows) in enumerate(topics.values())
        for row in rows
    ]
    events.sort(key=lambda event: event[0])
    (folder / "log.ulg").write_bytes(b"".join([*parts, *(data for _, data in events)]))
    own = {"topic": "esc", "columns": [f"rpm[{i}]" for i in range(n)], "unit": "rpm", "time": "timestamp"}
    return tl.read_log(folder / "log.ulg", {SPEEDS: own | {"time_unit": "us"}})


def ardupilot(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """A DataFlash log: angles in hundredths of a degree, the yaw from 0 to 360."""
    codes = {"B": "B", "n": "4s", "N": "16s", "Z": "64s", "Q": "Q", "f": "f", "c": "h", "C": "H"}
    kinds = {
        128: ("FMT", "BBnNZ", "Type,Length,Name,Format,Columns"),
        130: ("IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
        131: ("XKF1", "QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD"),
        132: ("ATT", "QccC", "TimeUS,Roll,Pitch,Yaw"),
    }

    def layout(kind: int) -> str:
        return "<" + "".join(codes[c] for c in kinds[kind][1])

    def message(kind: int, *values: Any) -> bytes:
        return b"\xa3\x95" + bytes([kind]) + struct.pack(layout(kind), *values)

    out = [
        (0, message(128, kind, 3 + struct.calcsize(layout(kind)), name.encode(), letters.encode(), columns.encode()))
        for kind, (name, letters, columns) in kinds.items()
    ]
    imu, turned, began = log[RATES], np.round(100.0 * angles(log[ATTITUDE].values) * DOWN).astype(int), 3_000_000
    for t, w, f in zip(stamps(log, RATES, 1e-6, began), imu.values * DOWN, log[FORCE].at(imu.time) * DOWN, strict=True):
        out.append((t, message(130, t, 0, *w, *f)))
    seen = log[POSITION].values * DOWN, log[VELOCITY].values * DOWN, turned
    for t, p, v, a in zip(stamps(log, POSITION, 1e-6, began), *seen, strict=True):
        out.append((t, message(131, t, 0, *v, *p) + message(132, t, a[0], a[1], a[2] % 36000)))
    out.sort(key=lambda event: event[0])
    (folder / "log.bin").write_bytes(b"".join(data for _, data in out))
    return tl.read_log(folder / "log.bin")


def crazyflie(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """The client's CSV: a block at 100 Hz, stamps in whole milliseconds of 24 bits, pitch with the other sign.

    The firmware filters its inertial unit, so that a sample is a mean about its time.
    """
    time, n = log[POSITION].time[::2], log[SPEEDS].values.shape[1]

    def mean(name: str) -> np.ndarray:
        at, v = log[name]
        return np.array([v[(at > t - 0.005) & (at <= t + 0.005)].mean(axis=0) for t in time])

    names = ["Timestamp", *(f"{s}.{x}" for s in ("gyro", "acc", "stateEstimate") for x in "xyz")]
    names += [f"stateEstimate.{x}" for x in ("vx", "vy", "vz", "roll", "pitch", "yaw")] + [
        f"rpm.m{i}" for i in range(n)
    ]
    motion = log[POSITION].at(time), log[VELOCITY].at(time), angles(log[ATTITUDE].at(time)) * [1.0, -1.0, 1.0]
    whole, speeds = (2**24 - 5000 + np.round(1e3 * time)) % 2**24, log[SPEEDS].at(time) * 30 / np.pi
    lines(folder / "cf.csv", names, whole, np.degrees(mean(RATES)), mean(FORCE) / G, *motion, speeds)
    return tl.read_log(folder / "cf.csv", {SPEEDS: {"columns": names[-n:], "unit": "rpm"}}, format="crazyflie")


def rostopic(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """A table of each topic, stamped in ns."""
    count, own = log[JOINTS[0]].values.shape[1] // 3, folder / "topics"
    shutil.rmtree(own, ignore_errors=True)
    own.mkdir()

    def topic(name: str, stream: str, fields: list[str], *values: np.ndarray) -> None:
        rows = [",".join(["%time", "field.header.seq", "field.header.stamp", "field.header.frame_id", *fields])]
        for k, (t, row) in enumerate(zip(stamps(log, stream, 1e-9, EPOCH), np.hstack(values).tolist(), strict=True)):
            rows.append(",".join([str(t + LATE), str(k), str(t), "world", *(f"{x:.9g}" for x in row)]))
        (own / f"{name}.csv").write_text("\n".join(rows) + "\n")

    def three(name: str, axes: str = "xyz") -> list[str]:
        return [f"field.{name}.{a}" for a in axes]

    topic("imu", RATES, three("angular_velocity") + three("linear_acceleration"), log[RATES].values, log[FORCE].values)
    pose = three("pose.position") + three("pose.orientation", "wxyz")
    topic("pose", POSITION, pose, log[POSITION].values, log[ATTITUDE].values)
    fields = dict(zip(JOINTS, (three("wrench.force"), three("wrench.torque")), strict=True))
    for i in range(count):
        both = [log[name].values[:, 3 * i : 3 * i + 3] for name in JOINTS]
        topic(f"ft_{i}", JOINTS[0], [name for own in fields.values() for name in own], *both)
    topics = [f"ft_{i}" for i in range(count)]
    return tl.read_log(own, {n: {"topic": topics, "columns": c} for n, c in fields.items()}, format="rosbag-csv")


def mdf(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """A channel group of each stream."""
    from asammdf import MDF, Signal

    made, maps = MDF(version="4.10"), dict[str, Any]()
    for name, (time, values) in log.items():
        maps[name] = {"columns": [f"{name}{i}" for i in range(values.shape[1])]}
        columns = zip(values.T, maps[name]["columns"], strict=True)
        made.append([Signal(np.ascontiguousarray(v), 100.0 + time, name=n) for v, n in columns])
    made.save(folder / "log.mf4", overwrite=True)
    return tl.read_log(folder / "log.mf4", maps)


def mcap(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """Messages of ROS 2 with headers; commands as JointState."""
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store, path, count = get_typestore(Stores.ROS2_HUMBLE), folder / "bag", log[JOINTS[0]].values.shape[1] // 3
    shutil.rmtree(path, ignore_errors=True)

    def new(kind: str, *values: Any) -> Any:
        package, _, name = kind.partition("/")
        return store.types[f"{package}/msg/{name}"](*values)

    def header(t: float) -> Any:
        return new("std_msgs/Header", new("builtin_interfaces/Time", *divmod(EPOCH + round(1e9 * t), 10**9)), "")

    def numbers(v: np.ndarray, kind: str = "Vector3") -> Any:
        return new(f"geometry_msgs/{kind}", *map(float, v))

    nine, many, none, messages = np.zeros(9), np.zeros(36), numbers(np.array([0, 0, 0, 1]), "Quaternion"), []
    for t, w, f in zip(log[RATES].time, log[RATES].values, log[FORCE].values, strict=True):
        imu = new("sensor_msgs/Imu", header(t), none, nine, numbers(w), nine, numbers(f), nine)
        messages.append((t, "/tandemlift/measured/imu", imu))
    time, turned = log[ATTITUDE]
    back = rotated(conjugate(turned), log[VELOCITY].values)
    for t, p, q, v in zip(time, log[POSITION].values, turned, back, strict=True):
        pose = new("geometry_msgs/Pose", numbers(p, "Point"), numbers(q[[1, 2, 3, 0]], "Quaternion"))
        twist = new("geometry_msgs/Twist", numbers(v), numbers(np.zeros(3)))
        parts = (
            new("geometry_msgs/PoseWithCovariance", pose, many),
            new("geometry_msgs/TwistWithCovariance", twist, many),
        )
        messages.append((t, "/tandemlift/measured/odometry", new("nav_msgs/Odometry", header(t), "", *parts)))
    for i in range(count):
        for t, F, M in zip(log[JOINTS[0]].time, *(log[n].values[:, 3 * i : 3 * i + 3] for n in JOINTS), strict=True):
            wrench = new("geometry_msgs/WrenchStamped", header(t), new("geometry_msgs/Wrench", numbers(F), numbers(M)))
            messages.append((t, f"/tandemlift/joint_{i + 1}/measured", wrench))
    for t, u in zip(*log[SPEEDS], strict=True):
        messages.append(
            (t, "/esc", new("sensor_msgs/JointState", header(t), [], np.zeros(0), np.array(u), np.zeros(0)))
        )
    messages.sort(key=lambda message: message[0])
    with Writer(path, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        known: dict[str, Any] = {}
        for t, topic, message in messages:
            kind = message.__msgtype__
            if topic not in known:
                known[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(known[topic], EPOCH + round(1e9 * t) + LATE, store.serialize_cdr(message, kind))
    return tl.read_log(path, {SPEEDS: {"topic": "/esc", "columns": ["velocity"]}})


def blackbox(log: Log, folder: Path) -> Log:
    """blackbox_decode's CSV, in deg/s and g, with whole revolutions per minute."""
    time, n = log[RATES].time, log[SPEEDS].values.shape[1]
    names = ["loopIteration", "time (us)", *(f"gyroADC[{i}] (deg/s)" for i in range(3))]
    names += [f"accSmooth[{i}] (g)" for i in range(3)] + [f"rpm[{i}]" for i in range(n)]
    values = np.degrees(log[RATES].values), log[FORCE].at(time) / G, np.round(log[SPEEDS].at(time) * 30 / np.pi)
    lines(folder / "LOG.csv", names, np.arange(len(time)), np.round(1e6 * time) + 55_158_008, *values)
    speeds = {"columns": names[-n:], "unit": "rpm", "time": "time (us)"}
    return tl.read_log(folder / "LOG.csv", {SPEEDS: speeds}, format="blackbox")


def beside(log: Log, folder: Path, program: str, head: list[str], rows: Callable[..., list[float]]) -> Log:
    """A blackbox joined with a tracker's table in millimetres, which begins 1.3 s later, with a clock of its own."""
    time, p, q = log[POSITION].time[260:], 1e3 * log[POSITION].values[260:], log[ATTITUDE].values[260:]
    body = [
        ",".join(f"{x:.6f}" if x % 1 else f"{int(x)}" for x in rows(*one))
        for one in zip(range(len(p)), time - time[0], p, q, strict=True)
    ]
    (folder / "tracker.csv").write_text("\n".join([*head, *body]) + "\n")
    return joined([blackbox(log, folder), tl.read_log(folder / "tracker.csv", format=program)])


def with_motive(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """A take of Motive with y up."""
    head = "Format Version,1.23,Take Name,A,Capture Frame Rate,200,Rotation Type,Quaternion,Length Units,Millimeters"
    heads = [
        f"{head},Coordinate Space,Global",
        "",
        ",Type" + ",Rigid Body" * 7,
        ",Name" + ",Beam" * 7,
        ",ID" + ",A1" * 7,
    ]
    heads += ["," + ",Rotation" * 4 + ",Position" * 3, "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z"]
    return beside(
        log, folder, "optitrack", heads, lambda k, t, p, q: [k, t, q[1], q[3], -q[2], q[0], p[0], p[2], -p[1]]
    )


def with_vicon(log: Log, folder: Path, _: np.random.Generator) -> Log:
    """An export of Vicon's Tracker at 200 Hz."""
    heads = ["Objects", "200", ",,Global Angle Beam:Beam,,,,,,", "Frame,Sub Frame,RX,RY,RZ,RW,TX,TY,TZ"]
    return beside(log, folder, "vicon", [*heads, ",,,,,,mm,mm,mm"], lambda k, _, p, q: [k + 1, 0, *q[1:], q[0], *p])


FORMATS: dict[str, Callable[[Log, Path, np.random.Generator], Log]] = {
    "table": table,
    "px4": px4,
    "ardupilot": ardupilot,
    "crazyflie": crazyflie,
    "rosbag-csv": rostopic,
    "mcap": mcap,
    "mdf": mdf,
    "blackbox + optitrack": with_motive,
    "blackbox + vicon": with_vicon,
}


def main() -> None:
    """Write, read and try logs, and print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--logs", type=int, default=50)
    options.add_argument("--first-seed", type=int, default=FIRST_SEED)
    options.add_argument("--out", type=Path, default=Path("out/right"))
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    pool, rows = flights(given.out, -(-given.logs // 4), SECONDS, given.first_seed), list[dict[str, Any]]()
    by_count = [[one for one in pool if len(one[0]["vehicle.quadrotors"]) == count] for count in (1, 2, 3, 4)]
    for i in range(given.logs):
        changes, flight = by_count[i % 4][i // 4]
        chance, format = np.random.default_rng(given.first_seed + i), [*FORMATS][i % len(FORMATS)]
        log = log_of(flight, float(chance.choice([250.0, 500.0, 1000.0])), given.first_seed + i)
        row: dict[str, Any] = {"number": i, "quadrotors": 1 + i % 4, "format": format}
        try:
            read = FORMATS[format](log, given.out, chance)
            tests = check_streams(read, start_of(changes).vehicle).table
            row |= {"refused": "", "agree": sum(t.verdict == "agrees" for t in tests), "streams": len(read)}
        except InputError as error:
            row["refused"] = str(error)
        rows.append(row)
        print(json.dumps(row), flush=True)
    (given.out / "logs.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows), "utf-8")
    for format in FORMATS:
        own = [row for row in rows if row["format"] == format]
        print(f"{format:22} {len(own):3} logs, {sum(bool(row['refused']) for row in own)} refused")


if __name__ == "__main__":
    main()
