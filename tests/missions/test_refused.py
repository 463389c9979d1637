"""What no mission can be is refused with the key, its value and what is allowed."""

import numpy as np
import pytest
from for_all import for_all

import tandemlift as tl

BY_HAND, BY_CLOCK = {"pilot.guidance": "interactive"}, {"pilot.guidance": "scheduled"}
WATCHED = {**BY_HAND, "supervision.model": "on"}
TRUTH = {"sensors.model": "none", "pilot.state": "truth", "pilot.push": "truth"}
FROZEN = {"sensor": "gyroscope", "kind": "frozen", "time": 5.0}

SUPERVISION = [  # changes of mission iris, and a part of the refusal
    ({**BY_CLOCK, "supervision.model": "on"}, 'supervision.model = "on": must be "none"'),
    ({**BY_CLOCK, "requests": [{"time": 1.0, "action": "land"}]}, 'requests.0.action = "land": must be left out'),
    ({**BY_CLOCK, "estimator.tare": "hover"}, 'estimator.tare = "hover": must be "at-time"'),
    ({**BY_HAND, "requests": [{"time": 1.0, "action": "jump"}]}, 'requests.0.action = "jump": must be'),
    ({**TRUTH, "sensor_faults": [FROZEN]}, "sensors.model"),
    ({"sensor_faults": [FROZEN, FROZEN]}, "fails already in sensor_faults.0"),
    ({"sensor_faults": [FROZEN, {**FROZEN, "sensor": "imu", "kind": "nan"}]}, "fails already in sensor_faults.0"),
    ({"sensor_faults": [{**FROZEN, "kind": "stale"}]}, "must be of a device"),
    ({"sensor_faults": [{**FROZEN, "sensor": "imu", "kind": "bias"}]}, "must be of a sensor"),
    ({"sensor_faults": [{**FROZEN, "quadrotor": 1}]}, 'unless the sensor is "joints"'),
    ({"sensor_faults": [{**FROZEN, "sensor": "joints", "quadrotor": 3}]}, "must be from 1 to 2"),
    ({"sensor_faults": [{**FROZEN, "until": 5.0}]}, "must be after sensor_faults.0.time"),
    ({**BY_HAND, "supervision": {"model": "on", "fence": {"low": 2.0, "high": 1.0}}}, "supervision.fence.low"),
    ({**WATCHED, "supervision.watchdog.stale_time": 0.004}, "supervision.watchdog.stale_time = 0.004"),
    ({**WATCHED, "supervision.checks.min_payload_ratio": 3.0}, "min_payload_ratio = 3.0"),
    ({**WATCHED, "crash.tilt": 0.9, "promise.tilt": 0.3}, "crash.tilt = 0.9: must be above supervision.limits.tilt"),
    ({**WATCHED, "crash.fence_margin": 0.2}, "crash.fence_margin = 0.2: must be at least supervision.fence.margin"),
    ({**WATCHED, "supervision.fence.low": [-9.0, -9.0, 1.5]}, "starts 1.47 m outside supervision.fence"),
    ({**WATCHED, "supervision.fence.high": [9.0, 9.0, 0.5]}, "phases.height = 1: the lift ends at 1.03 m, above"),
]

PROMISES = [
    ({"promise.rms_distance": 1.0}, "promise.rms_distance = 1.0: must not be above promise.distance = 0.25"),
    ({"promise.distance": 3.0}, "findings.reach_distance = 2.0: must be above promise.distance = 3.0"),
    ({"findings.fastest_oscillation": 0.2}, "must be above findings.slowest_oscillation = 0.3"),
    ({"promise.tilt": 1.6}, "promise.tilt = 1.6: must be below crash.tilt = 1.553"),
    ({"promise.tilt": 4.0}, "promise.tilt = 4.0: must be a number > 0"),
    ({"findings.oscillation_periods": 1}, "findings.oscillation_periods = 1: must be a whole number"),
    ({"findings.saturated_fraction": 1.5}, "findings.saturated_fraction = 1.5: must be a number > 0 and ≤ 1"),
    ({"findings.ignore": ["tuched"]}, 'Did you mean "touched"?'),
    ({"findings.ignore": "touched"}, "findings.ignore"),
    ({"mission.step": 0.02, "findings.slowest_oscillation": 15.0}, "slowest_oscillation = 15.0: must be below 12.5"),
]

WITHOUT = {"sensors.joints.model": "none", "estimator.wrench": "kalman"}
WIND = {"estimator.wind_compensation": "quadrotors"}
BROKEN = [{"sensor": "joints", "kind": "nan", "time": 20.0}]
SLOW = {"estimator.wrench": "unscented", "sensors.motion.interval": 0.05}
MOMENTUM = {"estimator.wrench": "momentum", "estimator.wrench_observer.force_bandwidth": 10.0}
WRENCH = [
    ({"sensors.joints.model": "none"}, "sensors.joints.model"),
    ({**WITHOUT, "allocation.method": "pseudo-inverse", "observer.model": "none"}, "allocation.method"),
    ({**WITHOUT, **TRUTH}, "sensors.model"),
    ({**WITHOUT, **WIND}, "wind and a hand make the"),
    ({"estimator.wrench": "fused", **WIND}, "estimator.wind_compensation"),
    ({**WITHOUT, "sensor_faults": BROKEN}, "sensor_faults"),
    ({**WITHOUT, **SLOW}, "at most 0.0188 N/√s with samples every 0.05 s"),  # 3.5 kg of 3 mm and √5 ms times 20³
    ({**WITHOUT, **SLOW}, "for a bandwidth of 2 rad"),
    ({"sensors.interval": 0.02, **MOMENTUM}, "at most 5 rad/s"),
    ({"sensors.interval": 0.02, "estimator.wrench": "kalman"}, "must be at most 0.0742 N/√s"),
]

ON = {"contact.model": "on"}
CONTACT = [
    ({**ON, **BY_CLOCK}, 'contact.model = "on": must be "none" where pilot.guidance is "scheduled"'),
    ({**ON, "pilot.push": "truth"}, 'contact.model = "on": must be "none" where the pilot reads no joints'),
    ({**ON, "contact.threshold": 0.0}, "contact.threshold"),
    ({"contact.model": "look"}, "contact.model"),
    ({**ON, "pilot.map": "doors"}, "pilot.map"),
]


def push(point):
    return {"pushes": [{"time": 15.0, "sigma": 0.6, "force": [1.0, 0.0, 0.0], "point": point}]}


TILTED = {"initial.euler": [0.3, 0.3, 0.0], "crash.tilt": 0.4, "ground.height": -3.0}
CLOSE = [0.0, 0.5, 0.06]
VEHICLE = [
    ({"initial.euler": [0.0, 3.0, 0.0]}, "initial.euler = [0.0, 3.0, 0.0]: must have a pitch"),
    (TILTED, "initial.euler = [0.3, 0.3, 0.0]: must tilt by less than crash.tilt = 0.4"),
    ({"vehicle.quadrotors.1.rotor_radius": 0.14}, "rotor_radius = 0.14: rotor 1 of quadrotor 2 and rotor 4"),
    ({"vehicle.quadrotors.1.position": CLOSE}, "position = [0.0, 0.5, 0.06]: rotor 1 of quadrotor 1 and rotor"),
    (push([50.0, 0.0, 0.0]), "pushes.0.point = [50.0, 0.0, 0.0]"),
    (push([0.0, 0.0, 1.0]), "whose parts reach from [-0.38"),
    ({"phases.height": -1.0}, "phases.height = -1.0: must be 0 or above over a floor"),
]

INERTIA = {"vehicle.payload.inertia": [0.17, 0.03, 0.16], "vehicle.payload.products": [0.0, 0.0, 0.09]}
BOX = {"vehicle.payload.shape": "box", "vehicle.payload.size": [0.8, 3.0, 0.3]}
BODIES = [
    {"mass": 0.2, "ends": [[0.1, -1.5, 0.0], [-0.1, 1.5, 0.1]], "radius": 0.06},
    {"mass": 0.1, "corners": [[0.5, 0.0, 0.0], [0.2, 0.2, 0.0], [0.2, -0.2, 0.0], [0.3, 0.0, 0.3]]},
]
SEVERAL = {"vehicle.payload.shape": "bodies", "vehicle.payload.bodies": BODIES}
PAYLOAD = [
    (INERTIA, "products of inertia of a body; its principal moments would be -0.0"),
    ({"vehicle.payload.size": [1.0] * 3}, 'no size = [1.0, 1.0, 1.0] with shape = "beam", or shape must'),
    ({"vehicle.payload.shape": "box"}, 'must have size with shape = "box"'),
    ({**BOX, "vehicle.payload.length": 2.0}, 'no length = 2.0 with shape = "box"'),
    ({**BOX, "vehicle.payload.size.2": 0.0}, "payload.size.2 = 0.0: must be a number > 0"),
    ({"vehicle.payload.shape": "plate"}, 'shape = "plate": must be '),
    ({**SEVERAL, "vehicle.payload.mass": 0.9}, "mass = 0.9: must be left out, because it comes from bodies"),
    ({**SEVERAL, "vehicle.payload.bodies.0.size": [1.0] * 3}, "bodies.0: must have either ends and radius"),
    ({**SEVERAL, "vehicle.payload.bodies.0.radius": None}, "bodies.0: must have ends and radius together"),
    ({**SEVERAL, "vehicle.payload.bodies.0.euler": [0.1, 0.0, 0.0]}, "bodies.0: must have no position and no euler"),
    ({**SEVERAL, "vehicle.payload.bodies": []}, "must have one table of bodies or more"),
    ({**SEVERAL, "vehicle.payload.bodies.1.corners.3": [0.3, 0.0, 0.0]}, "corners of a convex body; these 4"),
]

FEEL = [
    ({"preset": "lihgt"}, '.preset = "lihgt": must be "light", "firm" or "slow". Did you mean "light"?'),
    ({"force": 0.2}, ".force = 0.2: must be above admittance.threshold = 0.3 along x"),
    ({"force": [1, 1, 0.3]}, ".force = 0.3: must be above admittance.threshold = 0.3 along z"),
    ({"speed": 0}, ".speed = 0: must be one number or a list of 3 numbers, each > 0"),
    ({"time": [1, 2]}, ".time = [1, 2]: must be one number or a list of 3 numbers, each > 0"),
    ({"softness": 1}, ".softness = 1: unknown key; admittance.feel has preset, force, speed, time"),
    ("firm", ' = "firm": must be a table with preset, force, speed, time'),
]

LINE = ((0.0, 0.0), (5.0, 0.0), (10.0, 3.0), (15.0, 0.0))
LED = {"ground.model": "floor", "initial.euler": 0.0, "phases.rotors": "always"}
CORRIDOR = [  # on top of mission hover, on a floor
    ({"corridor.centreline": [[0.0, 0.0]]}, "two points or more"),
    ({"corridor.centreline": [[0.0, 0.0], [0.0, 0.0]]}, "two points or more"),
    ({"corridor.centreline": [[0.0, 0.0], [5.0, 0.0], [1.0, 0.1]]}, "150°"),
    ({"corridor.centreline": [[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [0.0, 1.0]]}, "farther apart"),
    ({"corridor.centreline": LINE, "ground.model": "none"}, "ground.model"),
    ({"person.model": "steer"}, "[[person.path]]"),
    ({"person.model": "pull", "person.grip": 1.2, "corridor.centreline": LINE}, "from -1 m to 1 m"),
    ({"person.delay": 1.5}, "person.delay"),
    ({"person.model": "push"}, '"two-hands"'),
    ({"mission.step": 1e-5, "person.delay": 0.9, "mission.duration": 1.0}, "10000 steps"),
]

CHANGES = [  # of mission paper
    ({"mission.step.size": 1}, "mission.step = 0.001 has no keys of its own"),
    ({"mission.duration.1": 2.0}, "mission.duration = 90.0 has no keys of its own"),
    ({"admittance.mass.3": 2.0}, "'3' must be a number from 0 to 2"),
    ({"pushes.8.sigma": 1.0}, "'8' must be a number from 0 to 7"),
    ({"pushes.-1.sigma": 1.0}, "'-1' must be a number from 0 to 7"),
    ({f"pushes.{'9' * 5000}.sigma": 1.0}, "must be a number from 0 to 7"),
    ({"pushes.².sigma": 1.0}, "'²' must be a number from 0 to 7"),
    ({"pushes.first.sigma": 1.0}, "'first' must be a number from 0 to 7"),
    ({"pushes": [], "pushes.0.sigma": 1.0}, "the list is empty"),
    ({"": 1}, "'' is not a dotted key"),
    ({"mission..step": 1}, "'mission..step' is not a dotted key"),
    ({5: 1}, "5 is not a dotted key"),
    ({"mission.stepp": 0.01}, "mission.stepp = 0.01: unknown key"),
    ({"phases": 3}, "phases = 3: must be a table"),
    ({"phases": {"hight": 3}}, "Did you mean phases.height?"),
    ({"extends": "hover"}, 'extends = "hover": unknown key'),
    ({"mission.duration": None}, "mission.duration = None"),
    ({"mission.duration": object()}, "mission.duration"),
    ({"a." * 10_000 + "b": 1}, "nested too deeply"),
    ({"controller.gains.xi": np.full(6, np.nan)}, "controller.gains.xi.0 = nan"),
]

OF_IRIS = [*SUPERVISION, *PROMISES, *WRENCH, *CONTACT, *VEHICLE, *PAYLOAD]
OF_IRIS += [({"admittance.feel": feel}, f"iris: admittance.feel{piece}") for feel, piece in FEEL]
ROWS = [
    *[("iris", changes, piece) for changes, piece in OF_IRIS],
    *[("hover", LED | changes, piece) for changes, piece in CORRIDOR],
    *[("paper", changes, piece) for changes, piece in CHANGES],
]


@for_all(ROWS)
def test_what_cannot_be_is_refused_with_the_key_its_value_and_what_is_allowed(row):
    mission, changes, piece = row
    with pytest.raises(tl.InputError) as refused:
        tl.load_mission(mission, changes)
    assert piece in str(refused.value)
