"""A vehicle as URDF, read by MuJoCo, which has a reader of its own."""

import mujoco
import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.export.coordinate_frames import fixed
from tandemlift.apps.export.write import export
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.parts.mechanics.vehicle import Vehicle

AS_IT_IS = """<mujoco><compiler fusestatic="false" discardvisual="false" boundmass="0" boundinertia="0"/></mujoco>"""


@pytest.mark.parametrize("name", ["iris", "heavy-payload"])
def test_mass_centre_inertia_frames_and_looks_are_the_vehicle_s(name, tmp_path):
    mission = tl.load_mission(name)
    vehicle = Vehicle.from_settings(mission.vehicle)
    text = export(mission, tmp_path / f"{name}.urdf").read_text("utf-8")
    opening = f'<robot name="{name}">'
    assert opening in text
    model = mujoco.MjModel.from_xml_string(text.replace(opening, opening + AS_IT_IS))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass, place = model.body_mass[1:], data.xipos[1:]
    assert mass.sum() == pytest.approx(vehicle.mass, rel=1e-12)
    assert mass @ place == pytest.approx(np.zeros(3), abs=1e-12)
    turned = data.ximat[1:].reshape(-1, 3, 3)
    own = np.einsum("nij,nj,nkj->ik", turned, model.body_inertia[1:], turned)
    about = sum(m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(mass, place, strict=True))
    assert own + about == pytest.approx(vehicle.inertia, rel=1e-9, abs=1e-12)
    for frame, at in fixed(vehicle):
        assert data.body(frame).xpos == pytest.approx(at, abs=1e-12)
    shapes = vehicle_shapes(vehicle, solid=False)
    assert model.ngeom == len(shapes)
    assert data.geom_xpos == pytest.approx(np.array([shape.position for shape in shapes]), abs=1e-6)
