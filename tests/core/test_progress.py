"""Progress in a terminal, in a notebook and in a file."""

import io
import re
import sys
import threading
import time
from types import SimpleNamespace

import pytest
from tqdm import tqdm

import tandemlift as tl
from tandemlift.core.progress import NOTICE, Compiled, progress_or_own, publish, shown_progress


class OutStream(io.StringIO):
    """What a notebook's kernel puts in place of standard output."""

    __module__ = "ipykernel.iostream"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def states(stream):
    """What a stream has shown, one state of the bar after the other."""
    return [text.strip() for text in re.split(r"[\r\n]", stream.getvalue()) if text.strip()]


def test_a_terminal_shows_one_line_with_share_count_and_unit():
    stream = Terminal()
    with shown_progress("gusts", stream=stream) as progress:
        for done in (0, 4, 8):
            progress(done, 8)
    assert re.match(r"gusts: 100%\|.*\| 8/8 \[.* rows/s\]", states(stream)[-1])
    assert stream.getvalue().count("\n") == 1


def test_rate_and_time_left_count_from_what_was_there_before():
    stream = Terminal()
    with shown_progress("gusts", stream=stream) as progress:
        progress(999_000, 1_000_000)
        time.sleep(0.3)
        progress(999_003, 1_000_000)
    rate = float(re.search(r"([\d.]+) rows/s", states(stream)[-1])[1])
    assert rate < 15.0


def test_a_file_gets_lines_from_time_to_time_and_none_of_a_short_study(monkeypatch):
    def written():
        stream = io.StringIO()
        with shown_progress("gusts", stream=stream) as progress:
            for done in range(20):
                progress(done, 1000)
                time.sleep(0.01)
        return stream.getvalue()

    assert written() == ""
    monkeypatch.setattr("tandemlift.core.progress.BETWEEN_LINES", 0.02)
    lines = written().splitlines()
    assert 2 <= len(lines) <= 21
    assert all(re.match(r"gusts: \d+ of 1000 rows, (\d\d:\d\d|\?) left$", line) for line in lines), lines
    assert "\r" not in written()


def test_the_line_ends_although_the_study_is_stopped():
    stream = Terminal()

    def stopped():
        with shown_progress("gusts", stream=stream) as progress:
            progress(1, 8)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert stream.getvalue().endswith("\n")


# ---- In a notebook


@pytest.fixture
def cell(monkeypatch):
    """What a notebook's cell shows at the end: the last state of each bar, and notices."""
    outputs = []

    def display(content, *, raw, display_id):
        assert raw
        assert display_id
        place = len(outputs)
        outputs.append(content["text/plain"])
        return SimpleNamespace(update=lambda content, *, raw: outputs.__setitem__(place, content["text/plain"]))

    class Bar(tqdm):
        def close(self):
            if not self.disable:
                outputs.append(f"{self.desc}: {self.n} of {self.total}{self.unit}")
            super().close()

    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=display))
    monkeypatch.setattr("tandemlift.core.progress.sys", SimpleNamespace(stdout=OutStream(), stderr=OutStream()))
    monkeypatch.setattr("tqdm.auto.tqdm", Bar)
    return outputs


def missions(count):
    return [tl.load_mission("one-push", {"mission.duration": 0.1})] * count


def test_a_cell_shows_one_bar_with_the_last_state(cell):
    with progress_or_own("gusts", None) as progress:
        for done in (0, 4, 8):
            progress(done, 8)
    assert cell == ["gusts: 8 of 8 rows"]


def test_many_flights_have_a_bar_in_a_cell_and_none_in_a_script(cell, monkeypatch, capsys):
    assert len(tl.fly_many(missions(20), keep="metrics")) == 20
    assert [text for text in cell if text] == ["Flown: 20 of 20 flights"]
    cell.clear()
    capsys.readouterr()
    monkeypatch.setattr("tandemlift.core.progress.sys", sys)
    tl.fly_many(missions(20), keep="metrics")
    assert cell == []
    assert capsys.readouterr().err == ""


def test_work_within_other_work_has_no_bar_of_its_own_be_it_in_a_thread(cell):
    with progress_or_own("outer", None, "parts") as outer:
        worker = threading.Thread(target=tl.fly_many, args=(missions(9),))
        worker.start()
        worker.join()
        outer(1, 1)
    assert [text for text in cell if text] == ["outer: 1 of 1 parts"]


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
