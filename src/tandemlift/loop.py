"""The closed loop, the only place where the pilot and a body meet: what one step is, and what it shows.

At time t_k the pilot reads the state and the person's push and decides; the body then moves for one step with the
pilot's thrusts held and the push continuous.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.engines.compiled import Plant, advance, start_plant
from tandemlift.law import law
from tandemlift.laws.body import State
from tandemlift.laws.controllers import Measured
from tandemlift.laws.push import CentralPush, Gaussian, Hand, PointPush, moment_of
from tandemlift.laws.rotation import euler_from_quaternion, sine_of_roll
from tandemlift.ops import absolute, maximum, where
from tandemlift.pilot import PilotMemory, PilotParameters, decide, start_pilot
from tandemlift.settings import Mission
from tandemlift.tally import EMPTY, Errors, Tally, count
from tandemlift.vector import ZERO, Quat, Vec3, dot, each, mat3, vec3
from tandemlift.vehicle import Vehicle

SIN_ROLL_LIMIT = 0.9998476951563913  # sin 89°
FAR = 1000.0  # m


class Moving(NamedTuple):
    """What changes from step to step; `lost` becomes 1 when the state is no longer sound."""

    state: State
    memory: PilotMemory
    tally: Tally
    lost: Any


class Flying(NamedTuple):
    """One flight: what changes, and the numbers that do not. Its type is the compiled loop's variant."""

    moving: Moving
    pilot: PilotParameters
    plant: Plant


class Sample(NamedTuple):
    """What one step shows. Each field is a channel of the flight; `flight.CHANNELS` gives units and frames."""

    position: Vec3
    velocity: Vec3
    attitude: Quat
    euler: Vec3
    rates: Vec3
    reference_position: Vec3
    reference_velocity: Vec3
    reference_acceleration: Vec3
    reference_euler: Vec3
    admittance_position: Vec3
    admittance_velocity: Vec3
    admittance_acceleration: Vec3
    admittance_force: Vec3
    push_force: Vec3
    push_moment: Vec3
    thrust: Any
    moment: Vec3
    rotor_thrusts: Any


@law
def show(state: State, decision: Any, hand: Hand) -> Sample:
    """The sample of a step that starts in `state`."""
    g, command = decision.guidance, decision.command
    target = g.reference.trajectory
    return Sample(
        state.position,
        state.velocity,
        state.attitude,
        euler_from_quaternion(state.attitude).angles,
        state.rates,
        target.position,
        target.velocity,
        target.acceleration,
        command.euler,
        g.admittance.position,
        g.admittance.velocity,
        g.admittance.acceleration,
        g.force,
        hand.start.force,
        moment_of(hand.start, state.attitude),
        command.wrench.thrust,
        command.wrench.moment,
        decision.thrusts,
    )


@law
def errors_of(x: Sample) -> Errors:
    """What a sample adds to the tally."""
    return Errors(
        x.reference_position - x.position,
        x.reference_velocity - x.velocity,
        x.reference_euler - x.euler,
        x.euler,
        x.thrust,
        x.moment,
        x.push_force,
        dot(x.push_force, x.velocity) + dot(x.push_moment, x.rates),
        0.0,
    )


@law
def unsound(state: State) -> Any:
    """0 while the state is finite, within 89° of roll and 1 km of the origin, else 1."""
    far = where(dot(state.position, state.position) < FAR * FAR, 0.0, 1.0)
    return where(absolute(sine_of_roll(state.attitude)) < SIN_ROLL_LIMIT, far, 1.0)


@law
def commit(flying: Flying, decision: Any, memory: PilotMemory, hand: Hand, dt: Any) -> Any:
    """The body's part of a step, once the pilot has decided: (Moving after it, the Sample at its start)."""
    before = flying.moving
    state = advance(flying.plant, before.state, decision.thrusts, hand, dt)
    sample = show(before.state, decision, hand)
    lost = maximum(before.lost, unsound(state))
    return Moving(state, memory, count(before.tally, errors_of(sample)), lost), sample


@law
def move(flying: Flying, hand: Hand, t: Any, dt: Any) -> Any:
    """One step of a flight from time t [s] by dt [s]: (Moving after it, the Sample at its start)."""
    before = flying.moving
    decision, memory = decide(flying.pilot, before.memory, Measured(before.state, hand.start.force), t, dt)
    return commit(flying, decision, memory, hand, dt)


def start(mission: Mission) -> Flying:
    """A mission's loop at t = 0.

    Raises:
        InputError: something in the mission cannot be built.
    """
    vehicle = Vehicle.from_settings(mission.vehicle)
    pilot, memory = start_pilot(mission, vehicle)
    plant, state = start_plant(mission, vehicle)
    return Flying(Moving(state, memory, EMPTY, 0.0), pilot, plant)


def blank_sample(rotor_count: int) -> Sample:
    """A Sample of zeros for a vehicle with so many rotors: the layout of the log."""
    rotor_thrusts = each(rotor_count)(*(0.0,) * rotor_count)
    special = {"attitude": Quat(0.0, 0.0, 0.0, 0.0), "thrust": 0.0, "rotor_thrusts": rotor_thrusts}
    return Sample(*[special.get(name, ZERO) for name in Sample._fields])


def pushes_of(mission: Mission) -> tuple[list[Gaussian], Any]:
    """The pushes of a mission, and the zero push of the type that serves them (with a moment only if one has any)."""
    pushes = [Gaussian(vec3(p.force), p.time, 1.0 / p.sigma, vec3(p.point)) for p in mission.pushes]
    central = all(p.point == ZERO for p in pushes)
    return pushes, CentralPush(ZERO) if central else PointPush(ZERO, mat3([[0.0] * 3] * 3))
