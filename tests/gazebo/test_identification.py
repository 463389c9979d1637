"""A vehicle that Gazebo flew, identified from its log: an engine that shares no equation with the estimator."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.identification.identify import reference_rows
from tandemlift.analysis.logs.log import PUSH, Log, log_of
from tandemlift.missions import load_mission, tables_of

pytestmark = [pytest.mark.gazebo, pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")]
START, EXCITED, MASS = "iris", 60.0, 0.55  # s, kg
REAL = {
    "vehicle.payload.mass": MASS,
    "vehicle.payload.center_of_mass": [0.01, -0.06, 0.01],
    "vehicle.quadrotors.0.mass": 1.62,
    "vehicle.quadrotors.1.mass": 1.41,
    "actuators.delay": 0.012,
}
for place in (0, 1):
    REAL |= {
        f"vehicle.quadrotors.{place}.thrust_constant": 6.4e-6,
        f"vehicle.quadrotors.{place}.torque_per_thrust": 0.053,
        f"vehicle.quadrotors.{place}.lag_up": 0.0145,
        f"vehicle.quadrotors.{place}.lag_down": 0.022,
    }
TARGETS = (  # relative, absolute
    (("mass",), 0.003, 0.0),
    (("inertia.x", "inertia.y", "inertia.z"), 0.02, 0.0),
    (("center_of_mass.x", "center_of_mass.y", "center_of_mass.z"), 0.0, 0.002),
    (("vehicle.quadrotors.0.thrust_constant", "vehicle.quadrotors.1.thrust_constant"), 0.01, 0.0),
    (("vehicle.quadrotors.*.lag_up", "vehicle.quadrotors.*.lag_down"), 0.05, 0.0),
    (("actuators.delay",), 0.0, 0.001),
)


def test_a_minute_of_excited_flight_tells_the_vehicle_and_its_intervals():
    tables = tables_of(tl.excite(START, EXCITED).mission)
    design = {f"{name}.{key}": value for name in ("phases", "excitation") for key, value in tables[name].items()}
    flown = {"mission.duration": tables["mission"]["duration"], "mission.log_interval": 0.001, "pushes": []}
    true = load_mission(START, REAL | design | flown)
    log = log_of(tl.fly(true, engine="gazebo"))
    log = Log({name: s for name, s in log.items() if name not in (*PUSH, "rotor_commands")}, "gazebo")
    found = tl.identify(log, START, weighed={"vehicle.payload.mass": MASS}, progress=lambda done, of: None)
    truth = reference_rows(true)
    for keys, relative, absolute in TARGETS:
        for key in keys:
            assert found[key].value == pytest.approx(truth[key], rel=relative, abs=absolute), key
    off = {row.key: abs(row.value - truth[row.key]) / (row.half / 1.96) for row in (*found.rows, *found.whole)}
    assert max(off.values()) < 4.0, max(off.items(), key=lambda item: item[1])
    assert np.mean([size < 1.96 for size in off.values()]) > 0.8
    assert max(found.details["held_back"]["ratio"].values()) < 1.2
