"""A study that cannot be flown is refused by key and value, with what is allowed, before anything flies."""

import copy
import datetime

import pytest

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan

UNIFORM = {"distribution": "uniform", "low": 0.9, "high": 1.1}
GOOD = {"study": {"name": "good", "missions": ["one-push"]}}


def nested(key, value):
    """A value in tables, one for each part of its dotted key."""
    for part in reversed(key.split(".")):
        value = {part: value}
    return value


def drawn(key="plant.mass_scale", **changes):
    """A study that draws a key, with changes of its distribution."""
    return {"draw": nested(key, {**UNIFORM, **changes})}


def study(**changes):
    return {"study": changes}


def grid(values, key="plant.mass_scale"):
    return {"grid": nested(key, values)}


def message_of(parts):
    tables = copy.deepcopy(GOOD)
    for name, part in parts.items():
        tables[name] = {**tables[name], **part} if name == "study" else part
    with pytest.raises(tl.InputError) as refused:
        load_plan(tables)
    return str(refused.value)


REFUSED = {  # a study: pieces of its message
    "a path as name": (study(name="../../etc"), ['study.name = "../../etc"', "letters, digits"]),
    "no mission": (study(missions=[]), ["study.missions = []", "at least one"]),
    "an unknown mission": (study(missions=["one-pusch"]), ["one-pusch", "one-push"]),
    "a mission twice": (study(missions=["hover", "hover"]), ["study.missions", "without repetition"]),
    "an unknown controller": (study(controllers=["pdi"]), ["pdi", "pid", "study.controllers", "name its file"]),
    "an unknown engine": (study(engines=["mujoko"]), ["mujoko", "mujoco"]),
    "an unknown key": (study(drawz=3), ["study.drawz = 3", "unknown", "draws"]),
    "too many draws": (study(draws=10**10), ["study.draws = 10000000000", "1000000000"]),
    "an unknown sampling": (study(sampling="sobolev"), ["study.sampling", "sobolev", "sobol", "latin-hypercube"]),
    "sobol without a power of two": (
        {**study(draws=100, sampling="sobol"), **drawn()},
        ["study.draws = 100", "power of two", "64 or 128"],
    ),
    "sobol of nothing": (study(draws=8, sampling="sobol"), ["study.sampling = 'sobol'", "[draw]"]),
    "persons where nobody is": (study(persons="random"), ["study.persons = 'random'", "one-push", "no person"]),
    "seeds of a seed": ({**study(seeds=3), "set": {"mission.seed": 4}}, ["study.seeds = 3", "[set]", "mission.seed"]),
    "a case twice": ({"cases": [{"name": "a"}, {"name": "a"}]}, ["cases", "without repetition"]),
    "an outcome that is none": ({"keep": {"outcomes": ["crash"]}}, ["keep.outcomes", "crashed", "landed"]),
    "an empty list on the grid": (grid([]), ["grid.plant.mass_scale = []", "at least one value"]),
    "a number on the grid": (grid(1.0), ["grid.plant.mass_scale = 1.0", "low", "count"]),
    "a value twice on the grid": (grid([1.0, 1.1, 1.0]), ["grid.plant.mass_scale", "without repetition"]),
    "a range upside down": (
        grid({"low": 2.0, "high": 1.0, "count": 3}),
        ["plant.mass_scale", "low = 2 below high = 1"],
    ),
    "a grid of 1e12": (
        {
            "grid": {
                f"plant.{key}": {"low": 0.9, "high": 1.1, "count": 10**6} for key in ("mass_scale", "inertia_scale")
            }
        },
        [
            "1e+12 rows",
            "1,000,000 values of plant.mass_scale × 1,000,000 values of plant.inertia_scale",
            "at most 1e+09",
        ],
    ),
    "a number that is none": (grid([1.0, float("nan")]), ["grid", "finite numbers", "plant.mass_scale.1 is nan"]),
    "a date": ({"set": {"mission.duration": datetime.date(2026, 1, 1)}}, ["set", "mission.duration is datetime.date"]),
    "no distribution": (
        {"draw": {"plant.mass_scale": 1.0}},
        ["draw.plant.mass_scale = 1.0", "table such as", "normal"],
    ),
    "an unknown distribution": (
        drawn(distribution="unifrom"),
        ['distribution = "unifrom"', "log-uniform", "'uniform'"],
    ),
    "low above high": (drawn(low=2.0), ["draw.plant.mass_scale", "low = 2 below high = 1.1"]),
    "an unknown key of a distribution": (drawn(hihg=2.0), ["draw.plant.mass_scale.hihg = 2.0", "unknown", "high"]),
    "a step that nothing is a multiple of": (drawn(step=10.0), ["draw.plant.mass_scale", "step = 10"]),
    "a normal cut to nothing": (
        {"draw": {"a": {"b": {"distribution": "normal", "mean": 1.0, "deviation": 0.1, "low": 2.0}}}},
        ["draw.a.b", "at least a millionth"],
    ),
    "a logarithm of nothing": (drawn(distribution="log-uniform", low=0.0), ["draw.plant.mass_scale", "low above 0"]),
    "a choice of none": (
        {"draw": {"a": {"b": {"distribution": "choice", "among": []}}}},
        ["draw.a.b", "a value among"],
    ),
    "a factor that is a word": (
        {"draw": {"a": {"b": {"distribution": "choice", "among": ["x"], "relative": True}}}},
        ["draw.a.b", "numbers to choose from"],
    ),
    "relative to what is not set": (
        drawn("pushes.3.time", relative=True),
        ["draw.pushes.3.time", "relative = true", "is not set", "one-push"],
    ),
    "relative to a word": (drawn("controller.switching", relative=True), ["controller.switching", "'saturation'"]),
    "a key set and drawn": (
        {"set": {"plant.mass_scale": 1.0}, **drawn()},
        ["draw.plant.mass_scale", "[set] already", "once"],
    ),
    "a key in a case and drawn": (
        {"cases": [{"name": "a", "set": {"plant": {"mass_scale": 1.1}}}], **drawn(relative=True)},
        ["draw.plant.mass_scale", "[cases: a] already"],
    ),
    "a key twice in a table": (
        {"set": {"plant.mass_scale": 1.0, "plant": {"mass_scale": 1.1}}},
        ["set.plant.mass_scale = 1.1", "twice"],
    ),
    "a list over its entry": (
        {"set": {"pushes.0.time": 2.0}, **grid([[]], "pushes")},
        ["grid.pushes", "would replace pushes.0.time of [set]"],
    ),
    "an unknown key of a mission": (
        {"set": {"plant.mas_scale": 1.0}},
        ["only row", "plant.mas_scale = 1.0", "mass_scale"],
    ),
    "a key of one controller of two": (
        {**study(controllers=["nftsmc", "pid"]), **grid([0.5, 0.7], "controller.boundary_layer")},
        [
            "controller pid: each of the first 2 rows is refused",
            "controller.boundary_layer = 0.5: unknown key",
            "A key of [controller] must be one of every controller of the study.",
        ],
    ),
    "draws that no vehicle can have": (
        {**study(draws=20), **drawn(low=-2.0, high=-1.0)},
        ["each of the first 8 rows is refused", "plant.mass_scale = -"],
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_it_is_refused_with_key_value_and_what_is_allowed(what):
    parts, pieces = REFUSED[what]
    said = message_of(parts)
    assert [piece for piece in pieces if piece not in said] == [], said
    assert said.startswith("study: ")
    assert "Traceback" not in said
    assert max(map(len, said.splitlines())) < 400


def test_a_mission_whose_controller_is_not_loaded_is_refused_with_the_key_that_loads_it(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('extends = "hover"\n[controller]\nname = "nobody-s"\n', "utf-8")
    said = message_of(study(missions=[str(path)]))
    assert "controller.name: unknown controller 'nobody-s'" in said
    assert "name its file in study.controllers" in said
    assert "--controller" not in said


def test_one_impossible_draw_among_others_is_no_refusal_of_the_study():
    plan = load_plan({**GOOD, "study": {**GOOD["study"], "draws": 20}, **drawn(low=-0.2, high=1.2)})
    assert plan.count == 20


@pytest.mark.parametrize(
    ("text", "said"),
    [("[study\n", "not valid TOML"), ("a = " + "[" * 5000, "nested too deeply"), ("", "study"), ("study = 3", "study")],
    ids=["broken", "deep", "empty", "number"],
)
def test_a_file_that_is_no_study_is_refused_by_name(text, said, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(tl.InputError, match=r"mine\.toml") as refused:
        load_plan(path)
    assert said in str(refused.value)


def test_a_file_that_is_not_there_is_refused_with_what_makes_one(tmp_path):
    with pytest.raises(tl.InputError, match="does not exist; `tandemlift study --template`"):
        load_plan(tmp_path / "mine.toml")
    with pytest.raises(tl.InputError, match="is a folder"):
        load_plan(tmp_path)
