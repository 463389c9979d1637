"""The closed loop of a calm hover, cut where thrusts meet their limits and where a sliding-mode law switches.

The closed step is linearized with an offset added to what each cut returns, which acts for a sample: to the thrusts of
the allocation within limits, which the pilot knows, ahead of the rotors' delay and lag; and to the reaching law. What
the allocation takes away is counted as a wrench, a thrust and moments in units of 1 N of each rotor. Cuts that no
response couples are parts by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.sector_bound import (
    LoopPart,
    Plant,
    Start,
    difference,
    energies,
    reduced,
    response,
    without_resting_modes,
)
from tandemlift.analysis.linearization.linear_model import Variable, connecting_states
from tandemlift.analysis.linearization.linearize import linearization_plan
from tandemlift.analysis.linearization.loop_margins import AXES, calm_mission
from tandemlift.analysis.linearization.model_variables import InputColumn
from tandemlift.analysis.linearization.operating_point import flown_to
from tandemlift.analysis.linearization.period import differentiate
from tandemlift.core.errors import InputError, extra
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.parts.pilot.commanded_thrusts import OFFSETS, REACHING, SURFACE, rotor_axes, switching_slopes
from tandemlift.simulation.pilot_api import pilot_at_start

SURFACES = tuple(f"surface {axis}" for axis in ("x", "y", "z", "roll", "pitch", "yaw"))
OFFSET_NAMES = tuple(f"{what}.{axis}" for what in OFFSETS for axis in "xyz")
MAX_STATES, PART_ERROR = 16, 0.02  # of a part; error bound, in units of the loop's response
DISTURBANCE = 0.003  # size of a disturbance, in its unit, that hardly counts in the reduction
LOOP_ERROR = 1e-4  # error bound of the loop before it is split
COUPLING = 0.02  # of the largest response at equal scale, below which cuts are not coupled
ONE_WAY, SWEEPS = 1e-6, 20
LOW_END, HIGH_END, POINTS = 0.05, 0.95, 80  # rad/s, of the Nyquist frequency


class CutLoop(NamedTuple):
    """The closed loop of a calm hover with its cuts.

    Attributes:
        plant: from φ of each cut, then states after a unit disturbance (`DISTURBED`), to q of each cut.
        names: of the cuts: axes, whose unit is a thrust of 1 N of each rotor; then surfaces, in m/s² and rad/s².
        step: sample time [s].
        error: bound of the plant's own error.
    """

    plant: Plant
    names: tuple[str, ...]
    step: float
    error: float


def loop_of(mission: Mission) -> CutLoop:
    """The loop of a mission, cut at the thrust limits of a constrained allocation and at the switching of NFTSMC.

    Raises:
        InputError: the controller is plain Python, the calm flight is lost or does not settle, or there is no cut.
    """
    calm, at = calm_mission(mission, slow=1.0)
    point = flown_to(calm, at)
    request, _ = linearization_plan(point, "loop", [], ["euler"], None)
    graph, axes = request.graph, rotor_axes(calm.vehicle, calm.allocation.weights)
    nodes, outputs, into, out = list[int](), list[int](), list[Array](), list[Array]()
    names: tuple[str, ...] = ()
    if graph.traced.limits is not None:
        rotors = len(axes.hover)
        nodes += [graph.next[graph.names.index(f"memory.allocation.thrusts.r{i}")] for i in range(rotors)]
        outputs += [s.node for s in graph.traced.limits.plain[rotors:]]
        into.append(-axes.inverse)
        out.append(axes.effect)
        names += AXES
    slopes = switching_slopes(pilot_at_start(calm).parameters)
    if slopes is not None:
        smooth = request.choice.smooth
        nodes += _results(graph, smooth, REACHING)
        outputs += _results(graph, smooth, SURFACE)
        into.append(-np.eye(6))
        out.append(np.diag(slopes))
        names += SURFACES
    if not names:
        raise InputError("no cut: neither thrust limits nor a switching function with a slope")
    late = {one.number for one in request.delayed if one.under_way}
    columns = [InputColumn(Variable("cut", ""), (("node", node, 1.0),)) for node in nodes]
    request = request._replace(choice=graph.choose(outputs, [], late), inputs=columns, outputs=outputs)
    with extra("certify", "the loop of the nonlinear tier"):
        from scipy.linalg import block_diag
    made, E, F = differentiate(request), block_diag(*into), block_diag(*out)
    if max(abs(made.x1 - made.x0)[3:6]) > 1e-3:
        raise InputError(f"{mission.mission.name} does not hover calmly: its hover is not stable")
    B = np.hstack([made.B @ E, made.A @ _disturbances([graph.names[i] for i in request.choice.kept], len(made.A))])
    C, D = F @ made.C, np.hstack([F @ made.D @ E, np.zeros((len(F), len(OFFSET_NAMES)))])
    kept = connecting_states(made.A, B, C)
    whole = Plant(made.A[np.ix_(kept, kept)], B[kept], C[:, kept], D)
    plant, error = reduced(without_resting_modes(whole), len(kept), LOOP_ERROR)
    return CutLoop(plant, names, request.steps * calm.mission.step, error)


def _results(graph: Any, smooth: frozenset[int], law: Callable[..., Any]) -> list[int]:
    """The nodes of a step that hold what a law returns, in the order of its calls."""
    own = [n for n in smooth if getattr(graph.graph.laws[n], "__code__", None) is law.__code__]
    used = {a for n in own if graph.graph.ops[n] != "const" for a in graph.graph.args[n]}
    return sorted(n for n in own if n not in used)


def _disturbances(names: Sequence[str], size: int) -> Array:
    """The change of the states by each of `DISTURBED`; half an angle is a component of the quaternion."""
    change = np.zeros((size, len(OFFSET_NAMES)))
    for j, name in enumerate(OFFSET_NAMES):
        change[names.index(f"state.{name}"), j] = 0.5 if name.startswith("attitude") else 1.0
    return change


def parts_of(
    loop: CutLoop, cuts: Sequence[str], unit: float = 1.0, disturbance: float = DISTURBANCE
) -> list[tuple[LoopPart, list[Start]]]:
    """The parts of a loop between some of its cuts, reduced, each with its starts after a unit disturbance."""
    from scipy.sparse.csgraph import connected_components  # which the loop has found installed

    chosen, m = [loop.names.index(name) for name in cuts], len(loop.names)
    p = loop.plant
    w = np.geomspace(LOW_END, HIGH_END * math.pi / loop.step, POINTS)
    size = np.abs(
        response(Plant(p.A, p.B[:, chosen], p.C[chosen], p.D[np.ix_(chosen, chosen)]), np.exp(1j * w * loop.step))
    ).max(axis=0)
    found = list[tuple[LoopPart, list[Start]]]()
    apart = _balance(size, ONE_WAY)
    equal = size * apart[:, None] / apart
    # coupled in one direction, or through others, is coupled
    count, part_of = connected_components(equal > COUPLING * np.diag(size).max())
    for own in (np.flatnonzero(part_of == number) for number in range(count)):
        scale, at = _balance(size[np.ix_(own, own)]) / unit, [chosen[i] for i in own]
        D = p.D[np.ix_(at, at)] * scale[:, None] / scale
        part = Plant(
            p.A,
            np.hstack([p.B[:, at] / scale, disturbance * p.B[:, m:]]),
            p.C[at] * scale[:, None],
            np.hstack([D, np.zeros((len(at), len(OFFSET_NAMES)))]),
        )
        few, error = reduced(part, MAX_STATES, PART_ERROR)
        rest = loop.error * scale.max() / scale.min()
        left, k = energies(difference(part, few)), len(at)
        starts = [Start(few.B[:, k + j] / disturbance, left[k + j] / disturbance) for j in range(len(OFFSET_NAMES))]
        found.append((LoopPart(Plant(few.A, few.B[:, :k], few.C, D), tuple(at), error + rest, scale), starts))
    return found


def _balance(size: Array, least: float = 0.0) -> Array:
    """Scales (m) of channels that make rows and columns of their response equally large (Osborne, 1960).

    A response of one channel to another without a way back is part of no loop: `least`, which is added to both, lets
    its scale grow until it counts for nothing.
    """
    scale, added = np.ones(len(size)), least * float(size.max())
    for i in list(range(len(size))) * SWEEPS:
        now = size * scale[:, None] / scale
        row, column = (float(np.linalg.norm(np.delete(x[i], i))) + added for x in (now, now.T))
        if row > 0.0 and column > 0.0:
            scale[i] *= math.sqrt(column / row)
    return scale
