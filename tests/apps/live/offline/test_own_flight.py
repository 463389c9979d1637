"""The page's own flights: links, damaged flights, saved files, and the files that the page consists of."""

import gzip
import json
import zipfile

import numpy as np
import pytest
from click.testing import CliRunner
from html_page import Page
from own_flight import INDEX, OwnFlight, check_flies_again
from repository import ROOT

import tandemlift as tl
from tandemlift.analysis.studies.corridor_score import score_of
from tandemlift.apps.cli.main import cli
from tandemlift.apps.live import page_modules, pages
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.page_manifest import page_manifest
from tandemlift.apps.live.page_modules import page_mission
from tandemlift.apps.live.session.challenge import write_score
from tandemlift.core.files import DATA
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.traced_assembly import trace_assembly


def opened(flight, settings=None):
    """What the worker says of a flight as it opens it."""
    one = OwnFlight(flight, settings)
    one.close()
    return one.said


def failure_of(flight):
    return [said["preparing"]["failure"] for said in opened(flight) if said["phase"] == "failed"]


# damaged flights


@pytest.mark.parametrize("cut", [10, 1000, -1])
def test_a_flight_that_was_cut_short_is_refused(hover, cut):
    assert failure_of(hover._replace(data=hover.data[:cut]))[0].startswith("broken")
    whole = gzip.decompress(hover.data)
    assert failure_of(hover._replace(data=gzip.compress(whole[:cut]))) == ["broken"]


def test_a_flight_with_one_bit_changed_is_refused_wherever_it_is(hover):
    whole = gzip.decompress(hover.data)
    for at in np.random.default_rng(1).integers(len(whole), size=2):
        edited = bytearray(whole)
        edited[at] ^= 1 << int(at) % 8
        assert failure_of(hover._replace(data=gzip.compress(bytes(edited)))) == ["broken"]


def test_a_flight_of_another_version_is_refused(hover, monkeypatch):
    monkeypatch.setitem(INDEX, "version", "0.0.1")
    assert failure_of(hover) == ["other"]


# links


def test_a_link_begins_the_flight_with_its_settings(hover, tmp_path):
    flight = OwnFlight(hover, [["admittance.mass", [2.5, 2, 3]], ["person.stiffness", 9]])
    assert [one["type"] for one in flight.said if one["type"] == "refused"] == []
    values = {one["key"]: one["value"] for one in flight.scene["parameters"]}
    assert (values["admittance.mass"], values["person.stiffness"]) == ([2.5, 2, 3], 9)
    assert flight.scene["spring"]["stiffness"] == 9
    flight.fly(0.5)
    flight.saved(tmp_path)
    flight.close()
    again = tl.load_mission(tmp_path / "recorded.toml")
    assert again.admittance.mass == (2.5, 2.0, 3.0)
    assert not again.changes


def test_settings_of_a_link_that_are_out_of_bounds_are_each_named_and_the_rest_is_taken(hover):
    given = [["admittance.mass", 300], ["admittance.damping", 4], ["mission.step", 1], ["person.stiffness", "a"]]
    said = opened(hover, given)
    refused = [one["reason"] for one in said if one["type"] == "refused"]
    assert refused[0] == "admittance.mass = 300: must be from 0.3 to 20"
    assert refused[1].startswith("mission.step: is not a parameter that can be changed in flight")
    assert refused[2] == 'person.stiffness = "a": must be a number, or a list of numbers'
    (scene,) = [one for one in said if one["type"] == "scene"]
    values = {one["key"]: one["value"] for one in scene["parameters"]}
    assert (values["admittance.damping"], values["admittance.mass"]) == ([4, 4, 4], [1, 1, 1])


def test_one_number_of_a_link_stands_for_all_axes_of_a_gain_but_for_no_direction_in_space(hover):
    said = opened(hover, [["wind.velocity", 3], ["admittance.damping", 4], ["admittance.mass", 2]])
    (refused,) = [one["reason"] for one in said if one["type"] == "refused"]
    rule = "must be 0 or a list of 3 numbers, each ≥ -1000 and ≤ 1000, such as [3, 0, 0]"
    assert refused == f"mission: wind.velocity = 3: {rule}"
    with pytest.raises(tl.InputError) as python:
        tl.load_mission("hover", {"wind.velocity": 3})
    assert str(python.value) == f"hover: wind.velocity = 3: {rule}"
    (scene,) = [one for one in said if one["type"] == "scene"]
    values = {one["key"]: one["value"] for one in scene["parameters"]}
    assert (values["wind.velocity"], values["admittance.damping"]) == ([0, 0, 0], [4, 4, 4])
    said = opened(hover, [["wind.velocity", [1, -2, 0.5]], ["wind.velocity", 0]])
    assert [one["reason"] for one in said if one["type"] == "refused"] == []


# saved files


@pytest.mark.thorough
def test_a_saved_flight_flies_again_to_the_last_bit(flight, tmp_path):
    flight.say("grab", point=[0.1, 0.4, 0.0], target=[0.4, 0.2, 1.3], at="point")
    flight.fly(1.0)
    flight.say("set", key="admittance.damping", value=3.3)
    flight.fly(0.3)
    flight.say("set", key="admittance.damping", value=[1, 2, 3])
    flight.say("set", key="wind.velocity", value=[1e-7, -0.0, 0.1])
    flight.fly(1.7)
    last = flight.saved(tmp_path, "mine")
    mission = tl.load_mission(tmp_path / "recorded.toml")
    assert (mission.mission.name, mission.mission.fma) == ("mine", False)
    changed = [(c.key, c.duration) for c in mission.changes]
    assert changed == [("admittance.damping", 0.5)] * 2 + [("wind.velocity", 0.5)]
    check_flies_again(tmp_path / "recorded.toml", last)
    assert np.abs(tl.fly(mission)["position"][-1] - [0.0, 0.0, 1.0]).max() > 0.01  # it was pulled


def test_a_saved_file_is_flown_as_it_is(flight, tmp_path):
    flight.fly(0.4)
    flight.saved(tmp_path, "mine")
    with zipfile.ZipFile(tmp_path / "mine.zip", "w") as archive:
        for name in ("recorded.toml", "hand.npz", "last_sample.npy"):
            archive.write(tmp_path / name, name)
    packed, unpacked = (
        tl.fly(tl.load_mission(tmp_path / "mine.zip")),
        tl.fly(tl.load_mission(tmp_path / "recorded.toml")),
    )
    np.testing.assert_array_equal(packed["position"], unpacked["position"])


def test_a_zip_file_that_is_no_saved_flight_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "other.zip", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    (tmp_path / "damaged.zip").write_bytes(b"PK\3\4 and no more")
    for name in ("other.zip", "damaged.zip"):
        with pytest.raises(tl.InputError, match=f"{name} is not a flight that a page saved"):
            tl.load_mission(tmp_path / name)


def test_a_flight_that_diverged_is_saved_and_diverges_again_at_the_same_step(tmp_path, hover):
    flight = OwnFlight(hover)
    flight.fly(0.5)
    for key in ("controller.gains.xi", "controller.gains.lambda_1", "controller.gains.lambda_2"):
        flight.say("set", key=key, value=0.05)
    flight.say("set", key="person.max_force", value=20)
    flight.say("force", force=[20, 0, 20], point=[0, 1, 0])
    for _ in range(60):
        flight.fly(1.0)
        if flight.status()["phase"] == "crashed":
            break
    assert flight.status()["phase"] == "crashed"
    flight.saved(tmp_path)
    flight.close()
    mission = tl.load_mission(tmp_path / "recorded.toml")
    again = tl.fly(mission)
    assert again.ending is not None
    assert again.ending.time == pytest.approx(mission.mission.duration, abs=2e-3)


# the page's files


HOVER_FILE = str(DATA / "missions" / "hover.toml")
LISTINGS = ROOT / "docs" / "reference" / "listings"


def test_a_page_in_one_file_holds_worker_and_flights_and_may_load_nothing(hover):
    page = Page(pages.offline_html([hover], page_files()))
    texts = {found["id"]: text for found, text in page.of("script") if "id" in found}
    index = json.loads(texts["flights"])
    assert [(m["name"], m["sha256"]) for m in index["missions"]] == [("hover", hover.sha256)]
    assert index["only_server"]
    assert "connect-src" not in page.policy
    assert page.policy.startswith("default-src 'none'")
    assert texts["worker"].strip() == page_files()["/worker.js"].decode().strip()
    assert json.loads(texts["flight"])["scene"]["mission"] == pages.SHOWN_INSTEAD


def test_flights_are_shipped_as_files_and_taken_from_there(hover, tmp_path, monkeypatch):
    (written,) = page_modules.build_modules(tmp_path, ["hover"])
    monkeypatch.setattr(page_modules, "SHIPPED", tmp_path)
    monkeypatch.setattr(page_modules, "page_mission", None)  # nothing is built
    assert page_modules.packed_flight("hover") == hover
    assert written.read_bytes() == hover.data


def test_the_verb_writes_both_forms(hover, tmp_path):
    where = ["--html", str(tmp_path / "one.html"), "--out", str(tmp_path / "site")]
    for _ in range(2):  # over its own files, too
        done = CliRunner().invoke(cli, ["page", "hover", *where], standalone_mode=False)
        assert done.exception is None
    assert (tmp_path / "one.html").stat().st_size < 3e6
    site = tmp_path / "site"
    assert {"index.html", "page.js", "page.css", "worker.js"} <= {file.name for file in site.iterdir()}
    assert (site / "flights" / "hover.flight").read_bytes() == hover.data


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ([], "give the place of the page: --html FILE for one file, --out DIR for a web server"),
        (["--html", "page.txt"], "--html page.txt: must end in .html"),
        (["hoover", "--html", "a.html"], "unknown mission 'hoover'"),
        (["hover", HOVER_FILE, "--html", "a.html"], "mission.name = 'hover': two missions of the page have it"),
        (
            ["hover", "--controller", str(LISTINGS / "my_pd_plain.py"), "--html", "a.html"],
            "my_pd() in my_pd_plain.py, line 39, is plain Python, of which no other machine has code; register it as a "
            "law, without compiled=False. A page flies compiled code only; `tandemlift live hover --controller",
        ),
    ],
)
def test_what_the_verb_cannot_do_is_refused(arguments, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli, ["page", *arguments], standalone_mode=False)
    assert isinstance(done.exception, tl.InputError)
    assert text in str(done.exception)
    assert not list(tmp_path.iterdir())


def test_the_verb_leaves_the_index_of_another_site(tmp_path):
    own = tmp_path / "index.html"
    own.write_text("<title>my site</title>", "utf-8")
    done = CliRunner().invoke(cli, ["page", "hover", "--out", str(tmp_path)], standalone_mode=False)
    assert str(done.exception).startswith(f"{own}: tandemlift did not write it, so it stays: give another")
    assert (own.read_text("utf-8"), list(tmp_path.iterdir())) == ("<title>my site</title>", [own])


def test_a_controller_that_branches_on_data_is_refused_with_the_line_and_what_flies_it(tmp_path):
    law = (LISTINGS / "my_pd.py").read_text("utf-8")
    branching = law.replace("    e, de = ", "    if state.position.x > 0.0:\n        pass\n    e, de = ")
    file = tmp_path / "branching.py"
    file.write_text(branching, "utf-8")
    line = 1 + branching.splitlines().index("    if state.position.x > 0.0:")
    with pytest.raises(tl.InputError) as refused:
        page_modules.packed_flight("hover", str(file))
    assert f"branching.py, line {line}: my_pd() branches on data" in str(refused.value)
    assert f"`tandemlift live hover --controller {file}` also flies" in str(refused.value)


def test_what_was_made_is_kept_until_the_mission_changes_and_not_with_an_own_controller(tmp_path, monkeypatch):
    mission = tmp_path / "mine.toml"
    mission.write_text('extends = "hover"\n[mission]\nname = "mine"\n', "utf-8")
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(page_modules, "flight_manifest", lambda mission: ({"of": mission.mission.name}, b"code"))
    given, own = (str(mission),), (str(mission), str(LISTINGS / "my_pd.py"))
    assert page_modules.PageFlight(*given).ready is None
    made = page_modules.packed_flight(*given)
    assert page_modules.PageFlight(*given).ready == made
    mission.write_text(mission.read_text("utf-8") + "[vehicle.payload]\nmass = 0.6\n", "utf-8")
    assert page_modules.PageFlight(*given).ready is None
    page_modules.packed_flight(*own)
    assert page_modules.PageFlight(*own).ready is None


@pytest.mark.thorough
def test_several_missions_are_made_by_processes_as_each_alone(hover, tmp_path, monkeypatch):
    mine = tmp_path / "mine.toml"
    mine.write_text('extends = "hover"\n[mission]\nname = "mine"\n', "utf-8")
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    counts = []
    flights = page_modules.packed_flights(["hover", str(mine)], progress=lambda *count: counts.append(count))
    assert counts == [(0, 2), (1, 2), (2, 2)]
    assert [flight.name for flight in flights] == ["hover", "mine"]
    assert flights[0] == hover


# the modules


@pytest.mark.targets
@pytest.mark.parametrize("name", page_modules.MISSIONS)
def test_every_setting_and_every_rotor_of_a_page_is_a_number_that_its_module_takes(name):
    mission = page_mission(name)
    taken, manifest = trace_assembly(mission).keys, page_manifest(FlightPlan(mission))
    keys = [key for one in manifest["parameters"] for key in one["keys"]] + [one["key"] for one in manifest["rotors"]]
    assert keys
    for key in keys:
        assert any(one == key or one.startswith(f"{key}.") for one in taken), key


# the challenge


@pytest.mark.thorough
def test_a_flight_through_a_corridor_has_the_score_of_its_saved_file(corridor, tmp_path):
    flight = OwnFlight(corridor)
    flight.fly(6.0)
    assert "score" not in flight.status()
    flight.saved(tmp_path / "early")
    assert not (tmp_path / "early" / "score.json").exists()
    for force, seconds in (([1.0, 1.4, 0.0], 3.0), ([-0.5, -1.0, 0.0], 1.5), ([2.0, 0.0, 0.0], 4.0)):
        flight.say("force", force=force, point=[0.0, 0.0, 0.0])
        flight.fly(seconds)
    shown = flight.status()["score"]
    flight.saved(tmp_path)
    flight.close()
    score = score_of(tl.fly(tl.load_mission(tmp_path / "recorded.toml")))
    assert shown["finished"]
    assert shown["refused"] == ""
    assert shown["touches"] == score.touches > 0
    got = [shown["time"], shown["effort"], shown["jerk"], shown["score"]]
    np.testing.assert_allclose(got, [score.time, score.effort, score.jerk, score.total], rtol=1e-9)
    write_score(tl.fly(tl.load_mission(tmp_path / "recorded.toml")), tmp_path / "again")
    handed_in, again = (json.loads((tmp_path / at / "score.json").read_text()) for at in (".", "again"))
    assert handed_in == pytest.approx(again, rel=1e-9)  # the same keys, too
