"""Figures that two processes draw are those that one draws, also when the second process fails."""

import shutil
import time

import pytest

import tandemlift as tl
from tandemlift.pictures.figures import registry
from tandemlift.pictures.report import second_drawer as drawing
from tandemlift.pictures.report.second_drawer import SecondDrawer, second_drawer


@pytest.fixture(autouse=True, scope="module")
def two_figures():
    """A flight has two figures, and is worth a second process, which has a processor."""
    every = registry.figures_for
    with pytest.MonkeyPatch.context() as patch:
        for module in (registry, drawing):
            patch.setattr(module, "figures_for", lambda flight: dict(list(every(flight).items())[:2]))
        patch.setattr(drawing, "WORTH", 2)
        patch.setattr(drawing.os, "cpu_count", lambda: 2)
        yield


@pytest.fixture(scope="module")
def flight():
    return tl.fly(tl.load_mission("one-push", {"mission.duration": 3.0}))


@pytest.fixture(scope="module")
def alone(flight, tmp_path_factory):
    """The files that the first process writes if there is no second one."""
    return drawn(SecondDrawer(), flight, "none.npz", tmp_path_factory.mktemp("alone"))


def drawn(drawer, flight, file, folder):
    told = []
    drawer.save_figures(flight, file, folder, lambda done, total: told.append((done, total)))
    assert sorted(told) == [(done, 2) for done in range(3)]
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def test_two_processes_write_the_bytes_of_one(flight, alone, tmp_path, monkeypatch):
    monkeypatch.setattr(drawing, "_draw_each", lambda *_: None)  # so the second process draws all
    flight.save(tmp_path / "flight.npz")
    with second_drawer() as drawer:
        assert drawn(drawer, flight, tmp_path / "flight.npz", tmp_path / "figures") == alone


def test_figures_that_the_second_process_cannot_draw_are_drawn_by_the_first(flight, alone, tmp_path):
    with second_drawer() as drawer:  # the file does not exist: the process ends
        assert drawn(drawer, flight, tmp_path / "none.npz", tmp_path / "figures") == alone


def test_a_process_that_does_not_start_leaves_all_to_the_first(flight, alone, tmp_path, monkeypatch):
    monkeypatch.setattr(drawing.sys, "executable", shutil.which("false"))
    with second_drawer() as drawer:
        time.sleep(0.2)  # so that it has ended when it is asked
        assert drawn(drawer, flight, tmp_path / "none.npz", tmp_path / "figures") == alone
