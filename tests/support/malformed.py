"""Malformed missions, each with pieces of its error message."""

from typing import NamedTuple

QUADROTOR = (
    "{mass = 1.5, inertia = [0.03, 0.03, 0.05], position = [%s], layout = 'x', arm = 0.25, thrust_constant = 6e-6, "
    "max_speed = 1100, torque_per_thrust = 0.06, lag_up = 0, lag_down = 0}"
)


def fleet(*positions: str) -> str:
    return f"vehicle.quadrotors = [{', '.join(QUADROTOR % p for p in positions)}]"


ROTORS = fleet("0, 1, 0").replace("arm = 0.25", "rotor_positions = [%s]")
FAULT = "faults = [{quadrotor = 1, rotor = 1, time = 1, %s}]"
GUST = "wind.gusts = [{start = 1, %s}]"


class Case(NamedTuple):
    """Lines of TOML on top of a built-in mission, and pieces of the one error message."""

    name: str
    toml: str
    pieces: tuple[str, ...]
    base: str = "paper"


def case(name: str, toml: str, *pieces: str) -> Case:
    return Case(name, toml, pieces)


def of_parts(name: str, toml: str, *pieces: str) -> Case:
    """A case on top of mission iris, with real rotors, sensors and a floor."""
    return Case(name, toml, pieces, "iris")


WRONG_TYPES = [
    case("text for a number", "mission.duration = '5'", "mission.duration", '"5"', "a number > 0", "without quotes"),
    case("a quantity", "admittance.damping = '2 N·s/m'", '"2 N·s/m"', "in N s/m: write the number alone, 2"),
    case("a quantity in another unit", "mission.duration = '2 min'", '"2 min"', "in s: write the number alone"),
    case("bool for a number", "mission.duration = true", "mission.duration = true", "a number > 0"),
    case(
        "number for a bool", "admittance.hold_after_release = 1", "admittance.hold_after_release = 1", "true or false"
    ),
    case("number for a name", "mission.name = 7", "mission.name = 7", "text in quotes"),
    case("list for a choice", "admittance.gate = ['soft']", 'admittance.gate = ["soft"]', '"hard" or "soft"'),
    case("float for a whole number", "mission.seed = 1.0", "mission.seed = 1.0", "a whole number ≥ 0"),
    case("table for a number", "mission.step = {a = 1}", "mission.step = {a = 1}", "> 0 and ≤ 0.02"),
    case("table for a list", "vehicle.payload.inertia = {x = 1}", "{x = 1}", "a list of 3 numbers, each > 0"),
    case("list for a table", "mission = [1, 2]", "mission = [1, 2]", "a table with name, duration"),
    case("table for a list of tables", "pushes = {force = 1}", "pushes", "a list of tables", "double brackets"),
    case("numbers for tables", "pushes = [1, 2]", "pushes.0 = 1", "a table with force"),
    case("text among numbers", "admittance.mass = [1, 'x', 1]", 'admittance.mass = [1, "x", 1]', "a list of 3 numbers"),
    case("nested list", "initial.position = [[1, 2, 3]]", "initial.position = [[1, 2, 3]]", "a list of 3 numbers"),
    case("date", "mission.duration = 2024-01-01", "mission.duration = 2024-01-01", "a number > 0"),
    case("time of day", "mission.name = 10:00:00", "mission.name = 10:00:00", "text in quotes"),
]

WRONG_NUMBERS = [
    case("nan", "mission.duration = nan", "mission.duration = nan", "a number > 0"),
    case("infinity among numbers", "initial.velocity = [0, -inf, 0]", "initial.velocity.1 = -inf", "a number"),
    case("a whole number too large", f"phases.height = 1{'0' * 400}", "phases.height = 1000", "a number"),
    case("a weight too large", f"allocation.weights = 1{'0' * 400}", "allocation.weights = 1000", "one number > 0"),
    case("an enormous length", "vehicle.payload.length = 1e200", "vehicle", "too large or too far apart"),
    case("a vanishing mass", "vehicle.payload.mass = 1e-320", "vehicle.payload.mass = 1e-320", "at least 1e-300"),
    case("negative mass", "vehicle.payload.mass = -0.5", "vehicle.payload.mass = -0.5", "a number > 0"),
    case("negative virtual mass", "admittance.mass = [1, 1, -1]", "admittance.mass.2 = -1", "a number > 0"),
    case("long step", "mission.step = 0.0201", "mission.step = 0.0201", "> 0 and ≤ 0.02"),
    case("negative threshold", "admittance.threshold = -0.3", "admittance.threshold = -0.3", "each ≥ 0"),
    case("negative seed", "mission.seed = -1", "mission.seed = -1", "a whole number ≥ 0"),
    case("push of no width", "pushes = [{force = [1, 0, 0], time = 1, sigma = 0}]", "pushes.0.sigma = 0", "> 0"),
    case("exponent below one", "controller.gains.a = 0.5", "controller.gains.a = 0.5", "each ≥ 1"),
    case("no boundary layer", "controller.boundary_layer = 0", "controller.boundary_layer = 0", "6 numbers, each > 0"),
    case("steep roll", "initial.euler = [1.49, 0, 0]", "initial.euler = [1.49, 0, 0]", "1.49 rad is 85.4°"),
    case("degrees", "initial.euler = [0, -10, 0]", "a pitch", "-10 rad is -573°. Did you mean -0.1745 (-10°)?"),
    case("roll of 85 degrees", "initial.euler = [-1.48353, 0, 0]", "initial.euler = [-1.48353, 0, 0]", "(±85°)"),
    case("negative scale", "plant.inertia_scale = [1, -1, 1]", "plant.inertia_scale.1 = -1", "≥ 1e-06 and ≤ 1e+06"),
]

WRONG_SHAPES = [
    case("two numbers", "admittance.mass = [1, 1]", "admittance.mass = [1, 1]", "one number or a list of 3 numbers"),
    case("three gains", "controller.gains.xi = [1, 2, 3]", "controller.gains.xi = [1, 2, 3]", "a list of 6 numbers"),
    case("one number for a force", "pushes = [{force = 1, time = 1, sigma = 1}]", "pushes.0.force = 1", "a list of 3"),
    case("three weights", "allocation.weights = [1, 2, 3]", "allocation.weights = [1, 2, 3]", "four numbers > 0"),
    case("no weight", "allocation.weights = 0", "allocation.weights = 0", "one number > 0"),
    case("three rows of weights", f"allocation.weights = {[[1] * 4] * 3}", "allocation.weights", "2 quadrotors"),
    case("no quadrotor", "vehicle.quadrotors = []", "vehicle.quadrotors", "1 to 64", "here are 0"),
    case("too many quadrotors", fleet(*(f"{i}, 0, 0" for i in range(65))), "vehicle.quadrotors", "1 to 64", "65"),
    case("coinciding quadrotors", fleet("0, 1, 0", "0, 1, 0"), "vehicle.quadrotors", "0 and 1", "[0.0, 1.0, 0.0]"),
    case("impossible inertia", "vehicle.payload.inertia = [1, 1, 2.5]", "vehicle.payload.inertia", "none greater"),
    case("moments far apart", fleet("1e9, 0, 0"), "vehicle", "positions are too large or too far apart"),
]

UNKNOWN_KEYS = [
    case("unknown table", "admitance.mass = 1", "admitance", "unknown key", "Did you mean admittance?"),
    case(
        "unknown key", "mission.duratoin = 5", "mission.duratoin = 5", "log_interval", "Did you mean mission.duration?"
    ),
    case("key of another table", "duration = 5", "duration = 5", "unknown key", "Did you mean mission.duration?"),
    case("gain in the wrong table", "controller.xi = 5", "controller.xi = 5", "Did you mean controller.gains.xi?"),
    case("empty key", "'' = 1", '"" = 1', "unknown key"),
    case("key of odd characters", r'"a\nb\u001b[31m" = 1', r"a\nb\u001b[31m", "unknown key"),
    case("unknown key without a near one", "rain.rate = 5", "rain = {rate = 5}", "has the tables mission, vehicle"),
    case("unknown key of a gust", "wind.gusts = [{velocty = [1, 0, 0]}]", "Did you mean wind.gusts.0.velocity?"),
]

WRONG_NAMES = [
    case("controller", "controller.name = 'nftmsc'", 'controller.name = "nftmsc"', "Did you mean 'nftsmc'?"),
    case("gate", "admittance.gate = 'sotf'", 'admittance.gate = "sotf"', 'Did you mean "soft"?'),
    case("layout", fleet("0, 1, 0").replace("'x'", "'H'"), 'vehicle.quadrotors.0.layout = "H"', '"+" or "x"'),
    case("name with a slash", "mission.name = 'a/b'", 'mission.name = "a/b"', "letters, digits"),
    case("name of dots", "mission.name = '..'", '".."', "letters, digits"),
    case("empty name", "mission.name = ''", 'mission.name = ""', "1 to 64 letters"),
    case("name with a line end", r'mission.name = "a\n"', r'"a\n"', "1 to 64 letters"),
    case("very long name", f"mission.name = '{'n' * 5000}'", 'mission.name = "nnn', "1 to 64 letters"),
]

WRONG_TOGETHER = [
    case("step beyond the end", "mission.duration = 0.01\nmission.step = 0.02", "mission.step = 0.02", "0.01"),
    case("too many steps", "mission.duration = 1e9", "mission.duration = 1000000000.0", "1e+12 steps", "1e+09"),
    case("too much to log", "mission.duration = 1e5\nmission.log_interval = 0.001", "mission.log_interval", "4 GB"),
    case("landing before the lift", "phases.land_start = 1", "phases.land_start = 1.0", "phases.lift_start = 2.0"),
    case(
        "too little damping",
        "admittance.stiffness = 4000",
        "admittance.damping = 1.6 along x",
        "= 2 ",
        "stiffness 4000",
    ),
    case("too much damping", "admittance.damping = [1, 1, 2100]", "admittance.damping = 2100.0 along z", "2000"),
]

WRONG_PARTS = [
    case("one number for a joint", fleet("0, 1, 0").replace("arm", "joint = 1, arm"), "joint = 1", "a list of 3"),
    case("three rotors", fleet("0, 1, 0").replace("arm = 0.25", "rotor_positions = [[1, 0], [0, 1], [1, 1]]"), "of 4"),
    case("rotor in space", ROTORS % "[1, 0, 0], [0, 1], [1, 1], [0, 0]", "rotor_positions.0 = [1, 0, 0]", "list of 2"),
    case("spins alike", fleet("0, 1, 0").replace("arm", "spins = [1, 1, 1, 1], arm"), "[1, 1, 1, 1]", "every thrust"),
    case("rotors in a line", ROTORS % "[1, 0], [2, 0], [3, 0], [4, 0]", "[4.0, 0.0]", "cannot produce every thrust"),
    case("no arm", fleet("0, 1, 0").replace("arm = 0.25, ", ""), "have either arm (and layout), or rotor_positions"),
    case("no feet", fleet("0, 1, 0").replace("arm", "feet_depth = 0, arm"), "feet_depth = 0", "> 0 and ≤ 1000"),
    case("a rotor that is none", "faults = [{quadrotor = 1, rotor = 5, time = 1}]", "faults.0.rotor = 5", "≤ 4"),
    case("fault without a time", "faults = [{quadrotor = 1, rotor = 1}]", "faults.0.time is missing"),
    case("sensors of another kind", "sensors.model = 'real'", 'sensors.model = "real"', '"none" or "simulated"'),
    case(
        "resolution below rounding",
        "sensors.joints.force_resolution = 1e-10",
        "1e-10",
        "0 (for none) or at least 1e-09",
    ),
    case("reading by hope", "pilot.state = 'hope'", '"hope"', '"truth", "measurement" or "estimate"'),
    case("gust without a rise", GUST % "velocity = [1, 0, 0]", "wind.gusts.0.rise is missing"),
    case("wall without an end", "walls = [{start = [0, 0]}]", "walls.0.end is missing"),
    case("gusts for faults", "faults = [{velocity = [1, 0, 0]}]", "faults.0.velocity", "unknown key"),
]

WRONG_PARTS_TOGETHER = [
    case(
        "fault of ideal rotors",
        FAULT % "efficiency = 0",
        'actuators.model = "ideal"',
        '"rotors" where there are faults',
    ),
    of_parts(
        "fault of a third quadrotor",
        "faults = [{quadrotor = 3, rotor = 1, time = 1}]",
        "faults.0.quadrotor = 3",
        "1 to 2",
    ),
    of_parts(
        "fault twice",
        "faults = [{quadrotor = 2, rotor = 3, time = 1}, {quadrotor = 2, rotor = 3, time = 2}]",
        "faults.1.rotor = 3",
        "must fail once, and does so in faults.0",
    ),
    of_parts("more than rotors lift", "vehicle.payload.mass = 3.1", "59.84 N", "56.53 N", "must be lighter"),
    case("estimate without sensors", "pilot.state = 'estimate'", 'pilot.state = "estimate"', 'must be "truth"'),
    case("mass without a tare", "estimator.identify_mass = true", "identify_mass = true", "set estimator.tare_start"),
    of_parts("tare of no sample", "estimator.tare_duration = 0.0001", "tare_duration = 0.0001", "every 0.001 s"),
    of_parts(
        "tare shorter than slow samples", "sensors.interval = 4.0", "estimator.tare_duration = 3.0", "come every 4 s"
    ),
    of_parts(
        "detection that nobody acts on",
        "detection.model = 'residual'\nobserver.model = 'none'\nallocation.method = 'pseudo-inverse'",
        'detection.model = "residual"',
        'must be "none" unless allocation.method is "constrained"',
    ),
    of_parts(
        "wind told from quadrotors that it does not move",
        fleet("0, 1, 0", "0, -1, 0").replace("lag_down = 0", "lag_down = 0, drag_area = [1, 0, 1]")
        + "\nestimator.wind_compensation = 'quadrotors'",
        'estimator.wind_compensation = "quadrotors"',
        "no quadrotor has drag along body y",
    ),
    of_parts("delay of too many steps", "mission.step = 1e-7", "actuators.delay = 0.01", "10000 steps of", "1e-07"),
    case("walls without a floor", "walls = [{start = [0, 0], end = [1, 0]}]", 'ground.model = "none"', "walls"),
    of_parts("wall of no length", "walls = [{start = [9, 1], end = [9, 1]}]", "walls.0.end = [9.0, 1.0]", "0.001 m"),
    case(
        "ground effect without ground", "ground.effect = true", "ground.effect = true", 'ground.model must be "floor"'
    ),
    case(
        "rotors stopped in the air", "phases.rotors = 'flight'", 'phases.rotors = "flight"', '"always" without a floor'
    ),
    of_parts("floor above the feet", "ground.height = 0.2", "ground.height = 0.2", "0.339 m deep", "must be lower"),
    case("tilted on the floor", "ground.model = 'floor'", "initial.euler = [0.15, -0.15, 0.2]", "must be level"),
]

CASES = WRONG_TYPES + WRONG_NUMBERS + WRONG_SHAPES + UNKNOWN_KEYS + WRONG_NAMES + WRONG_TOGETHER
CASES += WRONG_PARTS + WRONG_PARTS_TOGETHER
