"""A flight with all parts is the same however it is flown: alone, in a block, step by step, or in plain Python."""

from typing import Any

import numpy as np
import pytest
from flights import different
from storm import COMMAND, DT, MOTION, UNIT, storm, storms

import tandemlift as tl
from tandemlift.core.types import leaves, unflat
from tandemlift.core.vector import ZERO
from tandemlift.parts.contact.wall_geometry import WALL
from tandemlift.parts.contact.walls import nearest_with
from tandemlift.parts.mechanics.push import PushSamples, push_at
from tandemlift.parts.mechanics.wind import gust_velocity
from tandemlift.parts.pilot.pilot import with_allocation
from tandemlift.parts.rotors.allocation import AllocationState
from tandemlift.parts.sensors.readings import Readings
from tandemlift.simulation.loop.random_numbers import normals
from tandemlift.simulation.loop.step import StepInputs, finish_step, run_pilot, with_person
from tandemlift.simulation.preparation import GAUSSIAN, GUST, SPAN
from tandemlift.simulation.preparation.assemble import assemble


@pytest.fixture(scope="module")
def alone():
    return [tl.fly(mission) for mission in storms(8)]


def test_the_storm_has_everything_in_it(alone):
    """So that what is proven with it is proven for all parts."""
    flight = tl.fly(storm())
    t, limits = flight.time, flight["rotor_commands"]
    assert flight.ending is None
    assert flight["contact_force"][0, 2] > 30.0  # N: the floor
    assert flight["contact_force"][(t > 1.0) & (t < 3.5), 0].min() < -1.0  # a wall
    assert flight["contact_force"][-10:, 2].max() > 30.0  # landed
    assert np.any((limits > 0.0) & (limits < 7.06), axis=0).all()
    assert np.any((limits[t > 0.31] <= 0.0) | (limits[t > 0.31] >= 7.06))  # at a limit in flight
    assert np.abs(flight["wind_force"]).max() > 1.0
    assert np.abs(flight["push_estimate"]).max() > 1.0
    assert sum(f.ending is None for f in alone) == 8


@pytest.mark.thorough
def test_eight_flights_in_a_block_are_the_flights_alone_to_the_last_bit(alone):
    together = tl.fly_many(storms(8))
    assert [different(a, b) for a, b in zip(alone, together, strict=True)] == [[]] * 8


@pytest.mark.thorough
def test_step_by_step_with_a_controller_in_python_it_is_the_same_to_the_last_bit(by_hand):
    assert different(tl.fly(storm(by_hand)), tl.fly(storm())) == []


def given_at(k: int, like: StepInputs, tables: Any, seeds: Any) -> StepInputs:
    """What step k is given, in plain Python."""

    def push(t):
        felt = like.hand.start
        for row in tables.pushes:
            felt = felt + push_at(felt, unflat(row, GAUSSIAN), t)
        return felt

    gust = ZERO
    for row in tables.gusts:
        gust = gust + gust_velocity(unflat(row, GUST), k * DT)
    chance = [x for group in range(-(-leaves(like.noise) // 4)) for x in normals(k, group, *seeds)]
    return StepInputs(
        PushSamples(push(k * DT), push((k + 0.5) * DT), push((k + 1) * DT)),
        gust,
        unflat(chance, like.noise),
        like.person,
    )


def in_plain_python(mission: tl.Mission, steps: int) -> list[Any]:
    """The samples of a flight whose commands stay within limits, with delays as lists."""
    model, like, tables, _, seeds = assemble(mission)
    first, nowhere = model.flight_state, model.flight_state.near
    units, motions, commands, samples = [], [], [], []

    def late(values, delay, start):
        return values[-1 - delay] if len(values) > delay else start

    for k in range(steps):
        if k % SPAN == 0:
            near, plant = nowhere, model.plant
            for row in tables.walls:
                near = nearest_with(plant.walls, unflat(row, WALL), near, plant.frame, model.flight_state.state)
            model = model._replace(flight_state=model.flight_state._replace(near=near))
        given = with_person(model, given_at(k, like, tables, seeds), k * DT, DT)
        output = run_pilot(model, given, k * DT, DT)
        wished = output.decision.thrusts
        output = output._replace(memory=with_allocation(output.memory, AllocationState(wished * 0.0, wished)))
        flight_state, sample = finish_step(model, output, given, k * DT, DT)
        units.append(flight_state.readings.imu)
        motions.append(flight_state.readings.motion)
        commands.append(flight_state.rotors.arriving)
        readings = Readings(late(units, UNIT, first.readings.imu), late(motions, MOTION, first.readings.motion))
        arriving = late(commands, COMMAND - 1, first.rotors.arriving)
        flight_state = flight_state._replace(readings=readings, rotors=flight_state.rotors._replace(arriving=arriving))
        model = model._replace(flight_state=flight_state)
        samples.append(sample)
    return samples


def shown(sample: Any, name: str) -> np.ndarray:
    """A channel's row of a sample."""
    measured = sample.measured, sample.estimated, sample.disturbance, sample.guidance
    for group in (sample, sample.actuators, sample.wind, sample.contact, *measured):
        if name in group._fields:
            return np.array(getattr(group, name), dtype=float).T.ravel()
    raise KeyError(name)


@pytest.mark.thorough
def test_its_first_steps_are_those_of_plain_python():
    changes = {
        "mission.log_interval": DT,
        "mission.duration": 0.12,
        "actuators.start": "hover",
        "phases.lift_start": 0.0,
        "phases.lift_duration": 0.02,
        "phases.height": 0.0,
        "compliance.spin_up_time": 0.02,  # s: then it observes, and from 0.04 s it listens
        "phases.rotors": "flight",
        "initial.euler": [0.01, -0.01, 0.02],
        "initial.velocity": [0.1, 0.0, -0.05],
        "ground.height": -0.174,  # m: one foot touches
        "walls.0": {"start": [0.42, -3.0], "end": [0.4, 3.0]},
        "initial.position": 0.0,
        "estimator.tare_start": 0.02,
        "estimator.tare_duration": 0.03,
        "faults.0.time": 0.07,
        "pushes.0.force": [0.04, 0.02, -0.02],  # N: so steep that more would ask for more than rotors give
        "admittance.threshold": 0.01,
        "compliance.force_lead": 0.01,
        "sensors.joints.force_bias": 0.02,
        "sensors.joints.force_noise": 0.005,
        "sensors.joints.torque_bias": 0.005,
        "pushes.0.time": 0.06,
        "pushes.0.sigma": 0.02,
        "wind.gusts.0.start": 0.03,
    }
    flight = tl.fly(storm(changes))
    samples = in_plain_python(storm(changes), 120)
    commands = flight["rotor_commands"]
    assert commands.min() > 0.0
    assert commands.max() < 7.06  # N: no limit is met, so laws.rotors.thrust_limit_solver has nothing to do
    assert flight["contact_force"][:, 0].min() < -0.1
    assert flight["contact_force"][:, 2].max() > 0.1
    for name in (name for name in flight if not name.endswith("_stamp")):
        rows = np.array([shown(s, name) for s in samples])
        recorded = flight[name].reshape(len(flight.time), -1)[: len(rows)]
        np.testing.assert_allclose(recorded, rows, rtol=1e-8, atol=1e-8, err_msg=name)  # roundings differ
