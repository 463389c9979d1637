"""A trained policy: a small network that sets the virtual damping from the push and the motion of the reference.

e = F / (|F| + ε), x = six numbers of push and motion, y = tanh(W₂ [tanh(W₁ [x, 1]), 1]), cᵢ = r^yᵢ
damping of the admittance: c₂ C + (c₁ − c₂) √C e eᵀ √C, along the push c₁ C, across it c₂ C

With |e| < 1, cᵢ > 0 and constant mass the damping matrix is positive definite, so the admittance is passive whatever
the weights are; with weights of zero it is that of the mission. Horizontal; the numbers stay as they are where
everything is rotated about the vertical or mirrored.

Sources: variable damping, Ikeura and Inooka, Variable impedance control of a robot for cooperation with a human, ICRA
1995; passive with constant mass, Ferraguti et al., 2015, as for the tank.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from tandemlift.core.algebra import absolute, exp, maximum, sqrt, tanh
from tandemlift.core.errors import CheckResult, InputError, refused
from tandemlift.core.keys import AtLeastOne, Table, key
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPassState
from tandemlift.core.part import Part
from tandemlift.core.types import Number, NumberSet
from tandemlift.core.vector import Absent, Vec3, dot, each
from tandemlift.parts.guidance.admittance import AdmittanceTable

INPUTS, OUTPUTS = 6, 2
LEAST_NUMBERS = INPUTS + 1 + 2 * OUTPUTS  # numbers, of one hidden unit
FORCE, RATE, SPEED = 2.0, 5.0, 0.5  # N, N/s, m/s: that count as one
LEAST_FORCE = 0.1  # N: ε
TINY = 1e-24  # guards roots
LARGEST_WEIGHT, MOST_UNITS = 100.0, 64  # of a weight, of hidden units
# found by `tandemlift train zigzag`, as docs/how-to/train-a-policy.md says
# fmt: off
SHIPPED = (
    -0.317, -0.344, 0.677, 0.609, 1.16, 0.592, 0.4, 0.0714, -0.419, 0.903, 1.32, -1.27, -0.128, 2.23,
    -0.157, 1.16, -0.0997, 0.649, 1.52, 0.524, 1.27, 1.42, -0.0362, 0.189, -0.911, 0.085, 0.0568, 0.168,
    0.194, 0.382, -0.47, 0.326, -0.256, -0.767, -1.34, -0.752, -0.101, -0.221,
)
# fmt: on


class PolicyTable(Table, acts='compliance.policy.model = "network"'):
    """`[compliance.policy]`: a trained network that sets the damping of `[admittance]` along a push and across it.

    `tandemlift train` finds weights. The admittance stays passive whatever they are.
    """

    model: Literal["none", "network"] = key(
        "none",
        None,
        "what sets the virtual damping",
        choices={"none": "`admittance.damping` alone", "network": "a network multiplies it"},
    )
    factor: AtLeastOne = key(
        4.0, "1", "largest factor by which the network multiplies or divides the damping", source="chosen"
    )
    weights: tuple[float, ...] | None = key(
        None,
        "1",
        "weights: for each hidden unit those of its six inputs and its bias, then for each output (damping along the "
        "push, across it) those of the hidden units and its bias",
        rule="9 H + 2 numbers from -100 to 100, of H hidden units",
        unset="those of the policy that ships",
        example=[0.0] * LEAST_NUMBERS,
    )

    @staticmethod
    def zeros(hidden: int) -> list[float]:
        """The weights of a network that changes nothing, with so many hidden units.

        Raises:
            InputError: there are none, or too many.
        """
        if not 1 <= hidden <= MOST_UNITS:
            raise InputError(f"--hidden {hidden}: must be from 1 to {MOST_UNITS}")
        return [0.0] * (hidden * (INPUTS + 1 + OUTPUTS) + OUTPUTS)


class Policy(NamedTuple):
    """Weights of the hidden units and of the outputs, row by row; ln r; √C [√(N·s/m)]."""

    hidden: NumberSet
    outputs: NumberSet
    log_factor: Number
    root: Vec3


class PolicyChannels(NamedTuple):
    """The factors of the damping along the push and across it."""

    damping_factor_along: Number
    damping_factor_across: Number


@law
def layer(weights: NumberSet, x: Sequence[Number]) -> list[Number]:
    """tanh(W [x, 1]), with the rows of W one after another."""
    numbers, answers = list(weights), list[Number]()
    for at in range(0, len(numbers), len(x) + 1):
        sum_ = numbers[at + len(x)]
        for weight, value in zip(numbers[at:], x, strict=False):
            sum_ = sum_ + weight * value
        answers.append(tanh(sum_))
    return answers


@law
def policy_inputs(push: LowPassState[Vec3], v: Vec3) -> tuple[Number, ...]:
    """|F|; its rate along and across F; the velocity along and across F; |v|: each over what counts as one."""
    F, R = push
    size = sqrt(maximum(F.x * F.x + F.y * F.y, TINY))
    inverse = 1.0 / (size + LEAST_FORCE)
    turns, beside = F.x * R.y - F.y * R.x, F.x * v.y - F.y * v.x
    return (
        size * (1.0 / FORCE),
        (F.x * R.x + F.y * R.y) * (inverse / RATE),
        absolute(turns) * (inverse / RATE),
        (F.x * v.x + F.y * v.y) * (inverse / SPEED),
        absolute(beside) * (inverse / SPEED),
        sqrt(maximum(v.x * v.x + v.y * v.y, TINY)) * (1.0 / SPEED),
    )


@law(absent=(Absent(), Absent()))
def policy_damping(
    policy: Policy, push: LowPassState[Vec3], velocity: Vec3, enabled: Number
) -> tuple[Vec3 | Absent, PolicyChannels | Absent]:
    """(The force [N, world axes] by which the damping differs from the mission's, the channels).

    Args:
        policy: the policy.
        push: beyond the threshold [N, world axes], and its rate.
        velocity: of the reference [m/s].
        enabled: 1 while the vehicle follows pushes, else 0.
    """
    F = push.value
    y = layer(policy.outputs, layer(policy.hidden, policy_inputs(push, velocity)))
    along, across = [exp(value * (policy.log_factor * enabled)) for value in y]
    inverse = 1.0 / (sqrt(maximum(F.x * F.x + F.y * F.y, TINY)) + LEAST_FORCE)
    e = Vec3(F.x * inverse, F.y * inverse, 0.0) * policy.root
    more = Vec3(1.0 - across, 1.0 - across, 0.0) * policy.root * policy.root * velocity
    return more - e * ((along - across) * dot(e, velocity)), PolicyChannels(along, across)


@law(absent="force")
def with_policy(eased: Vec3, force: Vec3) -> Vec3:
    """A force [N, world axes] with that of a policy."""
    return force + eased


@law(absent="power")
def dissipated_with(eased: Vec3, power: Number, velocity: Vec3) -> Number:
    """The power that the damping dissipates [W], with that of a policy."""
    return power - dot(eased, velocity)


def start_policy(table: PolicyTable, admittance: AdmittanceTable) -> Policy:
    """The policy around the damping of an admittance."""
    weights = SHIPPED if table.weights is None else table.weights
    cut = len(weights) // (INPUTS + 1 + OUTPUTS) * (INPUTS + 1)
    hidden, outputs = (each(len(part))(*part) for part in (weights[:cut], weights[cut:]))
    root = Vec3(*map(math.sqrt, admittance.damping))
    return Policy(hidden, outputs, math.log(table.factor), root)


def policy_checks(table: PolicyTable, admittance: AdmittanceTable, guidance: str, step: float) -> Iterator[CheckResult]:
    """Check for a policy without effect, of another size, or whose largest damping is unstable when sampled."""
    if table.weights is not None:
        count, beyond = len(table.weights), [w for w in table.weights if abs(w) > LARGEST_WEIGHT]
        if count < LEAST_NUMBERS or (count - OUTPUTS) % (INPUTS + 1 + OUTPUTS):
            yield refused(f"compliance.policy.weights has {count} numbers: must be 9 H + 2 for H hidden units, as 11")
        if beyond:
            span = f"from -{LARGEST_WEIGHT:g} to {LARGEST_WEIGHT:g}"
            yield refused(f"compliance.policy.weights has {beyond[0]:g}: each must be {span}")
    if table.model == "none":
        return
    if guidance != "interactive":
        yield refused('compliance.policy.model = "network": must be "none" where pilot.guidance is "scheduled"')
    horizontal = zip(admittance.mass[:2], admittance.damping[:2], strict=True)
    most = min((2.0 * m / (step * c) for m, c in horizontal if c > 0.0), default=math.inf)
    if table.factor > most:
        yield refused(
            f"compliance.policy.factor = {table.factor:g}: must be at most {most:.4g}, or sampling is unstable"
        )


POLICY = Part(
    *("policy", "compliance", "compliance.policy", PolicyTable.acts, start_policy),
    remembers=False,
    refusals=policy_checks,
    channels=PolicyChannels,
)
