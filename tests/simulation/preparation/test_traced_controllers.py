"""Controllers whose start can be traced in part, or not at all: what depends on it is fixed, with the reason."""

from __future__ import annotations

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.types import flat
from tandemlift.core.vector import layout
from tandemlift.parts.controllers import load_controller
from tandemlift.simulation.preparation.assemble import assemble
from tandemlift.simulation.preparation.traced_assembly import numbers_of_mission, trace_assembly, with_values

OWN = '''
from typing import NamedTuple
import numpy as np
from tandemlift.core.algebra import Number, Vec3, ZERO
from tandemlift.parts.controllers import Command, NoMemory, control, register
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.controllers import ControllerTable
from tandemlift.core.keys import Positive
from tandemlift.core.keys import key

class Settings(ControllerTable):
    """Of this controller."""
    stiffness: Positive = key(4.0, "1/s²", "stiffness")

class Gains(NamedTuple):
    """Of this controller."""
    weight: Number
    stiffness: Number

@control.register(Gains)
def own(k, memory, measured, reference):
    """One sample."""
    up = (reference.trajectory.position.z - measured.state.position.z) * k.stiffness
    return Command(Wrench(k.weight + up, ZERO), ZERO), memory

@register("own", Settings)
def start(s, vehicle, step):
    """Of this test."""
    return Gains({weight}, s.stiffness * 2.0), NoMemory()
'''
STARTS = {
    "of symbols": ("vehicle.mass * 9.81", ()),
    "of a plain number": ("float(vehicle.mass) * 9.81", ("vehicle.payload.mass", "vehicle.quadrotors.0.mass")),
    "of a matrix that NumPy inverts": (
        "9.81 / float(np.linalg.inv(np.diag([vehicle.mass, 1.0]))[0, 0])",
        ("vehicle.payload.mass", "vehicle.quadrotors.1.inertia.2", "controller.stiffness"),
    ),
}


def check_trace(mission, fixed):
    """The trace has the numbers of the plain assembly; these keys are fixed for a reason."""
    traced, plain = trace_assembly(mission), assemble(mission)
    made = with_values(traced.assembled, traced.graph)
    assert layout(made.model) == layout(plain.model)
    assert np.allclose(flat(made.model), flat(plain.model), rtol=1e-12, atol=0.0, equal_nan=True)
    assert {*fixed} <= {*traced.fixed}
    return traced


@pytest.mark.parametrize("name", ["nftsmc", "pid", "smc", "super-twisting", "geometric"])
def test_the_gains_of_our_controllers_are_inputs(name):
    mission = tl.load_mission("hover", {"controller.name": name})
    ours = [key for key in numbers_of_mission(mission) if key.startswith(("controller.", "vehicle."))]
    wanted = {key for key in ours if not key.endswith(".heading")}  # which determines the axes of a quadrotor
    assert len(wanted) > 50
    assert {*check_trace(mission, ()).keys} >= wanted


def test_the_weights_of_the_linear_quadratic_regulator_are_fixed_but_not_the_vehicle():
    traced = check_trace(tl.load_mission("hover", {"controller.name": "lqr"}), ("controller.position_weight.0",))
    reason = traced.fixed["controller.position_weight.0"]
    assert reason == "is used as a plain number by parts.controllers.lqr.regulator"
    assert {"controller.max_tilt", "vehicle.payload.mass", "vehicle.quadrotors.0.inertia.0"} <= {*traced.keys}


@pytest.mark.parametrize(("weight", "fixed"), STARTS.values(), ids=STARTS)
def test_what_a_users_own_start_needs_as_plain_numbers_is_fixed(weight, fixed, tmp_path):
    path = tmp_path / "own.py"
    path.write_text(OWN.replace("{weight}", weight), "utf-8")
    mission = tl.load_mission("hover", {"mission.fma": False}, controller=load_controller(path))
    traced = check_trace(mission, fixed)
    assert "vehicle.drag.force.0" in traced.keys or "controller.stiffness" in fixed
    assert ("controller.stiffness" in traced.keys) == ("controller.stiffness" not in fixed)
    assert tl.fly(tl.load_mission("hover", {"mission.fma": False, "mission.duration": 0.1}, controller="own"))
