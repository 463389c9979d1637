"""`tandemlift compare --engines`: the same flight in several engines, and how far apart."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.studies.comparison import in_engines
from tandemlift.analysis.studies.comparison_scores import differences, largest_differences
from tandemlift.core.errors import InputError
from tandemlift.missions import tables_of

pytest.importorskip("mujoco")
SHORT = {"mission.duration": 2.0}


def made(seed, count=50, **channels):
    """A flight of chance, with some channels as given."""
    rng = np.random.default_rng(seed)
    attitude = Rotation.random(count, rng=rng).as_quat(scalar_first=True)
    own = {"position": rng.normal(size=(count, 3)), "attitude": attitude, "joint_force": rng.normal(size=(count, 2, 3))}
    return tl.Flight(0.01 * np.arange(count), own | channels, tables_of(tl.load_mission("paper")), {})


def test_attitudes_are_apart_by_the_angle_of_the_rotation_between_them():
    a, b = made(1), made(2)
    between = Rotation.from_quat(a["attitude"], scalar_first=True).inv() * Rotation.from_quat(
        b["attitude"], scalar_first=True
    )
    assert differences(a, b)["attitude"] == pytest.approx(between.magnitude())
    other = made(1, attitude=-a["attitude"])  # the same attitudes
    assert largest_differences(a, other)["attitude"] == 0.0


def test_a_known_difference_is_found_and_joints_are_looked_at_once_settled():
    a = made(3)
    moved, force = a["position"].copy(), a["joint_force"].copy()
    moved[20] += [0.3, 0.4, 0.0]
    force[5, 1, 2] += 7.0  # at 0.05 s
    force[30, 0, 1] -= 0.25
    found = largest_differences(made(3, position=moved, joint_force=force), a)
    assert found["position"] == pytest.approx(0.5)
    assert found["joint_force"] == pytest.approx(0.25)
    assert "push_estimate" not in found


def test_a_flight_that_ended_early_is_compared_as_far_as_it_came():
    a, b = made(4), made(4)
    short = tl.Flight(b.time[:20], {n: v[:20] for n, v in b.channels.items()}, b.mission, {})
    assert largest_differences(short, a) == {"position": 0.0, "attitude": 0.0, "joint_force": 0.0}


def test_a_mission_is_flown_in_each_engine_and_the_numbers_say_so(run, tmp_path):
    code, printed, _ = run(
        "compare", "paper", "--engines", "compiled,mujoco", "--set", "mission.duration=2.0", "--out", "o"
    )
    assert code == 0
    assert sorted(p.name for p in (tmp_path / "o").iterdir()) == [*("engines.csv", "engines.json", "engines.tex")]
    found = json.loads((tmp_path / "o/engines.json").read_text("utf-8"))
    assert [row["engine"] for row in found["engines"]] == ["compiled", "mujoco"]
    a, b = (tl.fly(tl.load_mission("paper", SHORT), engine) for engine in ("compiled", "mujoco"))
    most = np.linalg.norm(a["position"] - b["position"], axis=1).max()
    assert 0.0 < most < 1e-6  # m
    assert found["engines"][1]["difference"]["position"] == pytest.approx(most)
    assert set(found["engines"][0]["difference"].values()) == {0.0}
    assert f"{most:.1e}" in printed


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        (["--engines", "compiled,mujco"], ["unknown engine 'mujco'", "'mujoco'"]),
        (["--engines", "mujoco"], ["must be two or more"]),
        (["--engines", ","], ["--engines: must be a comma-separated list of names"]),
        (["--engines", "compiled,mujoco", "--controllers", "pid"], ["give only one of them"]),
    ],
    ids=["an unknown one", "one alone", "none", "controllers too"],
)
def test_bad_input_is_refused_and_nothing_is_written(arguments, pieces, run, tmp_path):
    code, _, said = run("compare", "paper", *arguments)
    assert code == 2
    assert [piece for piece in pieces if piece not in said] == []
    assert list(tmp_path.iterdir()) == []


def test_an_engine_may_not_be_named_twice():
    with pytest.raises(InputError, match="without repetition"):
        in_engines(tl.load_mission("paper", SHORT), ["compiled", "compiled"])
