"""Exported flights as files: tables, read back by Python's `csv`; order, bytes, refusals; the command."""

import csv
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exported import SAMPLES, flight_of

import tandemlift as tl
from tandemlift.apps.export import write
from tandemlift.apps.export.write import export


def check_table_of(path):
    """A table as Python's reader of such files has it: heading → numbers."""
    with path.open(encoding="ascii", newline="") as file:
        head, *rows = csv.reader(file)
    assert len(set(head)) == len(head)
    return dict(zip(head, np.array(rows, dtype=np.float64).T, strict=True))


def test_a_table_has_every_number_of_every_channel_to_the_last_bit(flight, folder):
    table = check_table_of(export(flight, folder / "flight.csv"))
    time, *columns = table.values()
    assert time.tobytes() == flight.time.tobytes()
    every = np.hstack([np.reshape(a, (SAMPLES, -1)) for a in flight.channels.values()])
    np.testing.assert_array_equal(np.stack(columns, axis=1), every)


def test_the_columns_of_a_table_are_named_by_channel_unit_and_component(flight, folder):
    table = check_table_of(export(flight, folder / "names.csv"))
    for heading, values in {
        "time[s]": flight.time,
        "position[m].z": flight["position"][:, 2],
        "attitude[1].w": flight["attitude"][:, 0],
        "euler[rad].yaw": flight["euler"][:, 2],
        "thrust[N]": flight["thrust"],
        "rotor_thrusts[N].2.1": flight["rotor_thrusts"][:, 4],
        "joint_force[N].2.x": flight["joint_force"][:, 3],
        "measured_joint_torque[N m].1.y": flight["measured_joint_torque"][:, 1],
        "payload_mass_estimate[kg]": flight["payload_mass_estimate"],
        "disturbance_angular_residual[rad/s^2].x": flight["disturbance_angular_residual"][:, 0],
    }.items():
        np.testing.assert_array_equal(table[heading], values)
    assert [h for h in table if not h.startswith("rotor_") and re.search(r"\.\d+$", h)] == []


def test_a_channel_that_is_not_ours_is_in_the_table_too(folder):
    flight = flight_of("iris")
    flight.channels["mine"] = np.ones((SAMPLES, 2))
    assert list(check_table_of(export(flight, folder / "mine.csv")))[-2:] == ["mine.1", "mine.2"]


def test_messages_lie_in_a_bag_in_the_order_of_time(flight, folder):
    from mcap.reader import NonSeekingReader

    with export(flight, folder / "order.mcap").open("rb") as file:
        times = [m.log_time for _, _, m in NonSeekingReader(file).iter_messages(log_time_order=False)]
    assert times == sorted(times)


def test_a_late_listener_gets_mission_and_fixed_frames(flight, folder):
    from mcap.reader import make_reader

    with export(flight, folder / "late.mcap").open("rb") as file:
        channels = make_reader(file).get_summary().channels.values()
    kept = {c.topic for c in channels if "durability: 1" in c.metadata["offered_qos_profiles"]}
    assert kept == {"/tandemlift/mission", "/tf_static"}


@pytest.mark.parametrize("ending", ["mcap", "bag", "csv"])
def test_the_same_flight_gives_the_same_bytes(ending, flight, tmp_path):
    first, second = export(flight, tmp_path / f"a.{ending}"), export(flight, tmp_path / "deep" / f"b.{ending}")
    assert first.read_bytes() == second.read_bytes()


def refusal(flight, path):
    """Why a flight is not exported; and that nothing is left behind."""
    with pytest.raises(tl.InputError) as caught:
        export(flight, path)
    return str(caught.value)


@pytest.mark.parametrize("name", ["flight.db3", "flight", "flight.mcap.gz", ".csv"])
def test_an_unknown_ending_is_refused_with_those_that_there_are(name, flight, tmp_path):
    message = refusal(flight, tmp_path / name)
    assert name in message
    assert ".mcap (ROS 2 bag), .bag (ROS 1 bag) or .csv (table)" in message


@pytest.mark.parametrize("ending", ["mcap", "bag"])
def test_without_its_package_a_bag_is_refused_and_a_table_is_not(ending, flight, tmp_path, monkeypatch):
    for name in [name for name in sys.modules if name.split(".")[0] == "rosbags"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "rosbags", None)
    assert "pip install 'tandemlift[export]'" in refusal(flight, tmp_path / f"flight.{ending}")
    assert list(tmp_path.iterdir()) == []
    assert export(flight, tmp_path / "flight.csv").exists()


@pytest.mark.parametrize("lost", ["position", "reference_euler", "rotor_thrusts", "push_force"])
def test_a_flight_without_a_channel_that_a_bag_needs_is_refused_by_its_name(lost, flight, tmp_path):
    less = replace(flight, channels={k: v for k, v in flight.channels.items() if k != lost})
    message = refusal(less, tmp_path / "flight.bag")
    assert f"has no channel {lost!r}" in message
    assert list(tmp_path.iterdir()) == []
    assert export(less, tmp_path / "flight.csv").exists()


def test_a_channel_of_a_wrong_size_is_refused(flight, tmp_path):
    wrong = replace(flight, channels={**flight.channels, "joint_force": np.zeros((SAMPLES, 3))})
    assert "'joint_force' has 3 columns, not 6" in refusal(wrong, tmp_path / "flight.mcap")


def test_a_mission_without_a_vehicle_is_refused(flight, tmp_path):
    mission = {k: v for k, v in flight.mission.items() if k != "vehicle"}
    assert "vehicle cannot be read" in refusal(replace(flight, mission=mission), tmp_path / "flight.mcap")


def test_a_flight_of_no_sample_is_refused(flight, tmp_path):
    empty = replace(flight, time=np.zeros(0), channels={k: v[:0] for k, v in flight.channels.items()})
    assert "no sample" in refusal(empty, tmp_path / "flight.csv")


@pytest.mark.parametrize("ending", ["mcap", "bag", "csv"])
def test_what_cannot_be_written_leaves_what_was_there(ending, flight, tmp_path, monkeypatch):
    old = tmp_path / f"old.{ending}"
    old.write_text("mine")
    (tmp_path / f"folder.{ending}").mkdir()
    assert "it is a folder" in refusal(flight, tmp_path / f"folder.{ending}")
    assert "cannot be written" in refusal(flight, old / f"below.{ending}")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(write, "_write", full)
    monkeypatch.setattr("tandemlift.apps.export.csv_file.headings", full)
    assert "cannot be written: No space left on device" in refusal(flight, old)
    assert old.read_text() == "mine"
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"folder.{ending}", old.name]


@pytest.mark.parametrize("given", ["saved", "saved/flight.npz"])
def test_a_saved_flight_is_exported_by_its_file_or_its_folder(given, flight, run, tmp_path):
    flight.save(tmp_path / "saved" / "flight.npz")
    assert run("export", given, "--out", "there/it.csv") == (0, f"iris: {Path('there/it.csv')} (0.2 MB)\n", "")
    np.testing.assert_array_equal(check_table_of(tmp_path / "there" / "it.csv")["time[s]"], flight.time)


@pytest.mark.parametrize(
    ("arguments", "piece"),
    [
        (("iris", "--out", "iris.mcap"), "iris is no saved flight: give flight.npz"),
        (("absent.npz", "--out", "iris.mcap"), "absent.npz: No such file"),
        (("absent.npz", "--out", "iris.xls"), "iris.xls: must end in .mcap"),
        (("absent.npz",), "Missing option '--out'"),
    ],
)
def test_the_command_refuses_what_it_cannot_export(arguments, piece, run, tmp_path):
    code, out, err = run("export", *arguments)
    assert (code, out) == (2, "")
    assert piece in err
    assert list(tmp_path.iterdir()) == []


def test_a_missing_number_is_read_as_a_number_by_readers_of_tables(flight, folder):
    """`nan` makes the column text in polars; `NaN` is a number to pandas, polars, DuckDB and pyarrow."""
    path = export(flight, folder / "missing.csv")
    cells = [line.split(",") for line in path.read_text("utf-8").splitlines()]
    column = cells[0].index("measured_velocity[m/s].x")
    assert cells[1 + 3][column] == "NaN"
    assert "nan" not in {cell for row in cells[1:] for cell in row}
    pandas, arrow = pytest.importorskip("pandas"), pytest.importorskip("pyarrow.csv")
    for values in (pandas.read_csv(path).iloc[:, column].to_numpy(), arrow.read_csv(path).column(column).to_numpy()):
        np.testing.assert_array_equal(values, flight["measured_velocity"][:, 0])


@pytest.mark.parametrize("name", ["fl", "flight.npz", "fl.v2"])
def test_what_save_writes_under_any_name_export_and_logs_read(name, tmp_path, run):
    flight = tl.fly(tl.load_mission("iris", {"mission.duration": 0.05, "mission.log_interval": 0.001}))
    assert flight.save(tmp_path / name) == tmp_path / name
    code, out, err = run("export", name, "--out", "fl.csv")
    assert (code, err) == (0, "")
    assert "iris: fl.csv" in out
    assert tl.read_log(tmp_path / name).rate("measured_rates") == pytest.approx(1000.0)
