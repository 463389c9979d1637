"""Controllers and recordings that a study holds: they are used from what it holds, and no file is made of them."""

import hashlib
import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from listings import LAW, PLAIN
from patience import completed
from small_studies import flown

import tandemlift as tl
from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.store import open_folder
from tandemlift.analysis.studies.study import mission_of_row
from tandemlift.analysis.studies.table import load_study
from tandemlift.core.plugs import PluginText
from tandemlift.missions.recording import WIDTH, Recording, read_recording, write_recording
from tandemlift.parts.controllers import CONTROLLERS, controller, file_of

RUN = "from tandemlift.__main__ import main; main()"


@pytest.fixture
def shared(tmp_path, monkeypatch):
    """The folder of temporary files, in which nothing is yet."""
    folder = tmp_path / "shared"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    monkeypatch.setenv("TMPDIR", str(folder))
    return folder


@pytest.fixture
def own(tmp_path):
    """A study of a controller of one's own, whose name is forgotten before and after, as in a new process."""

    def study(text, name="held"):
        CONTROLLERS.pop("held", None)
        path = tmp_path / f"{name}.py"
        path.write_bytes(text.replace('"my-pd-plain"', '"held"').replace('"my-pd"', '"held"').encode())
        return {"study": {"name": "own", "missions": ["hover"], "controllers": [str(path)]}, "set": AWAY}

    yield study
    CONTROLLERS.pop("held", None)


AWAY = {"mission.duration": 0.2, "initial.position": [0.1, 0.0, 0.0]}


@pytest.mark.parametrize("text", [LAW, PLAIN], ids=["law", "plain"])
def test_a_controller_is_run_from_the_text_of_the_study_without_a_file(own, text, shared, tmp_path):
    study = flown(own(text), tmp_path / "out")
    position = tl.fly(study.mission(0))["position"][-1].tolist()
    (tmp_path / "held.py").unlink()
    CONTROLLERS.pop("held")  # as in a new process
    assert tl.fly(load_study(tmp_path / "out").mission(0))["position"][-1].tolist() == position
    assert not Path(file_of(controller("held"))).exists()
    assert list(shared.iterdir()) == []


def test_a_file_that_somebody_put_where_controllers_once_were_written_is_not_run(own, shared, tmp_path):
    tables = own(PLAIN)
    text = (tmp_path / "held.py").read_bytes()
    planted = shared / f"tandemlift-{hashlib.sha256(text).hexdigest()[:16]}" / "held.py"
    planted.mkdir(parents=True)  # whoever reads or writes there fails
    assert flown(tables, tmp_path / "out").read(["outcome"])["outcome"].to_pylist() == ["flying"]


def test_a_study_does_not_load_a_controller_anew_that_is_loaded(own, tmp_path):
    tables = own(LAW)
    mission = tl.load_mission("hover", AWAY, controller=tl.load_controller(tmp_path / "held.py"))
    load_plan(tables).variants[0].template()
    assert tl.fly(mission).ending is None


def test_a_controller_with_windows_ends_of_lines_flies_in_a_study(own, tmp_path):
    tables = own(PLAIN.replace("\n", "\r\n"))
    assert flown(tables, tmp_path / "out").read(["outcome"])["outcome"].to_pylist() == ["flying"]


def test_the_text_that_ran_is_held_even_if_its_file_has_changed_since(own, tmp_path):
    tables = own(PLAIN)
    load_plan(tables)
    tables["study"]["controllers"] = ["held"]  # by its name
    (tmp_path / "held.py").write_text("raise SystemExit('another text')", "utf-8")
    (variant,) = load_plan(tables).variants
    assert [(one.name, one.text) for one in variant.plugins] == [("held.py", PLAIN.replace('"my-pd-plain"', '"held"'))]


def test_an_error_in_the_controller_of_a_study_names_its_file_and_line(own, tmp_path):
    tables = own(PLAIN)
    folder = open_folder(load_plan(tables), tmp_path / "out")
    variant = (
        folder.plan()
        .variants[0]
        ._replace(plugins=(PluginText("held.py", "0" * 64, "x = 1\nraise ValueError('no')\n"),))
    )
    with pytest.raises(tl.InputError, match=r"^plugin held\.py, line 2: ValueError: no$"):
        variant.template()


def recorded(tmp_path):
    """A study of a recorded hand, and its recording."""
    steps, hands = np.arange(0, 100, 10), np.zeros((10, WIDTH))
    hands[:, 0] = 1.0
    write_recording(tmp_path / "hand.npz", Recording(steps, hands))
    (tmp_path / "mine.toml").write_text(
        'extends = "one-push"\npushes = []\n[mission]\nname = "mine"\nduration = 0.2\n'
        '[person]\nmodel = "virtual-hand"\nrecording = "hand.npz"\n',
        "utf-8",
    )
    tables = {"study": {"name": "recorded", "missions": [str(tmp_path / "mine.toml")]}}
    return tables, read_recording(str(tmp_path / "hand.npz"))


def test_a_recording_is_played_from_what_the_study_holds_without_a_file(shared, tmp_path):
    tables, before = recorded(tmp_path)
    study = flown(tables, tmp_path / "out")
    assert study.read(["outcome"])["outcome"].to_pylist() == ["flying"]
    (tmp_path / "hand.npz").unlink()
    mission, _, _ = mission_of_row(tmp_path / "out", 0)
    after = read_recording(mission.person.recording)
    assert np.array_equal(after.steps, before.steps)
    assert np.array_equal(after.hands, before.hands)
    assert list(shared.iterdir()) == []


def test_a_row_with_a_recording_that_is_flown_alone_can_be_flown_anywhere(shared, tmp_path):
    tables, before = recorded(tmp_path)
    open_folder(load_plan(tables), tmp_path / "out")
    (tmp_path / "hand.npz").unlink()
    alone = tmp_path / "alone"
    command = ["run", "--from", tmp_path / "out", "--row", 0, "--out", alone, "--no-figures"]
    completed([sys.executable, "-c", RUN, *map(str, command)], env=os.environ | {"TMPDIR": str(shared)}, check=True)
    assert list(shared.iterdir()) == []
    again = tl.load_mission(alone / "mission.toml")
    assert np.array_equal(read_recording(again.person.recording).hands, before.hands)
