"""`tl.linearize`: the closed step of a mission, or its body alone, as a linear model about a time of the flight."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from tandemlift.analysis.linearization.kinks import Kink, kinks_near, law_name
from tandemlift.analysis.linearization.linear_model import LinearizationPoint, LinearModel
from tandemlift.analysis.linearization.model_variables import Outputs, given_at, input_columns, outputs_from, push_sum
from tandemlift.analysis.linearization.operating_point import (
    OperatingPoint,
    as_it_stands,
    averaged_lags,
    flown_to,
    tare_left,
    with_mean_lag,
)
from tandemlift.analysis.linearization.period import LinearizationPlan, PeriodDerivative, delayed_numbers, differentiate
from tandemlift.analysis.linearization.state_variables import state_variable
from tandemlift.analysis.linearization.step_graph import step_graph
from tandemlift.core.errors import InputError, shown, unknown
from tandemlift.core.types import Array, flat, unflat
from tandemlift.core.vector import Absent, Quat
from tandemlift.missions import MissionLike, mission_of
from tandemlift.simulation.graphs import by_direction, push_moment
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.simulation import Simulation

PARTS = ("loop", "body")
LOOP_OUTPUTS = (
    *("position", "velocity", "euler", "rates", "reference_position", "reference_euler"),
    *("rotor_thrusts", "joint_force", "joint_torque"),
)
BODY_OUTPUTS = ("position", "velocity", "attitude", "euler", "rates", "joint_force", "joint_torque")
BODY_CHANNELS = (*BODY_OUTPUTS, "push_force", "push_moment", "rotor_thrusts", "wind_velocity", "wind_force")
MAX_PERIOD = 200  # steps of a period
KINK_TOLERANCE = 1e-4  # such as 0.1 mm, 0.1 mrad, 0.1 mN


def linearize(
    flight: MissionLike | Simulation | OperatingPoint,
    at: float | None = None,
    *,
    of: str = "loop",
    inputs: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    steps: int | None = None,
    kink_tolerance: float = KINK_TOLERANCE,
) -> LinearModel:
    """The linear model of a flight's step about a point of it, by exact derivatives of the step's own equations.

    Args:
        flight: a mission, or its name or path, which is flown to the time `at` with the compiled body; or a simulation
            as it stands; or a point.
        at: time of the point [s]. By default the end of the first calm after the lift: just before the first push,
            fault or landing, or before a person begins, else the mission's end; and 0.5 s after the tare, if that
            takes longer, because earlier pushes are ignored. None for a simulation.
        of: "loop" for pilot and body together; "body" for the body alone, whose inputs are the rotor thrusts.
        inputs: names of inputs: `push_force` [N, world axes, at the centre of mass], `push_moment` [N m, body axes],
            `disturbance_force` [N, world axes], `disturbance_moment` [N m, body axes], `wind_velocity` [m/s, world
            axes] with wind, `rotor_thrusts` [N] of the body alone. By default all. Only on request: `thrust_offsets`
            [N] of the loop, added to the thrust of each real rotor.
        outputs: names of channels; by default those of the motion, the references, thrusts and joint loads.
        steps: steps of one period; by default the common period of all sensors, 1 without sensors.
        kink_tolerance: the largest distance of the point from a kink that is reported, in the unit of a state or input.

    Returns:
        The model; see `LinearModel`, and docs/reference/linearize.md for its assumptions.

    Raises:
        InputError: an argument is not allowed; the flight is lost before `at`; the controller is plain Python; the step
            has no derivative at the point.
    """
    if of not in PARTS:
        raise unknown("part", of, PARTS)
    if isinstance(flight, Simulation) and at is not None:
        raise InputError(f"at = {shown(at)}: a simulation is linearized at its own time; step it there")
    if isinstance(flight, Simulation):
        flight = as_it_stands(flight)
    point = flight if isinstance(flight, OperatingPoint) else flown_to(mission_of(flight), at)
    recipe, chosen = linearization_plan(point, of, inputs, outputs, steps)
    here = made = differentiate(recipe)
    averaged = with_mean_lag(point) if of == "loop" else point
    if averaged is not point:
        recipe = recipe._replace(point=averaged)
        made = differentiate(recipe)
    _check_finite(recipe, made)
    # states and outputs of the point are those of the flight; the derivatives alone take the mean lag
    kinks = [*kinks_near(recipe, made, kink_tolerance), *(_known_kinks(point) if of == "loop" else ())]
    return _model(recipe, made._replace(x0=here.x0, x1=here.x1, y0=here.y0), chosen, of, kinks)


def _known_kinks(point: OperatingPoint) -> Iterator[Kink]:
    """Kinks that are no edges in the step: the rotors' lag by direction, the push during the tare."""
    lags, left = averaged_lags(point.plan), tare_left(point.plan, point.numbers, point.k * point.plan.dt)
    if lags:
        name, file = law_name(by_direction.scalar)
        yield Kink(
            name, file, 0.0, f"{name} in {file}: noise drives rotors up and down, with lags of {shown_lags(lags)}"
        )
    if left > 0.0:
        file = "parts/estimation/push_estimate.py"
        text = f"estimate in {file}: pushes are used once the tare is over, in {left:.3g} s, and ignored before"
        yield Kink("estimate", file, left, text)


def linearization_plan(
    point: OperatingPoint, of: str, inputs: Sequence[str] | None, outputs: Sequence[str] | None, steps: int | None
) -> tuple[LinearizationPlan, Outputs]:
    """The request of a derivative about a point, with its outputs; arguments as for `linearize`.

    Raises:
        InputError: an argument is not allowed.
    """
    plan = point.plan
    graph, delayed = step_graph(plan), delayed_numbers(plan)
    if of == "body" and outputs is not None:
        for name in outputs:
            if name not in BODY_CHANNELS:
                raise unknown("output of the body", name, BODY_CHANNELS)
    chosen = outputs_from(graph.sample, outputs, BODY_OUTPUTS if of == "body" else LOOP_OUTPUTS)
    attitude = _attitude(point)
    columns = input_columns(plan, inputs, of, attitude)
    nodes = [graph.outputs[i] for i in chosen.columns]
    cut = graph.thrusts if of == "body" else []
    late = {one.number for one in delayed if one.under_way}
    choice = graph.choose(nodes, cut, late)
    period = 1 if of == "body" else sensor_period(plan.model.sensors)
    return LinearizationPlan(point, graph, choice, columns, nodes, delayed, _steps(period, steps)), chosen


def _attitude(point: OperatingPoint) -> Quat:
    like = point.plan.model.flight_state
    return unflat(point.numbers[: len(flat(like))], like).state.attitude


def sensor_period(sensors: Any) -> int:
    """The common period of all sensors in steps; 1 without sensors."""
    if isinstance(sensors, Absent):
        return 1
    devices = [sensors.imu, sensors.motion, *sensors.additional]
    devices += [] if isinstance(sensors.joints, Absent) else [sensors.joints]
    return math.lcm(*[round(device.period) for device in devices])


def _steps(period: int, steps: int | None) -> int:
    if steps is None:
        if period > MAX_PERIOD:
            raise InputError(
                f"the sensors have a common period of {period} steps, more than {MAX_PERIOD}: choose steps, such as "
                "steps=1 for the next step alone"
            )
        return period
    if not isinstance(steps, int) or not 1 <= steps <= MAX_PERIOD:
        raise InputError(f"steps = {shown(steps)}: must be a whole number from 1 to {MAX_PERIOD}")
    return steps


def _check_finite(r: LinearizationPlan, made: PeriodDerivative) -> None:
    if all(np.isfinite(getattr(made, name)).all() for name in ("A", "B", "C", "D")):
        return
    g = r.graph.graph
    for d in made.steps:
        for node in sorted(r.choice.smooth):
            row = d.nodes.rows.get(node)
            sound = all(d.nodes.rows.get(a) is None or np.isfinite(d.nodes.rows[a]).all() for a in g.args[node])
            if row is not None and sound and not np.isfinite(row).all() and g.ops[node] in ("sqrt", "fdiv"):
                name, file = law_name(g.laws[node])
                what = "takes a root of 0" if g.ops[node] == "sqrt" else "divides by 0"
                at = r.point.k * r.point.plan.dt
                raise InputError(f"no derivative at {at:g} s: {name} ({file}) {what}: choose another time")
    raise InputError("no derivative at this point: choose another time")


def _model(
    r: LinearizationPlan, made: PeriodDerivative, chosen: Outputs, of: str, kinks: Sequence[Kink]
) -> LinearModel:
    plan, names = r.point.plan, r.graph.names
    late = [state_variable(names[r.delayed[i].number], ago) for i, ago in r.waiting]
    return LinearModel(
        A=made.A,
        B=made.B,
        C=made.C,
        D=made.D,
        states=(*[state_variable(names[i]) for i in r.choice.kept], *late),
        inputs=tuple(column.variable for column in r.inputs),
        outputs=chosen.variables,
        step=r.steps * plan.dt,
        time=r.point.k * plan.dt,
        point=LinearizationPoint(made.x0, _inputs_at(r, made), made.y0, made.x1),
        assumptions=tuple(assumptions(r, made, of)),
        kinks=tuple(kinks),
        left_out={state_variable(names[i]).name: why for i, why in r.choice.left_out.items()},
        mission=plan.mission.mission.name,
        of=of,
    )


def shown_lags(lags: list[tuple[float, float]]) -> str:
    """The lags of rotors up and down in words."""
    return " or ".join(f"{1e3 * up:g} and {1e3 * down:g} ms" for up, down in dict.fromkeys(lags))


def _inputs_at(r: LinearizationPlan, made: PeriodDerivative) -> Array:
    """The values of the inputs at the point; the step decides the thrust of a rotor."""
    plan, t = r.point.plan, r.point.k * r.point.plan.dt
    thrusts = made.steps[0].nodes.values_of(r.graph.thrusts)
    known: dict[str, Any] = {"fly": r.point.numbers, "thrust": thrusts, "offset": np.zeros_like(thrusts)}
    known |= given_at(plan, t)
    mean = leaf_offset(plan.model, "wind", "velocity")  # the turbulence is a state
    known["gust"] = np.add(r.point.numbers[mean.at : mean.at + mean.size], known["gust"][: mean.size])
    moment = push_moment(push_sum(plan, t), _attitude(r.point))
    values = []
    for (name, _), ((kind, i, _), *_) in r.inputs:
        values.append(getattr(moment, name[-1]) if name.startswith("push_moment") else known[kind][i])
    return np.array(values)


def assumptions(r: LinearizationPlan, made: PeriodDerivative, of: str) -> list[str]:
    """The omissions of a model and quantities held fixed, a sentence each."""
    plan, x = r.point.plan, r.graph.traced.templates
    said = ["Inputs are held over the sample time; outputs are at its start, the rotor thrusts act until its end."]
    speed = np.abs(made.x1 - made.x0)[3:6].max() / (r.steps * plan.dt)
    said.append(f"The point moves: the velocity changes by {speed:.1e} m/s^2 (point.x0 and point.x1 have all states).")
    if not isinstance(plan.given.noise, Absent) and len(flat(plan.given.noise)):
        said.append("Noise is 0 from the point on; the flight to the point has it.")
    if not isinstance(plan.model.sensors, Absent):
        said.append("The quantization of sensors is replaced by a straight line.")
    lags, left = averaged_lags(plan), tare_left(plan, r.point.numbers, r.point.k * plan.dt)
    if of == "loop" and lags:
        said.append(f"The rotors' lag is the mean of up and down, {shown_lags(lags)}: noise drives them both ways.")
    if of == "loop" and left > -math.inf:
        said.append(
            f"Tare: {'over, pushes are used' if left <= 0.0 else f'not over for {left:.3g} s, pushes are ignored'}."
        )
    if r.steps > 1:
        t = r.point.k * plan.dt
        said.append(f"Sensors: the sample time is their common period, {r.steps} steps from {t:g} s on.")
    if len(r.waiting):
        said.append(f"Delay lines are states: {len(r.waiting)} values under way, name[-n] written n steps ago.")
    if x.has_floor or x.has_walls:
        touching = any(d.may_touch for d in made.steps)
        said.append(
            "Contact: the body may touch floor or walls." if touching else "Contact: out of reach of floor and walls."
        )
    if x.has_walls:
        said.append("The nearest walls are those at the point.")
    if of == "loop" and x.has_thrust_limits:
        active = any(d.limits_active for d in made.steps)
        said.append(f"Thrust limits: {'the rotors at a limit stay there' if active else 'no rotor is at a limit'}.")
    said.append("The unit quaternion is four states; the direction of its length has the eigenvalue 0.")
    if r.choice.left_out:
        said.append(f"{len(r.choice.left_out)} numbers of the flight are no states; `left_out` says why.")
    return said
