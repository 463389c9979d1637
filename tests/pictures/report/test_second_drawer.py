"""Figures that two processes draw are those that one draws, also when the second process fails."""

import os
import threading

import pytest

import tandemlift as tl
from tandemlift.pictures.figures import registry
from tandemlift.pictures.report import second_drawer as drawing
from tandemlift.pictures.report.second_drawer import can_fork, draw_by_two

needs_fork = pytest.mark.skipif(not can_fork(), reason="draws by one process: no Linux, one processor, or a thread")


@pytest.fixture(autouse=True, scope="module")
def two_figures():
    """A flight has two figures."""
    every = registry.figures_for
    with pytest.MonkeyPatch.context() as patch:
        for module in (registry, drawing):
            patch.setattr(module, "figures_for", lambda flight: dict(list(every(flight).items())[:2]))
        yield


@pytest.fixture(scope="module")
def flight():
    return tl.fly(tl.load_mission("one-push", {"mission.duration": 3.0}))


@pytest.fixture(scope="module")
def alone(flight, tmp_path_factory):
    """The files that the first process writes if there is no second one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(drawing, "can_fork", lambda: False)
        return drawn(flight, tmp_path_factory.mktemp("alone"))


def drawn(flight, folder):
    told = []
    draw_by_two(flight, folder, lambda done, total: told.append((done, total)))
    assert sorted(told) == [(done, 2) for done in range(3)]
    return {file.name: file.read_bytes() for file in folder.iterdir()}


@pytest.mark.thorough
@needs_fork
@pytest.mark.parametrize("count", [0, 1])
def test_two_processes_write_the_bytes_of_one(count, flight, alone, tmp_path, monkeypatch):
    first, one = os.getpid(), drawing.save_flight_figure
    by_first = []

    def save(flight, name, folder):
        """The first process draws so many figures, and waits for the second one to draw the others."""
        if os.getpid() == first:
            by_first.append(name)
        return one(flight, name, folder)

    each = drawing._draw_each

    def draw_each(*given):
        if os.getpid() != first or count:
            each(*given)

    monkeypatch.setattr(drawing, "save_flight_figure", save)
    monkeypatch.setattr(drawing, "_draw_each", draw_each)
    assert drawn(flight, tmp_path / "figures") == alone
    assert len(by_first) <= 2 * count


@needs_fork
def test_figures_that_the_second_process_cannot_draw_are_drawn_by_the_first(flight, alone, tmp_path, monkeypatch):
    first, one = os.getpid(), drawing.save_flight_figure
    save = lambda *given: one(*given) if os.getpid() == first else os._exit(1)  # noqa: E731
    monkeypatch.setattr(drawing, "save_flight_figure", save)
    assert drawn(flight, tmp_path / "figures") == alone


@needs_fork
def test_an_error_of_the_first_process_ends_the_second_one(flight, tmp_path, monkeypatch):
    first, fork, second = os.getpid(), os.fork, []

    def save(*_):
        if os.getpid() == first:
            raise OSError("full")
        threading.Event().wait()

    monkeypatch.setattr(drawing, "save_flight_figure", save)
    monkeypatch.setattr(os, "fork", lambda: second.append(fork()) or second[0])
    with pytest.raises(OSError, match="full"):
        draw_by_two(flight, tmp_path)
    with pytest.raises(ProcessLookupError):
        os.kill(second[0], 0)


def test_beside_a_thread_that_works_one_process_draws():
    ended = threading.Event()
    thread = threading.Thread(target=ended.wait)
    thread.start()
    try:
        assert not can_fork()
    finally:
        ended.set()
        thread.join()
