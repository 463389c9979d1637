"""The push that the pilot uses, from that on the payload: moved to the centre of mass, less the drag, if trusted."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, vec3
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.health import WatchdogReport
from tandemlift.simulation.loop.estimate_channels import estimated_channels
from tandemlift.simulation.loop.fault_tolerant_perception import CheckedEstimates, reported_by, trusted_push
from tandemlift.simulation.loop.perception import Estimates
from tandemlift.simulation.loop.sources import EstimateSource, MeasurementSource, NominalVehicle, read_push

VEHICLE = NominalVehicle(
    payload=Vec3(0.1, -0.2, -0.3), drag_force=Vec3(0.2, 0.3, 0.4), drag_moment=Vec3(0.01, 0.02, 0.03)
)
TURNED = Rotation.from_euler("zxy", [0.7, -0.3, 0.4])
STATE = State(ZERO, Vec3(1.0, -2.0, 0.5), Quat(*TURNED.as_quat(scalar_first=True).tolist()), Vec3(0.5, -0.4, 0.3))
MEASURED, ESTIMATED = (np.array([3.0, -1.0, 2.0]), np.array([0.3, 0.2, -0.1])), (np.ones(3), np.array([-0.2, 0.1, 0.4]))
PUSH = PushEstimate(
    *map(vec3, (*MEASURED, *ESTIMATED)),
    point=0.0,
    payload_mass=1.0,
    disagreement=0.0,
    trusted=1.0,
    armed=1.0,
    usable=ZERO,
)


def used(source, **push):
    """Force and moment that the pilot uses."""
    known = Estimates(PUSH._replace(**push), STATE, VEHICLE, Absent())
    found = read_push(source, None, STATE, known)
    return np.array(found.force), np.array(found.moment)


@pytest.mark.parametrize(("source", "wrench"), [(MeasurementSource(), MEASURED), (EstimateSource(), ESTIMATED)])
def test_the_wrench_on_the_payload_is_moved_to_the_centre_of_mass_less_the_drag(source, wrench):
    """F = F_p + D v; M = M_p + D_ω ω + r × Rᵀ F, with R by SciPy."""
    force = wrench[0] + np.array(VEHICLE.drag_force) * np.array(STATE.velocity)
    lever = np.cross(VEHICLE.payload, TURNED.inv().apply(force))
    moment = wrench[1] + np.array(VEHICLE.drag_moment) * np.array(STATE.rates) + lever
    found = used(source)
    assert found[0] == pytest.approx(force)
    assert found[1] == pytest.approx(moment)


@pytest.mark.parametrize("source", [MeasurementSource(), EstimateSource()])
@pytest.mark.parametrize("doubt", [{"trusted": 0.0}, {"armed": 0.0}, {"trusted": 0.0, "armed": 0.0}])
def test_a_push_that_is_not_trusted_or_not_armed_is_none(source, doubt):
    for part in used(source, **doubt):
        assert not part.any()


@pytest.mark.parametrize("broken", ["joints", "accelerometer", "imu"])
def test_a_broken_sensor_takes_the_trust_and_is_no_inconsistency(broken):
    sound = WatchdogReport(*[0.0] * len(WatchdogReport._fields))
    failed, push = sound._replace(**{broken: 1.0}), PUSH._replace(usable=vec3([1.0, 2.0, 3.0]))
    assert trusted_push(push, sound) == push
    lost = trusted_push(push, failed)
    assert (lost.trusted, lost.usable) == (0.0, ZERO)

    def doubt(report, **changes):
        fields = dict.fromkeys(CheckedEstimates._fields) | {"push": push._replace(**changes), "report": report}
        return reported_by(CheckedEstimates(**fields)).joints_inconsistent

    assert doubt(sound) == doubt(failed) == doubt(failed, trusted=0.0) == 0.0
    assert doubt(sound, trusted=0.0) == 1.0


@pytest.mark.parametrize(("trusted", "armed"), [(1.0, 1.0), (0.0, 1.0), (1.0, 0.0)])
def test_the_channels_of_estimates_are_the_estimates_checked_or_not(trusted, armed):
    known = Estimates(PUSH._replace(trusted=trusted, armed=armed), STATE, VEHICLE, Absent())
    shown = estimated_channels(known)
    assert (shown.estimated_position, shown.estimated_rates) == (STATE.position, STATE.rates)
    assert (shown.push_measured, shown.push_estimate) == (PUSH.measured, PUSH.force)
    assert shown.push_usable == trusted * armed
    fields = {**dict.fromkeys(CheckedEstimates._fields), **known._asdict()}
    assert estimated_channels(CheckedEstimates(**fields)) == shown
