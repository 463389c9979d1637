"""Tables, bags and ULogs with one mistake each, drawn at random, are refused or read right: never a wrong number."""

import csv
import io
import struct

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.spatial.transform import Rotation

import tandemlift as tl

N, STEP = 1500, 0.002
TRUE = np.arange(N) * STEP  # s
RATES = {"columns": ["gx", "gy", "gz"]}
MAP = {"time": "t", "measured_rates": RATES}


def motion(time):
    """Rates whose first column tells the time, so that stamps can be checked by values."""
    return np.column_stack([0.1 * time, np.sin(3.0 * time), np.cos(3.0 * time)])


def is_right(log, *, least=0.75):
    """Whether every sample has the values of its time; it may have fewer samples, as gaps tell."""
    time, values = log["measured_rates"]
    taken = 10.0 * values[:, 0]
    same = np.ptp(time - taken) < 2e-6 and np.allclose(values, motion(taken), atol=1e-6)
    return same and len(time) >= least * N


def lines(time=TRUE, separator=",", tail="", *, decimal="."):
    rows = np.column_stack([time, motion(TRUE)])
    return [separator.join(f"{x:.9f}" for x in row).replace(".", decimal) + tail for row in rows]


def read(path, text, encoding="utf-8", columns=MAP):
    path.write_bytes((text if isinstance(text, str) else "\n".join(text) + "\n").encode(encoding))
    return tl.read_log(path, columns)


HEAD = "t,gx,gy,gz"
FORMS = {
    "plain": lambda: [HEAD, *lines()],
    "windows lines": lambda: "\r\n".join([HEAD, *lines()]) + "\r\n",
    "empty lines": lambda: ["", HEAD, "", *lines()[:700], "", *lines()[700:], ""],
    "comments": lambda: ["# a rig", "% of ours", HEAD, *lines()[:9], "# here it began to fly", *lines()[9:]],
    "names in a comment": lambda: ["# " + HEAD, *lines()],
    "units below": lambda: [HEAD, "s,rad/s,rad/s,rad/s", *lines()],
    "units in brackets below": lambda: [HEAD, "[s],[rad/s],[rad/s],[rad/s]", *lines()],
    "facts above": lambda: ["Rig,3", "Flight of 2026,7,8", "", HEAD, *lines()],
    "text column": lambda: [HEAD + ",mode", *lines(tail=",ANGLE|ARM")],
    "quoted text with commas": lambda: [HEAD + ",note", *lines(tail=',"a, b"')],
    "semicolons": lambda: [HEAD.replace(",", ";"), *lines(separator=";")],
    "semicolons and commas": lambda: [HEAD.replace(",", ";"), *lines(separator=";", decimal=",")],
    "quoted commas": lambda: [HEAD, *('"' + row + '"' for row in lines(separator='","', decimal=","))],
    "facts above, as many": lambda: [*(f'"fact {k}",{k}' for k in range(200)), HEAD, *lines()],
    "tabs": lambda: [HEAD.replace(",", "\t"), *lines(separator="\t")],
    "tabs and commas": lambda: [HEAD.replace(",", "\t"), *lines(separator="\t", decimal=",")],
    "blanks": lambda: ["  t   gx gy  gz", *lines(separator="   ")],
    "blanks after commas": lambda: ["t, gx, gy, gz", *lines(separator=", ")],
    "a comma at the end": lambda: [HEAD, *lines(tail=",")],
    "cut within its last line": lambda: "\n".join([HEAD, *lines()])[:-25],
    "empty cells of another clock": lambda: [HEAD + ",p", *lines(tail=",")],
    "words for no number": lambda: [
        HEAD,
        *lines(),
        *(f"{TRUE[-1] + k * STEP:.9f},{w},{w},{w}" for k, w in enumerate(["", "nan", "NULL", "n/a"], 1)),
    ],
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
@pytest.mark.parametrize("form", FORMS)
def test_a_table_is_read_in_whatever_form_programs_write_it(form, encoding, tmp_path):
    assert is_right(read(tmp_path / "log.csv", FORMS[form](), encoding))


def test_a_table_in_windows_letters_is_read_with_a_note(tmp_path):
    log = read(
        tmp_path / "log.csv",
        ["t,größe [°],gx,gy,gz", *(f"{row.split(',')[0]},1,{row.partition(',')[2]}" for row in lines())],
        "cp1252",
    )
    assert is_right(log)
    assert any("cp1252" in note for note in log.notes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,gx,gy,gz\n0,1\n", "line 2 has 2 cells, the line of names 4"),
        ("t,gx,gy,gz\n0,0,1,5,2,5,3,5\n", "line 2 has 8 cells, .*; a comma as decimal sign and separator"),
        ("t,gx,gy,gz\n0,1,2,3\n0.1,1,?,3\n", "line 3: could not convert string to float: '\\?'"),
        ("t;gx;gy;gz\n1,000;1,234;2,345;3,456\n", "is 1,234 a number of thousands. Say decimal"),
        ("t,gx,gy,gz\n", "has no line of numbers"),
        ("", "has no line of names"),
        ("a;b\n1;2\n", "unknown column .*; there are a, b"),
        ("t,gx,gy,gz,gx\n0,1,2,3,4\n", "has 2 columns gx: one that is read must have its own name; names_line"),
        ("t,gx (deg/s),gy,gz\n0,1,2,3\n", "unknown column 'gx'; there are t, gx .deg/s., gy"),
        ("t,gx,gy,gz\ns,deg/s,deg/s,deg/s\n0,1,2,3\n", 'column gx is in deg/s, by the table: say unit = "deg/s"'),
        ("t,gx,gy,gz\nms,rad/s,rad/s,rad/s\n0,1,2,3\n", 'column t is in ms, by the table: say time_unit = "ms"'),
    ],
)
def test_a_table_that_does_not_fit_is_refused_with_the_line_and_the_way_on(text, message, tmp_path):
    with pytest.raises(tl.InputError, match=message):
        read(tmp_path / "log.csv", text)


def test_several_lines_of_names_are_joined(tmp_path):
    text = [",Left,,,Right,,", "t,x,y,z,x,y,z", *(row + ",7,8,9" for row in lines())]
    map_ = {"names_line": [1, 2], "time": "t", "measured_rates": {"columns": ["Left.x", "Left.y", "Left.z"]}}
    assert is_right(read(tmp_path / "log.csv", text, columns=map_))
    with pytest.raises(tl.InputError, match=r"names_line = \[1, 9000\]: there are"):
        read(tmp_path / "log.csv", text, columns=map_ | {"names_line": [1, 9000]})
    with pytest.raises(tl.InputError, match=r'separator = "x": must be ",", ";"'):
        read(tmp_path / "log.csv", text, columns=map_ | {"separator": "x"})


@pytest.mark.parametrize("unit", ["rad", "deg"])
@pytest.mark.parametrize("kind", ["xyz", "ZYX", "zxy", "XYX", "rotation vector"])
def test_an_attitude_in_angles_is_that_of_scipy(kind, unit, tmp_path):
    turn = Rotation.from_euler("ZYX", np.column_stack([3.0 + TRUE, 0.3 * np.sin(TRUE), 0.2 * np.cos(TRUE)]))
    angles = turn.as_rotvec() if kind == "rotation vector" else turn.as_euler(kind)  # yaw wraps
    rows = np.column_stack([TRUE, np.degrees(angles) if unit == "deg" else angles])
    text = "t,a,b,c\n" + "\n".join(",".join(map(repr, row)) for row in rows.tolist())
    map_ = {"time": "t", "measured_attitude": {"columns": ["a", "b", "c"], "angles": kind, "unit": unit}}
    found = read(tmp_path / "log.csv", text, columns=map_)["measured_attitude"].values
    assert np.abs(np.sum(found * turn.as_quat(scalar_first=True), axis=1)) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("angles", ["xy", "xxy", "xYz", "abc", "rotation"])
def test_angles_that_are_no_order_are_refused(angles, tmp_path):
    map_ = {"time": "t", "measured_attitude": {"columns": ["gx", "gy", "gz"], "angles": angles}}
    with pytest.raises(tl.InputError, match=f'measured_attitude.angles = "{angles}": .* "xyz" for roll, pitch, yaw'):
        read(tmp_path / "log.csv", FORMS["plain"](), columns=map_)


def test_a_world_with_y_up_and_an_offset_are_turned_into_ours(tmp_path):
    map_ = {"time": "t", "measured_position": {"columns": ["gx", "gy", "gz"], "up": "y", "offset": 1.0, "scale": 2.0}}
    x, y, z = 2.0 * (motion(TRUE).T + 1.0)
    found = read(tmp_path / "log.csv", FORMS["plain"](), columns=map_)["measured_position"].values
    assert found == pytest.approx(np.column_stack([x, -z, y]), abs=1e-8)


# ---- One mistake in the stamps, drawn at random

RNG = np.random.default_rng(54)


def row():
    return int(RNG.integers(30, N - 30))


def changed(change):
    time = TRUE + float(RNG.uniform(1.0, 4000.0))
    return change(time.copy(), row())


def put(time, at, value):
    time[at] = value
    return time


MISTAKES = {
    "zero": lambda: changed(lambda t, k: put(t, k, 0.0)),
    "zeros": lambda: changed(lambda t, k: put(t, slice(k, k + 5), 0.0)),
    "zero at the end": lambda: changed(lambda t, k: put(t, -1, 0.0)),
    "empty": lambda: changed(lambda t, k: put(t, k, np.nan)),
    "negative": lambda: changed(lambda t, k: put(t, k, -1.0)),
    "beyond": lambda: changed(lambda t, k: put(t, k, 1e9)),
    "beyond at the end": lambda: changed(lambda t, k: put(t, -1, 1e9)),
    "two rows exchanged": lambda: changed(lambda t, k: put(t, [k, k + 1], t[[k + 1, k]])),
    "clock set back": lambda: changed(lambda t, k: np.where(np.arange(N) >= k, t - RNG.uniform(0.01, 900.0), t)),
    "logger began again": lambda: changed(lambda t, k: np.where(np.arange(N) >= k, t - t[k], t)),
    "twice": lambda: changed(lambda t, k: put(t, k, t[k - 1])),
    "coarse": lambda: changed(lambda t, k: np.floor(t / 0.02) * 0.02),
    "constant": lambda: changed(lambda t, k: put(t, slice(k, None), t[k])),
    "milliseconds": lambda: changed(lambda t, k: 1e3 * t),
    "microseconds": lambda: changed(lambda t, k: 1e6 * t),
    "nanoseconds": lambda: changed(lambda t, k: 1e9 * t),
    "minutes": lambda: changed(lambda t, k: t / 60.0),
    "counter of 32 bits": lambda: changed(lambda t, k: (t - t[k] + 2**32 * 1e-6) % (2**32 * 1e-6)),
    "counter of 24 bits": lambda: changed(lambda t, k: (t - t[k] + 2**24 * 1e-3) % (2**24 * 1e-3)),
    "counter of 16 bits": lambda: changed(lambda t, k: (t - t[k] + 65.536) % 65.536),
    "backwards": lambda: changed(lambda t, k: t[::-1]),
}


@pytest.mark.parametrize("draw", range(8))
@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_the_stamps_is_refused_or_mended_right(mistake, draw, tmp_path):
    rows = np.column_stack([MISTAKES[mistake](), motion(TRUE)])
    text = io.StringIO()
    csv.writer(text).writerows([HEAD.split(","), *([f"{x:.9f}" if np.isfinite(x) else "" for x in r] for r in rows)])
    try:
        log = read(tmp_path / "log.csv", text.getvalue())
    except tl.InputError as error:
        refused = str(error)
    else:
        assert is_right(log)
        assert len(log.notes) >= 1
        return
    assert "stream measured_rates" in refused
    assert mistake not in ("zero", "empty", "twice", "counter of 32 bits", "counter of 24 bits")


def test_a_table_of_streams_one_below_the_other_is_read(tmp_path):
    """Each stream is in order; the column of stamps is not."""
    left = [row + "," * 3 for row in lines()]
    right = [f"{row.split(',')[0]},,,,{row.partition(',')[2]}" for row in lines()]
    map_ = MAP | {"measured_position": {"columns": ["x", "y", "z"]}}
    log = read(tmp_path / "log.csv", [HEAD + ",x,y,z", *left, *right], columns=map_)
    assert is_right(log)
    assert log["measured_position"].time == pytest.approx(TRUE)


# ---- Bags


SPEEDS = {"rotor_speed_commands": {"topic": "/speeds", "columns": ["speed"]}}
WRENCH = {"measured_joint_force": {"topic": ["/ft1", "/ft2"], "columns": ["wrench.force.x"] * 3}}


def bag(folder, stamps, kind="rig_msgs/msg/Speeds", late=0.001):
    """A bag with a message of its own: header stamps [s] by topic; messages arrive `late` [s] after they were due."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg("std_msgs/Header header\nfloat64[] speed\n", kind))
    t = store.types
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        own = {
            topic: writer.add_connection(
                topic, kind if topic == "/speeds" else "geometry_msgs/msg/WrenchStamped", typestore=store
            )
            for topic in stamps
        }
        for k in range(500):
            for topic, times in stamps.items():
                header = t["std_msgs/msg/Header"](
                    t["builtin_interfaces/msg/Time"](*divmod(round(1e9 * times[k]), 10**9)), ""
                )
                vector = t["geometry_msgs/msg/Vector3"](float(k), 0.0, 0.0)
                message = (
                    t[kind](header, 100.0 + np.arange(8.0) + k)
                    if topic == "/speeds"
                    else t["geometry_msgs/msg/WrenchStamped"](header, t["geometry_msgs/msg/Wrench"](vector, vector))
                )
                at = round(1e9 * (1.7e9 + 0.004 * k + late))
                writer.write(own[topic], at, store.serialize_cdr(message, message.__msgtype__))
    return folder


DUE = 1.7e9 + 0.004 * np.arange(500)


def test_a_single_mcap_is_read_by_the_definitions_that_are_in_it(tmp_path):
    folder = bag(tmp_path / "own", {"/speeds": DUE})
    for path in (folder, next(folder.glob("*.mcap"))):
        time, values = tl.read_log(path, SPEEDS)["rotor_speed_commands"]
        assert time == pytest.approx(0.004 * np.arange(500), abs=1e-6)
        assert values[:, 7] == pytest.approx(107.0 + np.arange(500))


def test_a_bag_that_was_cut_says_so_and_how_to_recover_it(tmp_path):
    folder = bag(tmp_path / "cut", {"/speeds": DUE})
    file = next(folder.glob("*.mcap"))
    file.write_bytes(file.read_bytes()[:-500])
    for path in (folder, file):
        with pytest.raises(tl.InputError, match=r"is cut: its end is missing.*`mcap recover cut\.mcap -o whole\.mcap`"):
            tl.read_log(path, SPEEDS)
    (folder / "metadata.yaml").unlink()
    whole = bag(tmp_path / "whole", {"/speeds": DUE})
    (whole / "metadata.yaml").unlink()
    with pytest.raises(tl.InputError, match=r"has no metadata\.yaml.*give the file whole\.mcap"):
        tl.read_log(whole, SPEEDS)


def test_a_topic_of_the_users_own_list_that_is_missing_is_named(tmp_path):
    folder = bag(tmp_path / "one", {"/speeds": DUE, "/ft1": DUE})
    with pytest.raises(tl.InputError, match="measured_joint_force: has no samples in /ft2; it has /ft1, /speeds"):
        tl.read_log(folder, SPEEDS | WRENCH)


def test_a_topic_that_pauses_after_its_first_message_keeps_it(tmp_path):
    stamps = np.concatenate([DUE[:1], DUE[1:] + 2.0])
    log = tl.read_log(bag(tmp_path / "pause", {"/speeds": stamps}), SPEEDS)
    assert log["rotor_speed_commands"].values[0, 0] == 100.0
    assert log.notes == ("rotor_speed_commands: no samples for 2 s from 0 s",)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_our_own_topics_are_read_of_as_many_joints_as_there_are(count, tmp_path):
    joints = {f"/tandemlift/joint_{i + 1}/measured": DUE for i in range(count)}
    log = tl.read_log(bag(tmp_path / "ours", joints))
    assert log["measured_joint_force"].values == pytest.approx(np.outer(np.arange(500), [1.0, 0.0, 0.0] * count))


@pytest.mark.parametrize("zeros", [slice(None), slice(0, 400), slice(7, 9)])
def test_headers_without_a_stamp_are_taken_by_arrival_or_left_out(zeros, tmp_path):
    stamps = DUE.copy()
    stamps[zeros] = 0.0
    log = tl.read_log(bag(tmp_path / "zero", {"/speeds": DUE, "/ft1": stamps, "/ft2": DUE}), SPEEDS | WRENCH)
    time, values = log["measured_joint_force"]
    few = zeros == slice(7, 9)
    assert len(time) == (498 if few else 499)  # arrivals are late: the last one is after the last of the other topic
    assert time - log["rotor_speed_commands"].time[0] == pytest.approx(
        0.004 * values[:, 0] + 0.001 * (not few), abs=2e-6
    )
    said = "left out" if few else "those in arrival are taken"
    assert any("/ft1" in note and said in note for note in log.notes)


def test_stamps_of_a_topic_that_go_back_are_refused_and_not_sorted(tmp_path):
    stamps = np.where(np.arange(500) >= 250, DUE - 0.3, DUE)
    with pytest.raises(tl.InputError, match=r"rotor_speed_commands: /speeds: row 250 is at .* times must increase"):
        tl.read_log(bag(tmp_path / "back", {"/speeds": stamps}), SPEEDS)


# ---- ULogs, by the definition of the format


def ulog(path, topics):
    """Topics: name → (fields, struct's letters, rows); the first field is the timestamp."""
    parts = [b"\x55\x4c\x6f\x67\x01\x12\x35\x01" + struct.pack("<Q", 0), struct.pack("<HB", 40, ord("B")) + bytes(40)]
    events = []
    for number, (name, (fields, letters, rows)) in enumerate(topics.items()):
        text = f"{name}:{fields};".encode()
        parts.append(struct.pack("<HB", len(text), ord("F")) + text)
        parts.append(struct.pack("<HBBH", 3 + len(name), ord("A"), 0, number) + name.encode())
        events += [struct.pack("<H", number) + struct.pack("<" + letters, *row) for row in rows]
    path.write_bytes(b"".join([*parts, *(struct.pack("<HB", len(e), ord("D")) + e for e in events)]))
    return path


STAMPS = [5_000_000 + 4000 * k for k in range(500)]


def test_the_accelerometer_of_a_ulog_has_its_own_stamps(tmp_path):
    """`accelerometer_timestamp_relative`: to the gyroscope's; 2³¹ − 1 is a reading that is not there."""
    fields = "uint64_t timestamp;float[3] gyro_rad;int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2"
    late = [2**31 - 1 if k == 100 else -1500 - k % 3 for k in range(500)]
    rows = [(at, 0.1, 0.2, float(k % 7), late[k], float(k), 0.0, -9.8) for k, at in enumerate(STAMPS)]
    log = tl.read_log(ulog(tmp_path / "a.ulg", {"sensor_combined": (fields, "Q3fi3f", rows)}))
    time, values = log["measured_specific_force"]
    kept = np.delete(np.arange(500), 100)
    assert values[:, 0] == pytest.approx(kept)
    expected = 1e-6 * np.delete(np.array(STAMPS) + np.array(late), 100)
    assert time - time[0] == pytest.approx(expected - expected[0], abs=1e-9)
    assert log["measured_rates"].time[0] - time[0] == pytest.approx(0.0015, abs=1e-9)


@pytest.mark.parametrize("frame", [0, 1, 2, 3])
def test_a_velocity_in_the_bodys_axes_is_turned_by_its_frame(frame, tmp_path):
    fields = "uint64_t timestamp;uint64_t timestamp_sample;float[3] position;float[4] q;float[3] velocity"
    fields += ";uint8_t velocity_frame"
    turn = Rotation.from_rotvec(np.outer(0.01 * np.arange(500), [0.0, 0.0, 1.0]))
    seen = turn.inv().apply([1.0, 2.0, 0.5]) if frame == 3 else np.tile([1.0, 2.0, 0.5], (500, 1))
    q = turn.as_quat(scalar_first=True)
    rows = [(at, at - 900, 0.0, 0.0, float(k), *q[k], *seen[k], frame) for k, at in enumerate(STAMPS)]
    log = tl.read_log(ulog(tmp_path / "v.ulg", {"vehicle_visual_odometry": (fields, "QQ10fB", rows)}))
    assert log["measured_velocity"].values == pytest.approx(np.tile([1.0, -2.0, -0.5], (500, 1)), abs=1e-6)


def test_resets_that_px4_counts_are_noted_with_their_size(tmp_path):
    fields = "uint64_t timestamp;float x;float y;float z;float[2] delta_xy;uint8_t xy_reset_counter"
    rows = [(at, 0.0, 0.0, 0.0, 0.3 * (k >= 200), 0.4 * (k >= 200), k >= 200) for k, at in enumerate(STAMPS)]
    log = tl.read_log(ulog(tmp_path / "r.ulg", {"vehicle_local_position": (fields, "Q5fB", rows)}))
    assert log.notes == ("the estimate was reset: measured_position at 0.8 s by 0.5 m",)
    assert log.breaks == (pytest.approx(0.8),)


def test_stamps_of_a_sensor_that_are_zero_give_way_to_those_of_the_logger(tmp_path):
    fields = "uint64_t timestamp;uint64_t timestamp_sample;float[3] xyz"
    rows = [(at, 0, float(k), 0.0, 0.0) for k, at in enumerate(STAMPS)]
    log = tl.read_log(ulog(tmp_path / "z.ulg", {"vehicle_angular_velocity": (fields, "QQ3f", rows)}))
    assert log["measured_rates"].time == pytest.approx(0.004 * np.arange(500))
    assert any("vehicle_angular_velocity: its stamps in timestamp_sample are empty or 0" in note for note in log.notes)
