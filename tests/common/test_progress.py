"""The line of progress in a terminal, in a notebook and in a file."""

import io

import pytest

from tandemlift.common.progress import ProgressLine, duration, shown_progress


class OutStream(io.StringIO):
    """What a notebook's kernel puts in place of standard output: no terminal, and yet a line can be written anew."""

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
    line = ProgressLine("gusts", stream, rewrites, clock)
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


@pytest.mark.parametrize("stream", [OutStream(), Terminal()])
def test_a_notebook_and_a_terminal_show_one_line(stream):
    with shown_progress("gusts", stream) as progress:
        for done in (0, 4, 8):
            progress(done, 8)
    assert stream.getvalue().startswith("\rgusts: 0 of 8")
    assert shown(stream.getvalue())[0] == "gusts: 8 of 8 rows (100 %)"
    assert stream.getvalue().count("\n") == 1


def test_a_notebooks_progress_goes_to_the_output_of_the_cell(monkeypatch):
    cell = OutStream()
    monkeypatch.setattr("sys.stdout", cell)
    with shown_progress("gusts") as progress:
        progress(1, 8)
    assert shown(cell.getvalue())[0] == "gusts: 1 of 8 rows (12 %)"


def test_the_line_ends_although_the_study_is_stopped():
    stream = Terminal()

    def stopped():
        with shown_progress("gusts", stream) as progress:
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
