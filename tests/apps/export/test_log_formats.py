"""Logs of other programs are read by the format's name: files as these programs write them, and the motion in them."""

import struct
from zlib import crc32

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.log import IMU, MOTION

N, STEP = 400, 0.005
TIME = np.arange(N) * STEP
FORCE, RATES, VELOCITY, ATTITUDE = IMU[0], IMU[1], MOTION[1], MOTION[2]
POSITION = np.column_stack([np.sin(TIME), 0.5 * np.cos(2.0 * TIME), 1.0 + 0.2 * TIME])  # m, world, z up
SPEED = np.column_stack([np.cos(TIME), -np.sin(2.0 * TIME), np.full(N, 0.2)])
TURN = Rotation.from_euler("ZYX", np.column_stack([3.0 + 0.4 * TIME, 0.1 * np.sin(TIME), 0.2 * np.cos(TIME)]))
GYRO = np.column_stack([0.3 * np.sin(5.0 * TIME), 0.2 * np.cos(4.0 * TIME), 0.4 + 0.01 * TIME])
FELT = np.column_stack([0.1 * np.sin(TIME), 0.2 * np.cos(TIME), 9.8 + 0.01 * np.sin(9.0 * TIME)])
DOWN = Rotation.from_euler("x", 180.0, degrees=True)  # front, left, up to front, right, down; north-west-up to NED


def same_turn(values, turn=TURN, *, within=1e-6):
    """Whether quaternions w, x, y, z are those of a rotation, whatever their sign."""
    return np.abs(np.sum(values * turn.as_quat(scalar_first=True), axis=1)) == pytest.approx(1.0, abs=within)


def holds(log, *, within=1e-6, **expected):
    for name, values in expected.items():
        time, found = log[f"measured_{name}"]
        assert time == pytest.approx(TIME[: len(time)], abs=1e-6)
        assert found == pytest.approx(values, abs=within), name


# ---- OptiTrack's Motive: docs.optitrack.com, "Data Export: CSV"


def motive_csv(path, *, unit="Millimeters", factor=1e3, up="y", version="1.23", rotation="Quaternion"):
    """A take with two rigid bodies and a marker; with y up, x, y, z of Motive are our x, z, −y."""
    axes = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) if up == "y" else np.eye(3)
    turned = (Rotation.from_matrix(axes) * TURN * Rotation.from_matrix(axes).inv()).as_quat()
    place = factor * POSITION @ axes.T
    head = f"Format Version,{version},Take Name,Flight,Capture Frame Rate,200.000000,Export Frame Rate,200.000000,"
    head += f"Rotation Type,{rotation},Length Units,{unit},Coordinate Space,Global\n\n"
    body = ["Rotation"] * 4 + ["Position"] * 3
    rows = [
        [",Type", *["Rigid Body"] * 15, *["Rigid Body Marker"] * 3],
        [",Name", *["Beam"] * 7, *["Other"] * 8, *["Beam:Marker 001"] * 3],
        [",ID", *["A1"] * 18],
        *([[",Parent", *["Root"] * 18]] if version >= "1.24" else []),
        [",", *body, *body, "Mean Marker Error", *["Position"] * 3],
        ["Frame,Time (Seconds)", *"XYZWXYZXYZWXYZ", "", *"XYZ"],
    ]
    for k in range(N):
        own = [*turned[k], *place[k]] if k % 50 else [""] * 7  # out of sight
        rows.append([f"{k},{TIME[k]:.6f}", *map(str, own), *["0.5"] * 8, *["7"] * 3])
    path.write_text(head + "\n".join(",".join(row) for row in rows) + "\n", "utf-8-sig")
    return path


@pytest.mark.parametrize(
    ("unit", "factor", "up", "version"), [("Millimeters", 1e3, "y", "1.23"), ("Meters", 1.0, "z", "1.25")]
)
def test_motive_is_read_with_the_units_of_its_file_and_either_axis_up(unit, factor, up, version, tmp_path):
    path = motive_csv(tmp_path / "take.csv", unit=unit, factor=factor, up=up, version=version)
    log = tl.read_log(path, {"rigid_body": "Beam"} | ({"up": "z"} if up == "z" else {}), format="optitrack")
    seen = np.arange(N) % 50 > 0
    time, values = log[MOTION[0]]
    assert time + TIME[1] == pytest.approx(TIME[seen])  # the log begins with its first sample
    assert values == pytest.approx(POSITION[seen], abs=1e-9)
    assert same_turn(log[ATTITUDE].values, TURN[np.flatnonzero(seen)])


def test_motive_names_the_bodies_and_refuses_what_it_cannot_tell(tmp_path):
    with pytest.raises(tl.InputError, match="rigid_body must be one of Beam, Other"):
        tl.read_log(motive_csv(tmp_path / "take.csv"), format="optitrack")
    with pytest.raises(tl.InputError, match="Rotation Type is XYZ: export it with Rotation Type = Quaternion"):
        tl.read_log(motive_csv(tmp_path / "take.csv", rotation="XYZ"), format="optitrack")
    with pytest.raises(tl.InputError, match="Length Units is Furlongs: must be one of Meters"):
        tl.read_log(motive_csv(tmp_path / "take.csv", unit="Furlongs"), {"rigid_body": "Beam"}, format="optitrack")
    (tmp_path / "take.csv").write_text("Frame,Time (Seconds),X\n1,0.1,2\n")
    with pytest.raises(tl.InputError, match="no rigid body in it"):
        tl.read_log(tmp_path / "take.csv", format="optitrack")


# ---- Vicon: exports of Tracker and Nexus


def vicon_csv(path, kind):
    head = {
        "quaternion": ("Objects", ["RX", "RY", "RZ", "RW", "TX", "TY", "TZ"], ["", "", "", "", "mm", "mm", "mm"]),
        "angles": ("Segments", ["RX", "RY", "RZ", "TX", "TY", "TZ"], ["deg"] * 3 + ["mm"] * 3),
        "vector": ("Objects", ["RX", "RY", "RZ", "TX", "TY", "TZ"], ["rad"] * 3 + ["mm"] * 3),
    }
    title, axes, units = head[kind]
    turn = {"quaternion": TURN.as_quat(), "angles": TURN.as_euler("xyz", degrees=True), "vector": TURN.as_rotvec()}[
        kind
    ]
    names = ["Global Angle Beam:Beam", *[""] * (len(axes) - 1)] * 2
    names[len(axes)] = "Global Angle Rig:Other"
    lines = [title, "200", ",," + ",".join(names), "Frame,Sub Frame," + ",".join(axes * 2), ",," + ",".join(units * 2)]
    for k in range(N):
        own = [*turn[k], *(1e3 * POSITION[k])]
        lines.append(f"{k + 1},0," + ",".join(map(str, own)) + "," * len(axes))
    path.write_text("\n".join([*lines, "", "Trajectories", "200", ",,Beam:m1,,", "Frame,Sub Frame,X,Y,Z"]) + "\n")
    return path


@pytest.mark.parametrize(
    ("kind", "angles", "unit"), [("quaternion", None, ""), ("angles", "xyz", "1"), ("vector", "rotation vector", "1")]
)
def test_vicon_is_read_from_frames_and_its_line_of_units(kind, angles, unit, tmp_path):
    map_ = {"rigid_body": "Beam"}
    if angles:
        map_["measured_attitude"] = {"columns": ["RX", "RY", "RZ"], "angles": angles, "unit": unit}
    log = tl.read_log(vicon_csv(tmp_path / "vicon.csv", kind), map_, format="vicon")
    holds(log, position=POSITION)
    assert same_turn(log[ATTITUDE].values)


# ---- Betaflight: blackbox_decode of betaflight/blackbox-tools, in its three units


@pytest.mark.parametrize("unit", ["raw", "deg/s", "rad/s"])
def test_a_blackbox_is_read_in_the_units_of_its_names(unit, tmp_path):
    factor = 1.0 if unit == "rad/s" else 180.0 / np.pi
    said, force = ("", "") if unit == "raw" else (f" ({unit})", " (g)")
    names = ["loopIteration", "time (us)", *(f"gyroADC[{i}]{said}" for i in range(3))]
    names += [*(f"accSmooth[{i}]{force}" for i in range(3)), "flightModeFlags (flags)", "failsafePhase (flags)"]
    rows = [
        f"{k}, {55158008 + 5000 * k}, " + ", ".join(f"{x:.9f}" for x in [*(factor * GYRO[k]), *(FELT[k] / 9.80665)])
        for k in range(N)
    ]
    text = "\n".join([", ".join(names), *(row + ", ANGLE_MODE|ARM, IDLE" for row in rows)])
    (tmp_path / "LOG00007.01.csv").write_text(text + "\n")
    log = tl.read_log(tmp_path / "LOG00007.01.csv", format="blackbox")
    holds(log, rates=GYRO)
    if unit == "raw":
        assert FORCE not in log  # needs acc_1G
    else:
        holds(log, specific_force=FELT)


# ---- Crazyflie: the client's writer of logs, and the card's records (bitcraze/crazyflie-firmware, tools/usdlog)

VARIABLES = [f"gyro.{a}" for a in "xyz"] + [f"acc.{a}" for a in "xyz"] + [f"stateEstimate.{a}" for a in "xyz"]
VARIABLES += [f"stateEstimate.v{a}" for a in "xyz"] + ["stateEstimate.roll", "stateEstimate.pitch", "stateEstimate.yaw"]
ANGLES = TURN.as_euler("ZYX", degrees=True)[:, ::-1] * [1.0, -1.0, 1.0]  # the yaw of TURN wraps
NUMBERS = np.hstack([np.degrees(GYRO), FELT / 9.80665, POSITION, SPEED, ANGLES])


def card_log(path, *, cut=0):
    """Version 2: its head, an event of one number, and fixedFrequency with all variables as floats."""
    data = struct.pack("<BHH", 0xBC, 2, 2)
    data += struct.pack("<H", 7) + b"estTDOA\0" + struct.pack("<H", 1) + b"distance(f)\0"
    data += struct.pack("<H", 9) + b"fixedFrequency\0" + struct.pack("<H", len(VARIABLES))
    data += b"".join(f"{name}(f)\0".encode() for name in VARIABLES)
    for k in range(N):
        stamp = 1_000_000 + round(1e6 * TIME[k])
        data += struct.pack("<HQf", 7, stamp, 0.5) * (k % 3 == 0)
        data += struct.pack(f"<HQ{len(VARIABLES)}f", 9, stamp, *NUMBERS[k])
    whole = data + struct.pack("<I", crc32(data))
    path.write_bytes(whole[: len(whole) - cut])
    return path


def client_csv(path):
    """A line of names, then a block's numbers; the stamps of log blocks have 24 bits of milliseconds."""
    stamps = (2**24 - 1000 + np.round(1e3 * TIME).astype(int)) % 2**24
    lines = [",".join(["Timestamp", *VARIABLES])]
    lines += [",".join([str(stamp), *map(str, row)]) for stamp, row in zip(stamps.tolist(), NUMBERS, strict=True)]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("made", [client_csv, card_log])
def test_a_crazyflies_log_is_read_from_its_client_and_from_its_card(made, tmp_path):
    path = made(tmp_path / ("Stabilizer-20261129.csv" if made is client_csv else "log00"))
    log = tl.read_log(path, format="crazyflie")
    holds(log, within=1e-5, rates=GYRO, specific_force=FELT, position=POSITION, velocity=SPEED)
    assert same_turn(log[ATTITUDE].values, within=1e-6)
    assert any("2²⁴ ms" in note for note in log.notes) == (made is client_csv)


def test_a_card_that_was_cut_is_noted_and_what_is_no_card_is_refused(tmp_path):
    log = tl.read_log(card_log(tmp_path / "log00", cut=11), format="crazyflie")
    assert len(log[RATES].time) == N - 1
    assert any("cut or damaged" in note for note in log.notes)
    (tmp_path / "log01").write_bytes(b"\xbc\x09\x00\x01\x00")
    with pytest.raises(tl.InputError, match="version 9: must be 1 or 2"):
        tl.read_log(tmp_path / "log01", format="crazyflie")


# ---- ArduPilot: the self-describing messages of DataFlash (AP_Logger), read by pymavlink


def dataflash(path):
    kinds = {
        128: ("FMT", "BBnNZ", "Type,Length,Name,Format,Columns"),
        130: ("IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
        131: ("XKF1", "QBffffff", "TimeUS,C,VN,VE,VD,PN,PE,PD"),
        132: ("ATT", "QccC", "TimeUS,Roll,Pitch,Yaw"),
    }
    codes = {"B": "B", "n": "4s", "N": "16s", "Z": "64s", "Q": "Q", "f": "f", "c": "h", "C": "H"}

    def message(kind, *values):
        layout = "<" + "".join(codes[c] for c in kinds[kind][1])
        return b"\xa3\x95" + bytes([kind]) + struct.pack(layout, *values)

    out = []
    for kind, (name, layout, columns) in kinds.items():
        length = 3 + struct.calcsize("<" + "".join(codes[c] for c in layout))
        out.append(message(128, kind, length, name.encode(), layout.encode(), columns.encode()))
    angles = np.degrees((DOWN * TURN * DOWN).as_euler("ZYX"))[:, ::-1]
    for k in range(N):
        stamp = 3_000_000 + round(1e6 * TIME[k])
        for instance, sign in ((0, 1.0), (1, 7.0)):
            imu = np.concatenate([DOWN.apply(GYRO[k]), DOWN.apply(FELT[k])]) * sign
            out.append(message(130, stamp, instance, *imu))
            out.append(message(131, stamp, instance, *(sign * DOWN.apply(SPEED[k])), *(sign * DOWN.apply(POSITION[k]))))
        out.append(message(132, stamp, *centi(angles[k])))
    path.write_bytes(b"".join(out))
    return path


def centi(angles):
    """Roll, pitch, yaw in hundredths of a degree; yaw from 0 to 360, as a compass, so that it wraps."""
    roll, pitch, yaw = np.round(100.0 * angles).astype(int)
    return roll, pitch, yaw % 36000


def test_a_log_of_ardupilot_is_read_from_its_first_imu_and_core(tmp_path):
    pytest.importorskip("pymavlink")
    log = tl.read_log(dataflash(tmp_path / "00000012.BIN"))
    holds(log, rates=GYRO, specific_force=FELT, velocity=SPEED, position=POSITION)
    assert same_turn(log[ATTITUDE].values, within=1e-7)
    (tmp_path / "no.bin").write_bytes(b"\xa3\x95nothing")
    with pytest.raises(tl.InputError, match=r"no\.bin: (cannot be read as a log of ArduPilot|has no samples)"):
        tl.read_log(tmp_path / "no.bin")


# ---- `rostopic echo -p`: names of fields in order, nested by points, numbers of arrays without a point


def rostopic_csv(folder):
    """A topic of each kind, as Debian's rostopic 1.15 writes it from a bag."""
    head = "%time,field.header.seq,field.header.stamp,field.header.frame_id"
    q = TURN.as_quat()
    angular = [f"field.angular_velocity.{a}" for a in "xyz"] + [f"field.linear_acceleration.{a}" for a in "xyz"]
    pose = [f"field.pose.position.{a}" for a in "xyz"] + [f"field.pose.orientation.{a}" for a in "xyzw"]
    for name, fields, values in (
        ("imu_data", angular, np.hstack([GYRO, FELT])),
        ("vrpn_pose", pose, np.hstack([POSITION, q])),
        ("ft_left", [f"field.wrench.force.{a}" for a in "xyz"], GYRO),
        ("ft_right", [f"field.wrench.force.{a}" for a in "xyz"], 2.0 * GYRO),
    ):
        rows = [",".join([head, *fields])]
        for k in range(N):
            stamp = 1_700_000_000_000_000_000 + round(1e9 * TIME[k])
            rows.append(",".join([str(stamp + 7_000_000), str(k), str(stamp), "world", *map(str, values[k].tolist())]))
        (folder / f"{name}.csv").write_text("\n".join(rows) + "\n")
    return folder


def test_topics_that_rostopic_wrote_are_read_from_a_file_or_a_folder(tmp_path):
    folder = rostopic_csv(tmp_path)
    log = tl.read_log(folder, format="rosbag-csv")
    holds(log, rates=GYRO, specific_force=FELT, position=POSITION)
    assert same_turn(log[ATTITUDE].values)
    force = {"topic": ["ft_left", "ft_right"], "columns": [f"field.wrench.force.{a}" for a in "xyz"]}
    holds(
        tl.read_log(folder, {"measured_joint_force": force}, format="rosbag-csv"),
        joint_force=np.hstack([GYRO, 2.0 * GYRO]),
    )
    holds(tl.read_log(folder / "imu_data.csv", format="rosbag-csv"), rates=GYRO)


# ---- C3D by ezc3d, MDF by asammdf


def test_a_c3d_file_has_the_places_of_its_markers(tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    made = ezc3d.c3d()
    made["parameters"]["POINT"]["RATE"]["value"] = [200.0]
    made["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    made["parameters"]["POINT"]["LABELS"]["value"] = ["Beam", "Other"]
    points = np.ones((4, 2, N))
    points[:3, 0] = 1e3 * POSITION.T
    points[:3, 0, 100:110] = np.nan  # out of sight
    made["data"]["points"] = points
    made.write(str(tmp_path / "take.c3d"))
    columns = {"measured_position": {"columns": ["Beam.X", "Beam.Y", "Beam.Z"]}}
    log = tl.read_log(tmp_path / "take.c3d", columns)
    time, values = log[MOTION[0]]
    seen = (np.arange(N) < 100) | (np.arange(N) >= 110)
    assert time == pytest.approx(TIME[seen], abs=1e-9)
    assert values == pytest.approx(POSITION[seen], abs=1e-6)
    assert any("no samples for 0.055 s from 0.495 s" in note for note in log.notes)


def test_an_mdf_file_has_groups_with_their_own_times(tmp_path):
    asammdf = pytest.importorskip("asammdf")
    made = asammdf.MDF(version="4.10")
    for values, names in ((GYRO, "pqr"), (POSITION[::4], "xyz")):
        time = 100.0 + TIME[:: N // len(values)]
        made.append([asammdf.Signal(v, time, name=name) for v, name in zip(values.T, names, strict=True)])
    made.save(tmp_path / "log.mf4")
    log = tl.read_log(
        tmp_path / "log.mf4", {"measured_rates": {"columns": [*"pqr"]}, "measured_position": {"columns": [*"xyz"]}}
    )
    assert log[RATES].values == pytest.approx(GYRO)
    assert log[MOTION[0]].time == pytest.approx(TIME[::4])
    assert log[MOTION[0]].values == pytest.approx(POSITION[::4])


def test_an_unknown_format_is_named(tmp_path):
    with pytest.raises(tl.InputError, match="unknown format 'qualisys'; there are optitrack, vicon"):
        tl.read_log(tmp_path / "log.csv", format="qualisys")


@pytest.mark.parametrize("format", ["blackbox", "crazyflie", "rosbag-csv"])
def test_a_table_of_another_program_is_refused_with_its_columns(format, tmp_path):
    (tmp_path / "log.csv").write_text("t,gx\n" + "".join(f"{0.01 * k},1\n" for k in range(50)))
    with pytest.raises(tl.InputError, match=r"has no samples for measured_rates in .*; it has the columns t, gx"):
        tl.read_log(tmp_path / "log.csv", format=format)
