"""`tandemlift shadow`: a log by its file, with a map, on another clock, through the pilot of a mission."""

import numpy as np
import pandas
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, log_of
from tandemlift.apps.cli.main import cli
from tandemlift.flight.channels import FLOWN

FINE = {"mission.duration": 9.0, "mission.log_interval": 0.001}
MAP = """
time = "t"
[measured_specific_force]
columns = ["f0", "f1", "f2"]
[measured_rates]
columns = ["w0", "w1", "w2"]
unit = "deg/s"
[measured_position]
columns = ["p0", "p1", "p2"]
time = "t_motion"
[measured_velocity]
columns = ["v0", "v1", "v2"]
time = "t_motion"
[measured_attitude]
columns = ["q0", "q1", "q2", "q3"]
time = "t_motion"
[measured_joint_force]
columns = ["F0", "F1", "F2", "F3", "F4", "F5"]
[measured_joint_torque]
columns = ["T0", "T1", "T2", "T3", "T4", "T5"]
[rotor_commands]
columns = ["u0", "u1", "u2", "u3", "u4", "u5", "u6", "u7"]
"""
LETTERS = dict(zip("fwFTpvqu", (*IMU, *JOINTS, *MOTION, COMMANDS), strict=True))
LATE = 0.15  # s: the clock of motion capture


@pytest.fixture(scope="module")
def flown():
    return tl.fly(tl.load_mission("iris", FINE))


@pytest.fixture(scope="module")
def table(flown, tmp_path_factory):
    """The folder of the flight's log as a table, whose motion capture has another clock, and of its map."""
    folder, log, columns = tmp_path_factory.mktemp("log"), log_of(flown), {}
    for letter, name in LETTERS.items():
        time, values = log[name]
        values = np.degrees(values) if letter == "w" else values
        columns |= {f"{letter}{i}": pandas.Series(v, np.round(time, 6)) for i, v in enumerate(values.T)}
    frame = pandas.DataFrame(columns)
    frame.insert(0, "t", frame.index)
    frame.insert(1, "t_motion", frame.index + LATE)
    frame.to_csv(folder / "flight.csv", index=False)
    (folder / "map.toml").write_text(MAP)
    return folder


def call(*arguments):
    return CliRunner().invoke(cli, ["shadow", *map(str, arguments)])


@pytest.mark.thorough
def test_a_table_on_two_clocks_is_shadowed_and_its_files_are_written(table, tmp_path):
    out = tmp_path / "out"
    options = ["--columns", table / "map.toml", "--mission", "iris", "--align", "--no-figures", "--out", out]
    result = call(table / "flight.csv", *options)
    assert result.exit_code == 0, result.output
    assert "motion: offset -1" in result.output, "−150 ms, to some milliseconds"
    assert "commands beside the flown, RMS" in result.output
    shadow = tl.Flight.load(out)
    assert {file.name for file in out.iterdir()} >= {"mission.toml", "flight.npz", "findings.json", "report.html"}
    assert shadow.info(FLOWN).unit == "N"
    hover = shadow.time > 5.0
    assert np.sqrt(np.mean((shadow["rotor_commands"] - shadow[FLOWN])[hover] ** 2)) < 0.3
    handles = tl.plot(shadow, "rotors").legends[0].get_texts()
    assert [text.get_text() for text in handles][:2] == ["flown", "commanded"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["flight.csv", "--mission", "iris"], "needs a map"),
        (["flight.csv", "--mission", "iris", "--columns", "none.toml"], "none.toml"),
        (["flight.doc", "--mission", "iris"], "must be a flight"),
        (
            ["flight.csv", "--columns", "map.toml", "--mission", "paper", "--set", "pilot.push=truth"],
            "has no push_force",
        ),
    ],
)
def test_bad_input_is_refused_and_nothing_is_written(table, monkeypatch, arguments, message):
    monkeypatch.chdir(table)
    result = call(*arguments)
    assert result.exit_code != 0
    assert message in str(result.exception)
    assert not (table / "out").exists()
