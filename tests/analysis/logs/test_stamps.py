"""Stamps are mended where there is no doubt, with a note, and refused with row and both stamps where there is any."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.logs.log import Log, Stream
from tandemlift.analysis.logs.stamps import (
    check_order,
    check_overlap,
    check_rate,
    continued,
    distinct,
    gaps,
    has_stamp,
    stamped,
)

TIME = np.arange(2001) * 1e-3
RNG = np.random.default_rng(7)


@pytest.mark.parametrize(("bits", "tick"), [(32, 1e-6), (32, 1e-3), (24, 1e-3)])
def test_a_counter_that_begins_anew_is_continued_wherever_it_does(bits, tick):
    for _ in range(20):
        ticks = np.round(TIME / tick).astype(np.int64) + 2**bits - int(RNG.integers(1, round(2.0 / tick)))
        time, counter = continued((ticks % 2**bits) * tick)
        assert counter == f"2{'³²' if bits == 32 else '²⁴'} {'µs' if tick == 1e-6 else 'ms'}"
        assert np.diff(time) == pytest.approx(np.full(2000, 1e-3), abs=1e-8)


def test_a_signed_counter_is_continued_too():
    ticks = (np.round(1e6 * TIME).astype(np.int64) + 2**31 - 700_000 + 2**31) % 2**32 - 2**31
    assert np.diff(continued(1e-6 * ticks)[0]) == pytest.approx(np.full(2000, 1e-3), abs=1e-9)


@pytest.mark.parametrize("back", [2e-3, 0.7, 100.0, 3000.0])
def test_stamps_that_go_back_by_anything_else_are_refused_with_row_and_both(back):
    time = TIME + 5000.0
    time[900:] -= back
    assert continued(time)[1] == ""
    with pytest.raises(
        tl.InputError, match=r"gyro: row 900 is at .* s, the row before at 5000\.899 s: times must increase"
    ):
        check_order("gyro", time)
    rows = np.arange(len(time)) * 3
    with pytest.raises(tl.InputError, match="row 2700 is at"):
        check_order("gyro", time, rows)


@pytest.mark.parametrize("wrong", [0.0, np.nan])
@pytest.mark.parametrize("row", [1, 20, 1000, 2000])
def test_an_empty_stamp_and_a_zero_among_others_are_none(wrong, row):
    time = TIME + 3.0
    time[row] = wrong
    found = stamped("gyro", time)
    assert np.flatnonzero(~found.rows).tolist() == [row]
    assert found.time == pytest.approx(np.delete(TIME + 3.0, row))
    assert found.notes == (f"gyro: row {row}, without a stamp (empty or 0): left out",)


def test_a_clock_may_begin_at_zero_or_pass_through_it():
    for begin in (0.0, -1.0):
        assert has_stamp(TIME + begin).all()
    assert not has_stamp(np.zeros(50)).any()


def test_rows_that_share_a_stamp_are_left_out_and_coarse_stamps_are_refused():
    values = np.arange(2001.0)[:, None]
    time = TIME.copy()
    time[500] = time[499]
    stream, notes = distinct("gyro", Stream(time, values))
    assert len(stream.time) == 2000
    assert notes == ("gyro: 1 rows with the stamp of the row before, and other values: left out",)
    held = Stream(np.repeat(TIME, 2), np.repeat(values, 2, axis=0))  # a table that holds a slow sensor, stamp and all
    assert distinct("mocap", held)[1] == ()
    with pytest.raises(tl.InputError, match=r"90% of its rows have the stamp of the row before and other values"):
        distinct("gyro", Stream(np.floor(TIME / 0.01 + 1e-6) * 0.01, values))


@pytest.mark.parametrize(("unit", "factor"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
@pytest.mark.parametrize(("name", "rate"), [("measured_rates", 250.0), ("measured_position", 100.0)])
def test_a_forgotten_unit_and_a_wrong_one_are_told_from_the_rate(unit, factor, name, rate):
    time = np.arange(200) / rate
    check_rate("log.csv", name, time)
    with pytest.raises(
        tl.InputError, match=rf'stream {name}: samples at .* Hz, .* expected; \[{name}\] time_unit = "{unit}"'
    ):
        check_rate("log.csv", name, factor * time)
    with pytest.raises(tl.InputError, match='time_unit = "s"'):
        check_rate("log.csv", name, time / factor, unit)


@pytest.mark.parametrize(
    ("name", "rates"),
    [("measured_rates", [50.0, 400.0, 8000.0]), ("measured_position", [1.0, 5.0, 30.0, 1000.0])],
)
def test_rates_of_real_sensors_are_taken(name, rates):
    for rate in rates:
        check_rate("log", name, np.arange(100) / rate)


def test_a_stamp_far_beyond_the_others_is_refused_before_it_takes_memory():
    time = np.append(TIME, 1e6)
    with pytest.raises(tl.InputError, match="its stamps jump from 2 to 1000000 s"):
        check_rate("log", "measured_rates", time)


def test_gaps_are_told_with_their_times():
    kept = (TIME < 0.5) | (TIME > 0.9)
    log = Log({"measured_rates": Stream(TIME[kept], np.ones((kept.sum(), 3)))})
    assert gaps(log) == ("measured_rates: no samples for 0.402 s from 0.499 s",)


def test_streams_without_a_common_time_are_refused_by_both_names():
    streams = {n: Stream(TIME + at, np.ones((2001, 3))) for n, at in (("measured_rates", 0.0), ("push_force", 9.0))}
    check_overlap(Log(streams))  # a push may come later
    streams["measured_position"] = Stream(TIME + 70.0, np.ones((2001, 3)))
    with pytest.raises(tl.InputError, match="measured_position begins at 70 s, after stream measured_rates has ended"):
        check_overlap(Log(streams))
