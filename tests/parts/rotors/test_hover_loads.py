"""The wind's force on the parts of a hovering vehicle: ½ ρ c A v |v| along each body axis."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.hover_loads import WindOnParts

WIND = np.array([3.0, -2.0, 1.0])


@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_the_wind_pushes_payload_and_quadrotors_by_their_areas_and_coefficients(yaw):
    mission = tl.load_mission("iris", {"wind.model": "air", "wind.velocity": WIND.tolist(), "wind.density": 1.1})
    vehicle = Vehicle.from_settings(mission.vehicle)
    found = WindOnParts(mission.wind, vehicle, yaw, mission.mission.step)
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    air, payload = R.T @ WIND, vehicle.payload

    def force(areas, coefficient):
        return R @ (0.5 * 1.1 * coefficient * np.array(areas) * air * np.linalg.norm(air))

    on_beam = force(payload.areas, payload.drag_coefficient)
    assert found.on_payload(0.0) == pytest.approx(on_beam)
    fleet = sum(force(q.drag_area, q.drag_coefficient) for q in vehicle.quadrotors)
    assert found.at(None)[0] == pytest.approx(on_beam + fleet)
