"""What was written before keys were renamed is read as before, with a notice; no old name is left anywhere else."""

import sys
import tomllib
import warnings

import pytest
import tomli_w
from click.testing import CliRunner
from mission_schema import SCHEMA
from patience import completed
from repository import SUPPORT

import tandemlift as tl
from tandemlift.cli.main import cli
from tandemlift.flight.old_names import KEYS, VALUES, renamed_key, renamed_tables
from tandemlift.missions import built_in, load_mission, tables_of

OF_E5ECFDC = SUPPORT / "names_of_e5ecfdc.toml"
TANDEMLIFT = (sys.executable, "-m", "tandemlift")
PROMISED = """
mission.name mission.duration mission.step mission.log_interval mission.seed
vehicle.payload.mass vehicle.payload.length vehicle.payload.radius vehicle.payload.inertia
vehicle.quadrotors.0.mass vehicle.quadrotors.0.inertia vehicle.quadrotors.0.position vehicle.quadrotors.0.layout
vehicle.quadrotors.0.arm vehicle.quadrotors.0.thrust_constant vehicle.quadrotors.0.max_speed
vehicle.quadrotors.0.torque_per_thrust vehicle.quadrotors.0.lag_up vehicle.quadrotors.0.lag_down
vehicle.drag.force vehicle.drag.moment
controller.name controller.gains.xi controller.gains.eta controller.gains.lambda_1 controller.gains.lambda_2
controller.gains.a controller.switching controller.boundary_layer controller.attitude_reference_derivatives
controller.filter_bandwidth controller.euler_rates controller.tilt_inverse controller.human_force_feedforward
admittance.mass admittance.damping admittance.stiffness admittance.threshold admittance.gate admittance.reanchor
allocation.method allocation.weights
initial.position initial.velocity initial.euler initial.rates
phases.lift_start phases.lift_duration phases.height phases.land_start phases.land_duration
pushes.0.force pushes.0.time pushes.0.sigma pushes.0.point
disturbance.force disturbance.moment plant.mass_scale plant.inertia_scale actuators.model
"""


def places(tables, above=()):
    """Every key of nested tables, dotted, without the numbers of list entries; tables as well."""
    for key, value in tables.items():
        yield ".".join((*above, key))
        for inner in value if isinstance(value, list) else [value]:
            if isinstance(inner, dict):
                yield from places(inner, (*above, key))


def by_old_names(tables, above=()):
    """Tables by the names that their keys had before."""
    old = {new: old.rpartition(".")[2] for old, new in KEYS.items()}
    named = {}
    for key, value in tables.items():
        place = (*above, key)
        if isinstance(value, dict):
            value = by_old_names(value, place)
        elif isinstance(value, list):
            value = [by_old_names(v, place) if isinstance(v, dict) else v for v in value]
        named[old.get(".".join(place), key)] = value
    return named


def loaded(path, changes=None):
    """A mission, and the notices of what was renamed in it."""
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        mission = load_mission(path, changes)
    return mission, [str(w.message) for w in seen if "renamed" in str(w.message)]


def test_the_keys_that_the_design_promises_keep_their_names():
    promised = PROMISED.split()
    assert set(promised) <= set(SCHEMA)
    assert [renamed_key(key) for key in promised] == promised


def test_every_new_name_is_a_key_and_no_old_one_is():
    known = set(places({"mission": 0}))
    for key in SCHEMA:
        parts = [part for part in key.split(".") if not part.isdigit()]
        known |= {".".join(parts[: i + 1]) for i in range(len(parts))}
    assert set(KEYS.values()) <= known
    assert not set(KEYS) & known
    assert len(set(KEYS.values())) == len(KEYS)


def test_every_key_of_e5ecfdc_is_read_by_its_new_name():
    old = tomllib.loads(OF_E5ECFDC.read_text("utf-8"))
    assert set(KEYS) <= set(places(old)), "the file has every name that was changed"
    mission, notices = loaded(OF_E5ECFDC)
    (notice,) = notices  # in one line
    _, each = renamed_tables(old)
    assert {f"{before} was renamed to {now}" for before, now in KEYS.items()} <= set(each)
    assert all(one in notice for one in each[:3])
    assert each[3] not in notice
    assert f"and {len(each) - 3} others were renamed; `tandemlift explain OLD_KEY` prints a new name" in notice
    assert mission.sensor_faults[0].sensor == VALUES["sensor_faults.sensor"]["unit"] == "imu"
    assert mission.changes[0].key == "compliance.bias_time_constant"
    given = tables_of(mission)
    assert given["person"]["landing_speed"] == old["partner"]["slow"]
    assert given["supervision"]["watchdog"]["max_force"] == old["supervision"]["watch"]["force"]
    assert given["detection"]["bias_bandwidth"] == old["detection"]["forget"]
    assert given["compliance"]["tank"]["capacity"] == old["compliance"]["tank"]["size"]


@pytest.mark.parametrize("name", built_in())
def test_a_mission_by_its_old_names_is_the_same_mission(name, tmp_path):
    mission, file = load_mission(name), tmp_path / "old.toml"
    old = by_old_names(tables_of(mission))
    assert "partner" in old
    assert "person" not in old
    file.write_text(tomli_w.dumps(old), "utf-8")
    again, notices = loaded(file)
    assert again == mission
    assert len(notices) == 1


def test_a_file_of_old_names_may_extend_a_mission_of_new_ones(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('extends = "zigzag"\n[partner]\nslow = 0.2\n[compliance]\nhearing = 50.0\n', "utf-8")
    mission, (notice,) = loaded(file)
    assert (mission.person.landing_speed, mission.compliance.input_bandwidth) == (0.2, 50.0)
    assert mission.person.start_time == load_mission("zigzag").person.start_time
    assert notice.startswith(f"{file}: partner was renamed to person, partner.slow was renamed to person.landing_speed")


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("[compliance]\nhearing = 30.0\ninput_bandwidth = 30.0\n", "compliance.hearing and compliance.input_bandwidth"),
        ("[partner]\nspeed = 1.0\n[person]\nspeed = 1.0\n", "partner and person"),
        (
            "[supervision.watch]\nstale = 0.2\nstale_time = 0.2\n",
            "supervision.watch.stale and supervision.watchdog.stale_time",
        ),
    ],
)
def test_an_old_and_a_new_name_at_once_are_refused(tmp_path, text, names):
    file = tmp_path / "both.toml"
    file.write_text(f'extends = "iris"\n{text}', "utf-8")
    run = completed([*TANDEMLIFT, "run", str(file), "--out", str(tmp_path / "out")], capture_output=True, text=True)
    assert run.returncode == 2
    assert run.stderr.startswith(f"error: {file}: {names}: must not both be given")
    assert not (tmp_path / "out").exists()


def test_a_setting_by_its_old_name_is_set_with_a_notice(tmp_path):
    changes = {"compliance.hearing": 40.0, "partner.path": [{"point": [1.0, 0.0]}], "supervision.watch": {"stale": 0.2}}
    mission, notices = loaded("zigzag", changes)
    assert mission.compliance.input_bandwidth == 40.0
    assert mission.person.path[0].point == (1.0, 0.0)
    assert mission.supervision.watchdog.stale_time == 0.2
    assert notices[0] == "zigzag: compliance.hearing was renamed to compliance.input_bandwidth"
    with pytest.raises(tl.InputError, match=r"compliance\.hearing and compliance\.input_bandwidth: must not both"):
        load_mission("iris", {"compliance.hearing": 40.0, "compliance.input_bandwidth": 41.0})


def test_a_choice_by_its_old_name_is_read_with_a_notice():
    fault = {"sensor": "unit", "kind": "stale", "time": 3.0}
    mission, notices = loaded("iris", {"sensor_faults": [fault]})
    assert mission.sensor_faults[0].sensor == "imu"
    assert notices == ['iris: sensor_faults.sensor = "unit" was renamed to "imu"']


def test_the_command_line_says_what_was_renamed_in_one_line(tmp_path):
    out = str(tmp_path / "out")
    settings = ["--set", "compliance.hearing=40", "--set", "mission.duration=0.02", "--no-figures"]
    run = completed([*TANDEMLIFT, "run", "one-push", "--out", out, *settings], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    said = [line for line in run.stderr.splitlines() if "renamed" in line]
    assert said == ["warning: one-push: compliance.hearing was renamed to compliance.input_bandwidth"]
    assert "input_bandwidth = 40" in (tmp_path / "out" / "mission.toml").read_text("utf-8")


def test_a_flight_of_before_the_renames_is_read_by_the_new_names(tmp_path):
    flight = tl.fly(load_mission("one-push", {"mission.duration": 0.1}))
    old = tl.Flight(
        flight.time, flight.channels, by_old_names(flight.mission), flight.results, flight.ending, flight.version
    )
    file = old.save(tmp_path / "flight.npz")
    with pytest.warns(tl.FlightWarning, match=r"was renamed to .* others were renamed"):
        again = tl.Flight.load(file)
    assert again == flight


def test_explain_finds_a_key_by_its_old_name():
    with pytest.warns(tl.FlightWarning, match=r"partner\.slow was renamed to person\.landing_speed"):
        result = CliRunner().invoke(cli, ["explain", "partner.slow"])
    assert result.output.startswith("person.landing_speed [m/s]: ")


def test_keys_that_look_like_old_ones_elsewhere_stay():
    tables = {
        "corridor": {"slow": 1},
        "hearing": 2,
        "a.partner": {"slow": 3},
        "controller": {"hearing": 4, "slow": [5]},
    }
    assert renamed_tables(tables) == (tables, [])
    assert renamed_key("controller.slow") == "controller.slow"
