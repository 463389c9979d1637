"""The body of a log moves as the log says, with its loads and pushes, and tells the pilot what was flown."""

from types import SimpleNamespace

import numpy as np
import pytest

from tandemlift.analysis.identification import shadow as shadows
from tandemlift.analysis.identification.shadow import LogBody
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, PUSH, SPEED_COMMANDS, Log, Stream
from tandemlift.core.vector import Vec3
from tandemlift.missions import load_mission

RNG = np.random.default_rng(3)
STEPS, DT = 40, 0.002
T = np.arange(0.0, 0.1, 0.004)  # every second step


def recorded(*names):
    given = {MOTION[2]: 4, JOINTS[0]: 6, JOINTS[1]: 6, COMMANDS: 8, SPEED_COMMANDS: 8}
    return Log({name: Stream(T, RNG.uniform(0.1, 1.0, (len(T), given.get(name, 3)))) for name in names}, "log")


def body(log, monkeypatch, own=0):
    monkeypatch.setattr(shadows, "SampleChannels", lambda sample: SimpleNamespace(of=lambda row, name: row))
    monkeypatch.setattr(shadows, "commands_of", lambda channels: "rotor_commands")
    plan = SimpleNamespace(
        steps=STEPS,
        dt=DT,
        mission=load_mission("iris"),
        given=SimpleNamespace(external=Vec3(0.0, 0.0, 0.0)),
        sample=None,
        place=lambda *path: SimpleNamespace(at=2, size=own),
    )
    return LogBody(log, plan)


def test_it_holds_each_sample_until_the_next_and_shows_loads_of_the_step_before(monkeypatch):
    log = recorded(*MOTION, *IMU, *JOINTS)
    one = body(log, monkeypatch)
    joined = np.hstack([log[name].values for name in (*MOTION, IMU[1])])
    for k in range(20):
        assert one.state == pytest.approx(joined[k // 2])
        one.advance(None, None, None, None)
        force = log[JOINTS[0]].values[k // 2].reshape(2, 3)
        assert one.readings[3:9] == pytest.approx(force.T.ravel())  # x of both, then y, then z
        assert one.readings[:3] == pytest.approx(log[IMU[0]].values[k // 2])
        assert not one.readings[-3:].any()  # no contact is logged
    assert one.flown is None


@pytest.mark.parametrize("pushed", [False, True])
def test_pushes_come_from_the_log_if_it_has_them(pushed, monkeypatch):
    log = recorded(*MOTION, *IMU, *(PUSH[:1] if pushed else ()))
    one = body(log, monkeypatch)
    for k in (0, 1, 7):
        led = one.lead(SimpleNamespace(row=None), k)
        assert led is None if not pushed else led == pytest.approx(log[PUSH[0]].values[k // 2])


def test_the_pilot_is_told_the_flown_command_where_it_differs_from_its_own(monkeypatch):
    log = recorded(*MOTION, *IMU, COMMANDS)
    one = body(log, monkeypatch, own=8)
    told = SimpleNamespace(row=np.zeros(8), a=np.zeros(12))
    one.lead(told, 5)
    assert told.a[2:10] == pytest.approx(log[COMMANDS].values[2])
    assert not told.a[[0, 1, 10, 11]].any()
    same = SimpleNamespace(row=log[COMMANDS].values[2], a=np.zeros(12))
    one.lead(same, 5)
    assert not same.a.any()
    first = SimpleNamespace(row=np.zeros(8), a=np.zeros(12))
    one.lead(first, 0)
    assert not first.a.any()


def test_speeds_are_commands_by_the_constants_of_the_rotors(monkeypatch):
    log = recorded(*MOTION, *IMU, SPEED_COMMANDS)
    one = body(log, monkeypatch)
    constants = np.repeat([q.thrust_constant for q in load_mission("iris").vehicle.quadrotors], 4)
    assert one.flown[6] == pytest.approx(constants * log[SPEED_COMMANDS].values[3] ** 2)


class Flown(SimpleNamespace):
    def __contains__(self, name):
        return name in self.channels


@pytest.mark.parametrize("flown", [False, True])
def test_a_shadow_flies_the_body_of_its_log_and_keeps_what_was_flown(flown, monkeypatch):
    log, asked = recorded(*MOTION, *IMU, *([COMMANDS] if flown else [])), []
    commands = np.arange(STEPS * 8.0).reshape(STEPS, 8) if flown else None

    def made(given, plan):
        asked.append((given, plan))
        return SimpleNamespace(flown=commands, lead="lead")

    plan = SimpleNamespace(steps=20, every=5)
    for name in ("check_vehicle", "check_streams"):
        monkeypatch.setattr(shadows, name, lambda *_: None)
    monkeypatch.setattr(shadows, "plan_of", lambda log, mission: plan)
    monkeypatch.setattr(shadows, "LogBody", made)
    monkeypatch.setattr(shadows, "fly_stepwise", lambda p, samples, every, *more, **lead: (p, samples, every, lead))
    flight = Flown(time=np.zeros(5), channels={"phase": 1})
    monkeypatch.setattr(shadows, "flight_of", lambda p, made, engine: flight if made[1:3] == (5, 5) else None)
    monkeypatch.setattr(shadows, "replace", lambda flight, channels: SimpleNamespace(channels=channels))
    found = shadows.shadow(log, load_mission("iris"))
    assert asked == [(log, plan)]
    assert found.channels["phase"] == 1
    kept = [value for key, value in found.channels.items() if key != "phase"]
    assert [value[:, 0].tolist() for value in kept] == [[0.0, 40.0, 80.0, 120.0, 160.0]] * flown
