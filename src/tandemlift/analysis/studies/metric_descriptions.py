"""The metrics of a flight: unit, components and meaning of each, and the missions that have it.

This is the only list of metrics. Tables, reports and the reference of metrics are made from it. Numbers are SI, with
the unit at the end of a name. `simulation.loop.running_metrics` computes them from every step, not from the log; those
of a bag come from its samples.
"After 10 s" excludes a disturbed start. Errors are desired minus actual. A metric that cannot be computed is null.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.errors import InputError
from tandemlift.core.plugs import PLUGS, Plug

AXES = ("x", "y", "z")
ANGLES = ("roll", "pitch", "yaw")
INPUTS = ("U1", "U2", "U3", "U4")
ALSO = "also while stopped rotors do not follow it, and beyond what rotors can give"


class Metric(NamedTuple):
    """The description of a metric.

    Attributes:
        unit: unit of its number or numbers, "1" for none; "" if it is not a number.
        meaning: a short description.
        components: names of its numbers; empty for a single number.
        units: of the components, if they differ.
    """

    unit: str
    meaning: str
    components: tuple[str, ...] = ()
    units: tuple[str, ...] = ()

    def unit_of(self, component: int) -> str:
        """The unit of a component, "" for none."""
        unit = self.units[component] if self.units else self.unit
        return "" if unit == "1" else unit


class MetricGroup(NamedTuple):
    """A group of metrics with `when`, the condition on the mission in Markdown."""

    when: str
    metrics: dict[str, Metric]


METRIC_GROUPS: tuple[MetricGroup, ...] = (
    MetricGroup(
        "In every flight",
        {
            "position_rmse_m": Metric("m", "root mean square of the position error", AXES),
            "position_rmse_after_10s_m": Metric("m", "root mean square of the position error after 10 s", AXES),
            "position_max_error_m": Metric("m", "largest absolute position error", AXES),
            "position_max_error_after_10s_m": Metric("m", "largest absolute position error after 10 s", AXES),
            "attitude_rmse_rad": Metric(
                "rad",
                "root mean square of the attitude error, relative to the reference that the attitude law tracks",
                ANGLES,
            ),
            "velocity_max_error_after_10s_m_s": Metric("m/s", "largest absolute velocity error after 10 s", AXES),
            "max_tilt_after_10s_rad": Metric("rad", "largest absolute Euler angle after 10 s", ANGLES),
            "thrust_min_after_10s_n": Metric("N", f"smallest commanded thrust U1 after 10 s, {ALSO}"),
            "thrust_max_after_10s_n": Metric("N", f"largest commanded thrust U1 after 10 s, {ALSO}"),
            "moment_max_abs_after_10s_n_m": Metric(
                "N m", f"largest absolute commanded moment after 10 s, {ALSO}", INPUTS[1:]
            ),
            "human_impulse_n_s": Metric("N s", "integral over time of the person's push, unfiltered", AXES),
            "human_work_j": Metric("J", "work of the person's push: integral of F·v, v of the point pushed"),
            "push_triggers_after_10s": Metric(
                "1",
                "number of pushes that interactive guidance began to follow, including one followed at 10 s; `null` "
                "with scheduled guidance, which follows each push without a trigger",
            ),
            "rotor_saturated_share": Metric(
                "1", "fraction of steps with any rotor at a limit that is not known as failed; 0 with ideal actuators"
            ),
            "final_position_m": Metric("m", "position at the end", AXES),
            "final_reference_m": Metric("m", "reference of the position at the end", AXES),
            "command_at_start": Metric(
                "N, N m", "commanded thrust U1 and moments U2, U3, U4 at t = 0", INPUTS, ("N", "N m", "N m", "N m")
            ),
            "outcome": Metric("", "outcome: `landed`, `flying`, `not-lifted`, `crashed`, `diverged`, `interrupted`"),
            "findings": Metric(
                "", "findings: a list of [time in s, kind, text]; `flight.findings` has place, number and remedy"
            ),
            "failure": Metric(
                "", "reason for which it crashed, diverged or did not lift, in one sentence; empty if it did not fail"
            ),
            "steps": Metric("1", "number of steps"),
            "wall_s": Metric("s", "computing time"),
            "events": Metric("", "first 16 phases and alarms of a supervised flight: a list of [time in s, text]"),
        },
    ),
    MetricGroup(
        "With walls (`[[walls]]` or `[corridor]`)",
        {
            "clearance_min_m": Metric(
                "m", "smallest distance of guards and beam from any wall, exact at every step; below zero in contact"
            ),
            "wall_contact": Metric("", "whether any wall was touched"),
        },
    ),
    MetricGroup(
        "With a person who guides the vehicle (`[person]`), over the steps in which the person holds it",
        {
            "human_time_s": Metric("s", "time for which the person held it"),
            "human_force_mean_n": Metric("N", "mean magnitude of the person's force"),
            "human_path_m": Metric("m", "distance flown by the centre of mass"),
            "human_work_per_path_j_m": Metric("J/m", "`human_work_j` per distance flown"),
        },
    ),
    MetricGroup(
        "With detection of a lost rotor (`detection.model`)",
        {
            "rotor_failure_detections": Metric("1", "number of times that `[detection]` classified a rotor as failed"),
            "rotor_failure_detection_delay_s": Metric(
                "s", "detection delay of the rotor that is classified as failed at the end"
            ),
        },
    ),
    MetricGroup(
        "With `estimator.error_metrics`, over the steps in which the push is usable",
        {
            "push_force_rmse_n": Metric("N", "root mean square of the error of the estimated push", AXES),
            "push_moment_rmse_n_m": Metric(
                "N m", "root mean square of the error of its moment about the payload's centre of mass", ANGLES
            ),
            "push_delay_s": Metric("s", "delay of the estimated push that best explains its error (least squares)"),
        },
    ),
    MetricGroup("Of a bag", {"samples": Metric("1", "number of samples, from which the metrics are formed")}),
)
METRICS: dict[str, Metric] = {name: metric for group in METRIC_GROUPS for name, metric in group.metrics.items()}
"""All metrics by name, in the order of metrics.json within a group."""


def metric_of(name: str) -> Metric:
    """The description of a metric, which a user may have brought; an empty one for one that is not known here."""
    own = PLUGS["metric"].get(name)
    return Metric("1", own.summary) if own else METRICS.get(name, Metric("", ""))


def taken_in(made: Plug) -> Plug:
    """A metric of a user: a function of a `Flight` that gives a number, a list of them, or None."""
    if made.name in METRICS:
        raise InputError(f"the name {made.name!r} is taken by a metric of the package; choose another")
    return made


PLUGS["metric"].open(taken_in)
