"""A bag becomes the flight again that it was made of, and a report; what is lost or foreign is told."""

import dataclasses

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.export.reading import read_bag
from tandemlift.apps.export.write import export
from tandemlift.core.errors import InputError

rosbag1 = pytest.importorskip("rosbags.rosbag1")
ROUNDING = 1e-12
ENDINGS = {"paper": "bag", "iris": "mcap"}
FLOWN = {"paper": {"mission.duration": 12.0}, "iris": {"mission.duration": 12.0}}


@pytest.fixture(scope="module", params=FLOWN)
def flight(request):
    return tl.fly(tl.load_mission(request.param, FLOWN[request.param]))


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper", {"mission.duration": 2.0}))


@pytest.mark.thorough
def test_a_bag_holds_the_whole_flight(flight, tmp_path):
    found = read_bag(export(flight, tmp_path / f"flight.{ENDINGS[flight.name]}"))
    assert list(found) == list(flight)
    assert found.time == pytest.approx(flight.time, abs=1e-9)
    assert found.mission == flight.mission
    for name in flight:
        assert found[name].shape == flight[name].shape, name
        np.testing.assert_allclose(found[name], flight[name], rtol=ROUNDING, atol=ROUNDING, err_msg=name)
    exact = ("position", "attitude", "rates", "push_force", "rotor_thrusts", "joint_force", "thrust")
    assert all(np.array_equal(found[name], flight[name]) for name in exact)


@pytest.mark.thorough
def test_metrics_of_a_bag_are_those_of_its_samples(flight, tmp_path):
    metrics = read_bag(export(flight, tmp_path / "flight.bag")).metrics()
    error = flight["reference_position"] - flight["position"]
    late = error[flight.time >= 10.0]
    assert metrics["position_rmse_m"] == pytest.approx(np.sqrt((error**2).mean(axis=0)))
    assert metrics["position_max_error_after_10s_m"] == pytest.approx(np.abs(late).max(axis=0))
    assert metrics["final_position_m"] == pytest.approx(flight["position"][-1])
    assert metrics["samples"] == len(flight.time)
    own = flight.metrics()["position_rmse_after_10s_m"]
    assert metrics["position_rmse_after_10s_m"] == pytest.approx(own, rel=0.05)  # of every step


def rewritten(source, target, keep):
    """A bag with some messages of another, as `rosbags` copies them."""
    from rosbags.rosbag1 import Reader, Writer

    with Reader(source) as reader, Writer(target) as writer:
        made = {}
        for number, (connection, at, data) in enumerate(reader.messages()):
            if keep(connection.topic, number):
                if connection.id not in made:
                    made[connection.id] = writer.add_connection(
                        connection.topic,
                        connection.msgtype,
                        msgdef=connection.msgdef.data,
                        md5sum=connection.digest,
                    )
                writer.write(made[connection.id], at, data)
    return target


def test_where_a_message_was_lost_the_one_before_it_stands(paper, tmp_path):
    whole = export(paper, tmp_path / "whole.bag")
    lossy = rewritten(whole, tmp_path / "lossy.bag", lambda t, k: t != "/tandemlift/rotors/thrusts" or k % 3)
    found = read_bag(lossy)
    assert np.array_equal(found["position"], paper["position"])
    kept = np.array([any(np.array_equal(row, own) for own in paper["rotor_thrusts"]) for row in found["rotor_thrusts"]])
    assert kept[1:].all()
    same = (found["rotor_thrusts"] == paper["rotor_thrusts"]).all(axis=1)
    assert 0.4 < same.mean() < 1.0


@pytest.mark.parametrize(
    ("missing", "pieces"),
    [
        ("/tandemlift/odometry", ["has no /tandemlift/odometry", "/tandemlift/push/true"]),
        ("/tandemlift/mission", ["has no /tandemlift/mission"]),
        ("/tandemlift/joint_2/wrench", ["joint_force"]),
        ("/tandemlift/push/gated", ["lacks the topics of admittance_force"]),
    ],
)
def test_a_bag_that_lacks_a_topic_is_refused_by_its_name(missing, pieces, paper, tmp_path):
    whole = export(paper, tmp_path / "whole.bag")
    bag = rewritten(whole, tmp_path / "part.bag", lambda topic, _: topic != missing)
    with pytest.raises(InputError) as refused:
        read_bag(bag)
    assert [piece for piece in pieces if piece not in str(refused.value)] == []


def test_a_bag_of_a_mission_with_an_unknown_key_is_refused_by_the_key(paper, tmp_path):
    mission = {**paper.mission, "partner": {"speed": 1.0}}
    bag = export(dataclasses.replace(paper, mission=mission), tmp_path / "flight.bag")
    with pytest.raises(InputError, match=r"flight\.bag: .*: partner: unknown key of a mission"):
        read_bag(bag)


@pytest.mark.parametrize(("ending", "content"), [("bag", b""), ("bag", b"#ROSBAG V2.0\n"), ("mcap", bytes(range(256)))])
def test_a_damaged_bag_is_refused_and_nothing_is_written(ending, content, tmp_path, run):
    (tmp_path / f"bad.{ending}").write_bytes(content)
    code, _, err = run("report", f"bad.{ending}")
    assert code == 2
    assert f"bad.{ending}" in err
    assert [p.name for p in tmp_path.iterdir()] == [f"bad.{ending}"]


@pytest.mark.parametrize("ending", ["bag", "mcap"])
def test_a_report_is_made_of_a_bag(ending, paper, tmp_path, run):
    export(paper, tmp_path / f"some.{ending}")
    assert run("report", f"some.{ending}", "--no-figures")[0] == 0
    folder = tmp_path / "out" / "some"
    names = {p.name for p in folder.iterdir()}
    assert names >= {"flight.npz", "metrics.json", "mission.toml", "report.html"}
    assert "From the samples of a bag" in (folder / "report.html").read_text("utf-8")
    assert np.array_equal(tl.Flight.load(folder / "flight.npz")["position"], paper["position"])


def test_a_report_is_made_again_of_a_saved_flight(paper, tmp_path, run):
    paper.save(tmp_path / "flight.npz")
    assert run("report", "flight.npz", "--no-figures", "--out", "again")[0] == 0
    assert tl.Flight.load(tmp_path / "again/flight.npz") == paper
    assert "From every step" in (tmp_path / "again/report.html").read_text("utf-8")
