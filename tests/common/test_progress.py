"""Progress in a terminal, in a notebook and in a file."""

import io
import sys
import threading
from types import SimpleNamespace

import pytest

import tandemlift as tl
from tandemlift.common.progress import NotebookBar, Pace, ProgressLine, duration, progress_or_own, shown_progress
from tandemlift.machine_code.compile_events import NOTICE, Compiled, publish


class OutStream(io.StringIO):
    """What a notebook's kernel puts in place of standard output."""

    __module__ = "ipykernel.iostream"


class Terminal(io.StringIO):
    def isatty(self):
        return True


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def line_after(moments, rewrites=True):
    """What is written when so many rows of 1,000 are done at some times [s]."""
    stream, clock = io.StringIO(), Clock()
    line = ProgressLine(Pace("gusts", "rows", clock), stream, rewrites)
    for at, done in moments:
        clock.now = 100.0 + at
        line(done, 1000)
    line.close()
    return stream.getvalue()


def shown(text):
    """What a terminal shows of text: a carriage return begins its line anew."""
    lines = []
    for line in text.split("\n"):
        cells = ""
        for piece in line.split("\r"):
            cells = piece + cells[len(piece) :]
        lines.append(cells.rstrip())
    return lines


def test_rate_and_time_left_count_from_what_was_there_before():
    assert shown(line_after([(0, 500), (10, 600)]))[0] == "gusts: 600 of 1,000 rows (60 %), 10 rows/s, 40 s left"


def test_the_rate_is_that_of_the_last_minute():
    slow_then_fast = [(t, t) for t in range(0, 200)] + [(200 + t, 200 + 5 * t) for t in range(0, 90)]
    assert shown(line_after(slow_then_fast))[0] == "gusts: 645 of 1,000 rows (64 %), 5 rows/s, 1 min 11 s left"


def test_nothing_is_said_of_the_time_left_before_it_is_known():
    assert shown(line_after([(0, 7)]))[0] == "gusts: 7 of 1,000 rows (1 %)"
    assert shown(line_after([(0, 0), (5, 0)]))[0] == "gusts: 0 of 1,000 rows (0 %)"


def test_a_shorter_line_covers_a_longer_one():
    text = line_after([(0, 0), (100, 3), (200, 1000)])
    assert shown(text) == ["gusts: 1,000 of 1,000 rows (100 %)", ""]


def test_a_file_gets_a_line_every_ten_seconds_and_none_of_a_short_study():
    moments = [(t, t) for t in range(26)]
    assert line_after(moments, rewrites=False).splitlines() == [
        "gusts: 10 of 1,000 rows (1 %), 1 rows/s, 16 min 30 s left",
        "gusts: 20 of 1,000 rows (2 %), 1 rows/s, 16 min 20 s left",
    ]
    assert line_after([(t, 100 * t) for t in range(9)], rewrites=False) == ""


def test_a_terminal_shows_one_line():
    stream = Terminal()
    with shown_progress("gusts", stream=stream) as progress:
        for done in (0, 4, 8):
            progress(done, 8)
    assert stream.getvalue().startswith("\rgusts: 0 of 8")
    assert shown(stream.getvalue())[0] == "gusts: 8 of 8 rows (100 %)"
    assert stream.getvalue().count("\n") == 1


def test_the_line_ends_although_the_study_is_stopped():
    stream = Terminal()

    def stopped():
        with shown_progress("gusts", stream=stream) as progress:
            progress(1, 8)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert stream.getvalue().endswith("\n")


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(0.2, "0 s"), (59.6, "1 min 0 s"), (3599.7, "1 h 0 min"), (5400.0, "1 h 30 min"), (400_000.0, "4 days 15 h")],
)
def test_times_are_said_in_their_units(seconds, said):
    assert duration(seconds) == said


# ---- In a notebook


@pytest.fixture
def cell(monkeypatch):
    """What a notebook's cell shows at the end: a list of plain texts, one for each output."""
    outputs = []

    def display(content, *, raw, display_id):
        assert raw
        assert display_id
        place = len(outputs)
        outputs.append(content["text/plain"])

        def update(content, *, raw):
            assert raw
            outputs[place] = content["text/plain"]

        return SimpleNamespace(update=update)

    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display))
    monkeypatch.setattr("tandemlift.common.progress.sys", SimpleNamespace(stdout=OutStream()))
    monkeypatch.setattr("tandemlift.common.progress.PATIENCE", 0.0)
    return outputs


def missions(count):
    return [tl.load_mission("one-push", {"mission.duration": 0.1})] * count


def test_a_cell_shows_one_bar_with_the_last_state(cell):
    with progress_or_own("gusts", None) as progress:
        for done in (0, 4, 8):
            progress(done, 8)
    assert cell == ["gusts: 8 of 8 rows (100 %)"]


def test_a_cell_shows_no_bar_of_quick_work(cell):
    clock = Clock()
    bar = NotebookBar(Pace("gusts", "rows", clock))
    bar._next += 0.5
    bar(8, 8)
    bar.close()
    assert cell == []


def test_many_flights_have_a_bar_in_a_cell_and_none_in_a_script(cell, monkeypatch, capsys):
    assert len(tl.fly_many(missions(20), keep="metrics")) == 20
    assert [text for text in cell if text] == ["Flown: 20 of 20 flights (100 %)"]
    cell.clear()
    monkeypatch.setattr("tandemlift.common.progress.sys", sys)
    tl.fly_many(missions(20), keep="metrics")
    assert cell == []
    assert capsys.readouterr().err == ""


def test_work_within_other_work_has_no_bar_of_its_own_be_it_in_a_thread(cell):
    with progress_or_own("outer", None, "parts") as outer:
        worker = threading.Thread(target=tl.fly_many, args=(missions(9),))
        worker.start()
        worker.join()
        outer(1, 1)
    assert [text for text in cell if text] == ["outer: 1 of 1 parts (100 %)"]


def test_progress_of_the_callers_own_takes_the_place_of_the_bar(cell):
    seen = []
    tl.fly_many(missions(9), progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (9, 9)
    assert [text for text in cell if text] == []


def test_a_cell_says_that_it_compiles_as_long_as_it_does(cell):
    publish(None)
    publish(None)
    publish(Compiled("flight loop", is_made=True))
    assert cell == [NOTICE]
    publish(Compiled("flight loop"))
    assert cell == [""]
