"""Services and parameters: what is asked of the pilot, and what is set, while it flies."""

import math
import re
import tomllib

import pytest
from ros_trial import GUIDED, UP, Middleware, Trial

import tandemlift as tl
from tandemlift.apps.ros.parameters import DAMPING, RATIO
from tandemlift.apps.ros.pushes import REQUESTS, RequestServices
from tandemlift.missions import tables_of


@pytest.fixture
def asked(trial):
    """Services whose waiting is flying."""
    requests = RequestServices(trial.session, trial.front.diagnostics.add, nap=trial.fly)
    trial.fly(UP)
    return requests.answer


def test_every_request_has_a_service(trial):
    assert set(trial.middleware.services) == {f"/tandemlift/{what}" for what in REQUESTS}
    done, words = trial.middleware.services["/tandemlift/tare"]()
    assert not done
    assert words.startswith("tare: ")


@pytest.mark.thorough
def test_it_lands_lifts_and_stops_when_it_is_asked_to(trial, asked):
    assert asked("land") == (True, "land")
    for _ in range(25):
        trial.fly(1.0)
        if trial.session.status()["phase"] == "idle":
            break
    assert asked("lift") == (True, "lift")
    trial.fly(0.5)
    assert trial.session.status()["phase"] == "lift"
    assert asked("stop") == (True, "stopped")


def test_what_makes_no_sense_now_is_answered_with_the_phase(trial, asked):
    flying = "Lift is refused: the vehicle is in the air already. Push it to where it should go, or land it."
    assert asked("lift") == (False, flying)
    assert flying in trial.said()
    asked("stop")
    for what, opening in (("land", "Landing"), ("lift", "Lift")):
        done, words = asked(what)
        assert not done
        assert words == f"{opening} is refused: the rotors were stopped, which is final. Begin the flight again."
        assert words in trial.said()
        assert words in trial.middleware.logged
    reported = [status for array in trial.sent("/diagnostics") for status in array.status if status.values]
    shown = {value.key: value.value for value in reported[-1].values}
    assert shown["lift refused"].startswith("Lift is refused: ")


def test_a_check_that_fails_is_named_with_its_numbers_and_with_what_to_do(tmp_path):
    weak = GUIDED | {
        "supervision.model": "on",
        "phases.lift_start": 1e6,
        "phases.land_start": 2e6,
        "supervision.checks.thrust_fraction": 0.2,
    }
    one = Trial(tl.load_mission("hover", weak), tmp_path)
    one.fly(0.5)
    done, words = RequestServices(one.session, one.front.diagnostics.add, nap=one.fly).answer("lift")
    one.front.stop()
    assert not done
    assert re.fullmatch(
        r"Lift is refused: hover needs 6\d\.\d % of the thrust, limit 20 %\. Take load off, or .*\.", words
    )
    assert words in one.said()


# parameters


def turn(trial, **values):
    trial.middleware.set = {key.replace("__", "."): value for key, value in values.items()}
    trial.front._parameters.exchange()
    return trial.middleware.kept


def test_parameters_begin_as_the_mission_has_them(trial):
    kept, mission = turn(trial), tables_of(trial.session.flight.now)
    assert kept["admittance.mass"] == mission["admittance"]["mass"]
    assert kept["controller.name"] == "nftsmc"
    assert kept[RATIO] == [0.0, 0.0, 0.0]
    assert not {"person.stiffness", "person.damping"} & set(kept)


def test_what_is_set_before_the_start_is_flown_from_the_start(tmp_path):
    middleware = Middleware()
    middleware.set = {"admittance.mass": 2.5}
    early = Trial(tl.load_mission("hover", GUIDED), tmp_path, middleware)
    (told,) = early.sent("/tandemlift/mission")
    assert tomllib.loads(told.data)["admittance"]["mass"] == [2.5, 2.5, 2.5]
    early.fly(0.6)
    assert early.session.flight.now.admittance.mass == (2.5, 2.5, 2.5)
    early.front.stop()


def test_a_parameter_is_set_while_it_flies_and_shown_as_it_is(trial):
    trial.fly(1.0)
    kept = turn(trial, admittance__mass=5, admittance__stiffness=[4.0, 0.0, 4.0])
    assert kept["admittance.mass"] == [5.0, 5.0, 5.0]
    assert trial.session.flight.now.admittance.mass == (5.0, 5.0, 5.0)
    damping = kept[DAMPING]
    assert kept[RATIO] == pytest.approx([damping[0] / (2 * math.sqrt(20.0)), 0.0, damping[2] / (2 * math.sqrt(20.0))])


def test_a_damping_ratio_sets_the_damping_of_axes_with_stiffness(trial):
    before = turn(trial)[DAMPING]
    kept = turn(trial, admittance__mass=2.0, admittance__stiffness=[8.0, 0.0, 2.0], admittance__damping_ratio=[1, 0, 1])
    assert kept[DAMPING] == pytest.approx([8.0, before[1], 4.0])
    assert kept[RATIO] == pytest.approx([1.0, 0.0, 1.0])


REFUSED = (
    ("admittance.mass", 1e9, "admittance.mass = 1000000000.0: must be from"),
    ("admittance.mass", "heavy", "must be a number"),
    ("admittance.mass", [1.0, 2.0], "admittance.mass"),
    ("admittance.mass", float("nan"), "admittance.mass = nan: must be a number"),
    ("admittance.mass", None, "must be a number"),
    ("admittance.mass", [[1.0]], "must be a number"),
    ("admittance.mas", 2.0, "unknown parameter 'admittance.mas'; there are"),
    (RATIO, 0.7, "must be 0 on an axis without stiffness"),
    (RATIO, [1.0, 2.0], "must be a number, or three"),
    (RATIO, "soft", "must be a number, or three"),
    ("mission.step", 0.01, "unknown parameter"),
    ("controller.name", "none", "unknown controller"),
)


def test_what_cannot_be_is_refused_with_a_reason_and_set_back(trial):
    before = turn(trial)
    for key, value, words in REFUSED:
        assert turn(trial, **{key.replace(".", "__"): value}) == before, key
        refusals = [said for said in trial.said() if said.startswith("parameter refused: ")]
        assert words in refusals[-1]
    assert len(refusals) == len(REFUSED)
    trial.fly(0.1)
