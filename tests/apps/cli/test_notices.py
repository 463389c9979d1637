"""What is told of compiling: only what was compiled, in lines of measured times."""

import threading

import pytest

from tandemlift.apps.cli import notices
from tandemlift.apps.cli.notices import CompileNotices
from tandemlift.core.progress import Compiled, publish, watching

LOOP = Compiled("flight loop", 0.5, is_made=True)


@pytest.fixture
def clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr("tandemlift.apps.cli.notices.time.perf_counter", lambda: now[0])
    return now


def check_lines(capsys):
    out, err = capsys.readouterr()
    assert out == ""
    return err.splitlines()


def compile_for(clock, seconds, what=LOOP):
    publish(None)
    clock[0] += seconds
    publish(what)


def test_a_loop_is_told_of_with_its_time_and_what_took_no_time_is_not(clock, capsys):
    with watching(CompileNotices()):
        compile_for(clock, 0.62)
        compile_for(clock, 0.01)
    assert check_lines(capsys) == ["Compiled the flight loop in 0.6 s; it is kept for next time."]


def test_several_are_told_of_in_one_line_at_the_end(clock, capsys):
    teller = CompileNotices()
    with watching(teller), teller.together():
        for _ in range(3):
            compile_for(clock, 0.5)
        assert check_lines(capsys) == []
    assert check_lines(capsys) == ["Compiled 3 flight loops in 1.5 s; they are kept for next time."]


def test_what_is_compiled_at_the_same_time_counts_once(clock, capsys):
    teller = CompileNotices()
    with watching(teller), teller.together():
        publish(None)
        clock[0] += 1.0
        compile_for(clock, 1.0, LOOP._replace(what="drawing loop"))
        publish(LOOP)
    assert check_lines(capsys) == ["Compiled 2 loops in 2.0 s; they are kept for next time."]


def test_a_cache_that_cannot_be_written_is_told_of(clock, capsys):
    with watching(CompileNotices()):
        compile_for(clock, 1.0, LOOP._replace(is_kept=False))
    assert check_lines(capsys) == ["Compiled the flight loop in 1.0 s; the cache cannot be written (TANDEMLIFT_CACHE)."]


def test_what_could_not_be_compiled_is_not_said_to_be(clock, capsys):
    with watching(CompileNotices()):
        compile_for(clock, 1.0, Compiled("flight loop"))
        compile_for(clock, 1.0)
    assert [line[:8] for line in check_lines(capsys)] == ["Compiled"]


def test_what_takes_long_is_told_of_before_its_end(monkeypatch, capsys):
    monkeypatch.setattr(notices, "PATIENCE", 0.0)
    said, say = threading.Event(), notices._print_line
    monkeypatch.setattr(notices, "_print_line", lambda line: (say(line), said.set()))
    with watching(CompileNotices()):
        publish(None)
        assert said.wait(30.0)
        assert check_lines(capsys) == ["Compiling for this machine …"]
        publish(LOOP)
