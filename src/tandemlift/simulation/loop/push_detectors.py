"""Detectors of a push without response, and of a response without a push.

`simulation.loop.detectors` runs them. The pilot's response to a measured push is visible in the force after its gate;
only the simulation knows the true push.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import chosen, clip, maximum, sqrt, where
from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, dot
from tandemlift.parts.guidance.admittance import soft_threshold
from tandemlift.simulation.loop.excess import NO_EXCESS, Excess, exceed
from tandemlift.simulation.loop.log_sample import Sample

ECHO_TIME = 0.5  # s after a true push, in which filters may still pass it on


class PushLimits(NamedTuple):
    """The expected response to a push.

    `threshold` [N] above which a true push should have an effect, or `Absent` if the pilot receives every push. The
    square of the `least` force that counts [N²]. 1/C of the axes that yield without a spring [m/(N s)], and the largest
    `speed` [m/s]. After a `time` [s], the work of a push must be a `response` of that at the speed that the admittance
    ends with.
    """

    threshold: Vec3 | Absent
    least: Number
    inverse_damping: Vec3
    speed: Vec3
    time: Number
    response: Number


class PushResponse(NamedTuple):
    """Memory: 1 while there is a push, else 0, and its start [s].

    The work that it should do and that it does [J], with what it does not reach. With `now` 0 before and after a step,
    nothing changes.
    """

    now: Number
    since: Number
    expected: Number
    done: Number
    unanswered: Excess


class UnpushedMotion(NamedTuple):
    """Memory: the last time of a true push [s], and the motion of the reference since then.

    `now` is 1 while there is a push or one is followed, else 0; with it 0 before and after a step, nothing changes.
    `begun` is 1 once a push was followed since then, else 0; `origin` [m]: the reference at that time.
    """

    now: Number
    last: Number
    begun: Number
    origin: Vec3
    excess: Excess


NO_RESPONSE = PushResponse(0.0, 0.0, 0.0, 0.0, NO_EXCESS)
UNMOVED = UnpushedMotion(0.0, 0.0, 0.0, ZERO, NO_EXCESS)


@law(absent="gated")
def push_to_answer(threshold: Vec3, least: Number, gated: Vec3, true: Vec3) -> Vec3:
    """The push that should move the vehicle [N]: that after the gate, else a true one that should have an effect."""
    return chosen(where(dot(gated, gated) > least, 1.0, 0.0), gated, soft_threshold(true, threshold))


@law
def push_step(
    k: PushLimits, m: PushResponse, push: Vec3, x: Sample, active: Number, t: Number, dt: Number
) -> PushResponse:
    """The memory of the response after a step under a push [N]; `active` is 1 while pushes should be followed."""
    now = where(dot(push, push) > k.least, active, 0.0)
    goes_on = where(now > m.now, 0.0, 1.0)
    since = where(now > m.now, t, m.since)
    speed = clip(push * k.inverse_damping, -k.speed, k.speed)
    along = Vec3(*[where(c > 0.0, v, 0.0) for c, v in zip(k.inverse_damping, x.velocity, strict=True)])
    expected = m.expected * goes_on + dot(push, speed) * (now * dt)
    done = m.done * goes_on + dot(push, along) * (now * dt)
    missing = now * where(t - since < k.time, 0.0, where(done < k.response * expected, 1.0, 0.0))
    size = sqrt(maximum(dot(push, push), 1e-24))
    return PushResponse(now, since, expected, done, exceed(m.unanswered, missing, size, x.position, t, dt))


@law
def unpushed_step(
    limit: Number, m: UnpushedMotion, now: tuple[Number, Number], reference: Vec3, place: Vec3, t: Number, dt: Number
) -> UnpushedMotion:
    """The memory after a step.

    Args:
        limit: largest motion of the reference without a push [m].
        m: the memory before.
        now: (1 while there is a true push, 1 while one is followed), else 0.
        reference: of the admittance [m, world axes].
        place: of the vehicle [m, world axes].
        t: time at the start of the step [s].
        dt: length of the step [s].
    """
    pushed, followed = now
    echo = where(t - m.last < ECHO_TIME, where(m.last > 0.0, 1.0, 0.0), 0.0)
    alone = followed * (1.0 - pushed) * (1.0 - echo)
    origin = chosen(alone * (1.0 - m.begun), reference, m.origin)
    moved = sqrt(maximum(dot(reference - origin, reference - origin), 1e-24))
    over = where(moved > limit, alone, 0.0)
    return UnpushedMotion(
        now=maximum(pushed, followed),
        last=where(pushed > 0.0, t, m.last),
        begun=where(pushed > 0.0, 0.0, maximum(m.begun, alone)),
        origin=origin,
        excess=exceed(m.excess, over, moved, place, t, dt),
    )
