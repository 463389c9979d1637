"""`tandemlift new`: what it tells, writes and refuses, and that its missions fly as `iris` does."""

import re
import warnings

import numpy as np
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.apps.cli.new_mission import quadrotor_models
from tandemlift.core.errors import FAILS, REFUSED

MODELS = ["crazyflie", "hummingbird", "iris", "x500"]


@pytest.fixture
def new(tmp_path, monkeypatch):
    """Exit code, output and exception of the verb, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments, answers=None):
        if answers is not None:
            monkeypatch.setattr("tandemlift.apps.cli.keys.sys", type("", (), {"stdin": Terminal()}))
        result = CliRunner().invoke(cli, ["new", *map(str, arguments)], input=answers)
        return result.exit_code, result.output, str(result.exception)

    return call


class Terminal:
    def isatty(self):
        return True


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """By model, its default mission, checks and flight; and the text that the command printed."""
    folder, flights = tmp_path_factory.mktemp("new"), {}
    for model in MODELS:
        path = str(folder / f"{model}.toml")
        told = CliRunner().invoke(cli, ["new", path, "--quadrotor", model])
        assert told.exit_code == 0, told.output
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            mission = tl.load_mission(path)
            flights[model] = mission, tl.check(mission), tl.fly(mission), told.output
    return flights


def test_every_model_of_the_library_is_flown_here():
    assert list(quadrotor_models()) == MODELS
    shown = CliRunner().invoke(cli, ["new", "--help"]).output
    assert [model for model in MODELS if model not in shown] == []


@pytest.mark.thorough
@pytest.mark.parametrize("model", MODELS)
def test_a_new_mission_flies_without_a_warning_and_without_a_finding(model, flown):
    _, checks, flight, _ = flown[model]
    assert not [result.text for result in checks if result.verdict in (FAILS, REFUSED)]
    assert flight.outcome == "landed"
    assert flight.findings == ()


@pytest.mark.thorough
@pytest.mark.parametrize("model", MODELS)
def test_vehicles_of_any_weight_move_alike_under_pushes_that_suit_them(model, flown):
    """The rule: forces by mass, moments by inertia, so that accelerations are those of `iris`."""
    (mission, _, flight, _), iris = flown[model], flown["iris"][2]
    assert np.abs(flight["position"] - iris["position"]).max() < 0.05
    assert np.abs(iris["position"][-1, :2]).min() > 2.0
    weight = tl.Vehicle.from_settings(mission.vehicle).weight
    assert np.abs(flight["push_force"]).max() / weight == pytest.approx(3.0 / (3.5 * 9.81), rel=0.01)


@pytest.mark.thorough
@pytest.mark.parametrize("model", MODELS)
def test_shakes_that_the_check_finds_too_much_are_not_promised(model, flown):
    _, checks, _, told = flown[model]
    texts = [result.text for result in checks if result.check == "shake" and result.text]
    assert re.findall("not promised: (.*)", told) == texts


@pytest.mark.parametrize("model", MODELS)
def test_what_is_told_of_thrusts_is_what_a_flight_shows(model, flown):
    mission, _, flight, told = flown[model]
    hover, limits = (flight.time > 9.0) & (flight.time < 13.0), [q.thrust_limit for q in mission.vehicle.quadrotors]
    thrusts = flight["rotor_thrusts"][hover].mean(axis=0)
    share, over = (float(re.search(rf"{words} +([\d.]+)", told)[1]) for words in ("in hover", "over weight"))
    assert np.max(thrusts / np.repeat(limits, 4)) == pytest.approx(share / 100.0, abs=0.02)
    assert 4.0 * sum(limits) / thrusts.sum() == pytest.approx(over, rel=0.03)


@pytest.mark.thorough
def test_the_heaviest_beam_is_accepted_and_a_heavier_one_refused_with_what_would_lift_it(new, tmp_path):
    """Off its middle the near quadrotor carries more: by the lever law, half of all and c/L of the beam."""
    code, told, _ = new("a.toml", "--center", 0.2)
    most = float(re.search(r"heaviest beam +([\d.]+) kg", told)[1])
    near = 1.5 + (0.5 + 0.2 / 2.0) * most  # kg
    assert near * 9.81 / (4.0 * 5.84e-6 * 1100.0**2) == pytest.approx(0.9, rel=0.04)  # the rotors are not alike
    assert new("b.toml", "--center", 0.2, "--mass", 0.995 * most)[0] == 0
    code, _, error = new("c.toml", "--center", 0.2, "--mass", 2.5)
    assert code != 0
    assert re.search(
        rf"--mass 2.5: two iris lift a beam of 2 m and at most {most:g} kg.* two hummingbird 2.\d+ kg", error
    )
    assert not (tmp_path / "c.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        (("a.toml", "--length", 0.5), ["--length", "0.5: must be from 0.75 to 100 m"]),
        (("a.toml", "--length", "nan"), ["--length", "nan: must be"]),
        (("a.toml", "--length", "two"), ["--length", "'two' is not a valid float"]),
        (("a.toml", "--center", -1.5), ["--center", "-1.5: must be from -1 to 1 m"]),
        (("a.toml", "--mass", 0), ["--mass", "0: must be from 0.0001 to 2.19 kg"]),
        (("a.toml", "--quadrotor", "crazyfly"), ["unknown quadrotor 'crazyfly'", "Did you mean 'crazyflie'?"]),
        (("a.txt",), ["FILE a.txt: must end in .toml"]),
    ],
)
def test_a_wrong_answer_is_refused_with_what_is_allowed(arguments, pieces, new, tmp_path):
    code, output, error = new(*arguments)
    assert code != 0
    assert all(piece in output + error for piece in pieces)
    assert not any(tmp_path.iterdir())


@pytest.mark.thorough
def test_a_file_is_overwritten_only_by_force(new, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text("mine", "utf-8")
    code, _, error = new("a.toml")
    assert code != 0
    assert error == "a.toml exists; --force overwrites it"
    assert path.read_text("utf-8") == "mine"
    assert new("a.toml", "--force")[0] == 0
    assert tl.load_mission(str(path)).vehicle.payload.length == 2.0


@pytest.mark.thorough
def test_a_file_of_any_name_is_a_mission(new, tmp_path):
    code, told, _ = new("my (böse) beam.toml")
    assert (code, told.splitlines()[-1]) == (
        0,
        "written: my (böse) beam.toml; next: tandemlift check 'my (böse) beam.toml', "
        "tandemlift run 'my (böse) beam.toml'",
    )
    assert tl.load_mission(str(tmp_path / "my (böse) beam.toml")).mission.name == "my-b-se-beam"


@pytest.mark.thorough
def test_a_terminal_is_asked_for_what_no_option_gives_and_again_after_a_wrong_answer(new, tmp_path):
    code, output, _ = new("a.toml", "--center", 0, answers="crazyflie\n0.05\n0.4\n\n")
    assert code == 0
    assert "Error: 0.05: must be from 0.138 to 100 m" in output
    assert "center [" not in output
    payload = tl.load_mission(str(tmp_path / "a.toml")).vehicle.payload
    assert (payload.length, payload.mass) == (0.4, 0.02)


def soles(mission):
    return [q.position[2] - q.feet_depth for q in mission.vehicle.quadrotors]


@pytest.mark.thorough
def test_two_models_are_written_as_given_with_level_soles_and_fly(new, tmp_path):
    code, told, _ = new("a.toml", "--quadrotor", "iris", "--quadrotor", "x500")
    assert code == 0
    assert told.startswith("iris and x500 and a beam of 2 m")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mission = tl.load_mission(str(tmp_path / "a.toml"))
    assert [(q.mass, q.position[1]) for q in mission.vehicle.quadrotors] == [(1.5, 1.0), (2.064, -1.0)]
    assert soles(mission)[0] == pytest.approx(soles(mission)[1])
    assert tl.fly(mission).outcome == "landed"


def test_two_models_of_which_one_cannot_lift_its_share_and_a_third_one_are_refused(new, tmp_path):
    code, _, error = new("a.toml", "--quadrotor", "crazyflie", "--quadrotor", "x500")
    assert code != 0
    assert "crazyflie and x500 lift a beam of 1.2 m and at most 0 kg" in error
    code, _, error = new("a.toml", *["--quadrotor", "iris"] * 3)
    assert code != 0
    assert "--quadrotor is given 3 times" in error
    assert not any(tmp_path.iterdir())


def test_soles_that_are_not_level_are_warned_of():
    with pytest.warns(tl.FlightWarning, match=r"the soles of quadrotor 2 are 0\.02 m above those of quadrotor 1"):
        tl.load_mission("iris", {"vehicle.quadrotors.0.feet_depth": 0.2})
