"""Quadrotors that face another way than body x: their matrices, models and pictures."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.engines.models.links import links_of
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.vehicle import skeleton

ANGLE, PRINCIPAL = 0.6, np.array([0.02, 0.035, 0.05])
TURN = np.array([[np.cos(ANGLE), -np.sin(ANGLE), 0.0], [np.sin(ANGLE), np.cos(ANGLE), 0.0], [0.0, 0.0, 1.0]])
TURNED = {"vehicle.quadrotors.0.heading": ANGLE, "vehicle.quadrotors.0.inertia": PRINCIPAL.tolist()}


def vehicle_of(**changes):
    return Vehicle.from_settings(tl.load_mission("paper", changes).vehicle)


def test_a_quarter_of_a_turn_exchanges_its_axes():
    q = {"inertia": PRINCIPAL.tolist(), "drag_area": [0.1, 0.2, 0.3], "layout": "+", "feet_spread": 0.1}
    own = {f"vehicle.quadrotors.0.{name}": value for name, value in q.items()}
    turned = vehicle_of(**own, **{"vehicle.quadrotors.0.heading": np.pi / 2.0})
    swapped = vehicle_of(
        **own
        | {"vehicle.quadrotors.0.inertia": PRINCIPAL[[1, 0, 2]].tolist()}
        | {"vehicle.quadrotors.0.rotor_positions": [[0.0, 0.25], [-0.25, 0.0], [0.0, -0.25], [0.25, 0.0]]}
    )
    assert turned.inertia == pytest.approx(swapped.inertia, abs=1e-15)
    assert turned.effect == pytest.approx(swapped.effect, abs=1e-15)
    assert turned.quadrotors[0].areas == pytest.approx((0.2, 0.1, 0.3))
    assert turned.allocation() == pytest.approx(swapped.allocation(), abs=1e-12)


def test_its_link_in_models_has_its_whole_tensor():
    mission = tl.load_mission("paper", TURNED)
    link = links_of(mission, Vehicle.from_settings(mission.vehicle))[1]
    assert link.inertia == pytest.approx(TURN @ np.diag(PRINCIPAL) @ TURN.T, abs=1e-12)


def test_pictures_turn_it_with_its_rotors_and_feet():
    vehicle = vehicle_of(**TURNED)
    shapes = [shape for shape in vehicle_shapes(vehicle) if shape.name.startswith(("nose", "rotor_1", "foot_1"))]
    nose, rotor, foot = [next(s for s in shapes if s.name == name) for name in ("nose", "rotor_1", "foot_1")]
    from_center = [shape.position - vehicle.lever_arms[0] for shape in (nose, rotor, foot)]
    assert nose.axes == pytest.approx(TURN)
    assert np.arctan2(*from_center[0][1::-1]) == pytest.approx(ANGLE)
    assert from_center[1][:2] == pytest.approx(TURN[:2, :2] @ vehicle_of().quadrotors[0].rotors[0])
    assert foot.position[:2] == pytest.approx(vehicle.soles[0, 0, :2])
    assert np.arctan2(*from_center[2][1::-1]) == pytest.approx(ANGLE + np.pi / 4.0)
    assert skeleton(vehicle).rotors[0].mean(axis=0)[:2] == pytest.approx(rotor.position[:2])
