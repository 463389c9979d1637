import dataclasses
import json
import math
import pickle
import random
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from bombs import memory_below, zeros_archive
from patience import completed

import tandemlift as tl
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.record import FORMAT, Ending, Flight


@pytest.fixture(scope="module")
def short():
    return tl.fly(tl.load_mission("paper", {"mission.duration": 1.0}))


@pytest.fixture(scope="module")
def lost():
    weak = {"controller.gains.lambda_1": 0, "controller.gains.lambda_2": 0, "controller.gains.xi": [4, 2, 11, 1, 1, 1]}
    return tl.fly(tl.load_mission("paper", {**weak, "controller.gains.xi.3": 0.1, "controller.gains.xi.4": 0.1}))


def test_a_saved_flight_loads_to_the_last_bit(short, lost, tmp_path):
    assert lost.ending
    for flight in (short, lost):
        loaded = Flight.load(flight.save(tmp_path / "deep" / "flight.npz"))
        assert loaded == flight
        for name in ("time", *flight):
            assert loaded[name].dtype == np.float64
            assert loaded[name].tobytes() == flight[name].tobytes()
        assert loaded.mission == flight.mission
        assert loaded.metrics() == flight.metrics()
        assert loaded.ending == flight.ending
        assert set(loaded.version) >= {"tandemlift", "llvmlite", "numpy"}
        assert loaded.version == flight.version
    assert list((tmp_path / "deep").iterdir()) == [tmp_path / "deep" / "flight.npz"]


def test_odd_bits_and_odd_divergences_survive(short, tmp_path):
    odd = np.array([0.0, -0.0, math.nan, -math.inf, 5e-324, 1 / 3])
    for value in (math.nan, -math.inf, 1e308, 0.1):
        ending = Ending("position", 1 / 3, value, "must be finite")
        flight = Flight(odd, {"thrust": odd[::-1].copy()}, short.mission, {"steps": 6}, ending, {})
        assert Flight.load(flight.save(tmp_path / "odd.npz")) == flight


def test_flights_that_differ_in_one_bit_or_in_their_record_are_not_equal(short):
    other = Flight(short.time, dict(short.channels), short.mission, short.results, short.ending, short.version)
    assert other == short
    other.channels["thrust"] = np.nextafter(short["thrust"], 0.0)
    assert other != short
    assert Flight(short.time, short.channels, short.mission, {}, None, short.version) != short
    assert short != "a flight"


def test_numpy_alone_reads_the_file(short, tmp_path):
    with np.load(short.save(tmp_path / "flight.npz"), allow_pickle=False) as file:
        header = json.loads(str(file["header"]), parse_constant=pytest.fail)
        assert np.array_equal(file["position"], short["position"])
    assert header["format"] == FORMAT
    assert header["channels"]["position"] == {"unit": "m", "frame": "world", "meaning": CHANNELS["position"].meaning}


def test_a_file_that_unpacks_to_more_than_it_holds_is_refused_unread(short, tmp_path):
    header = np.load(short.save(tmp_path / "flight.npz"))["header"]
    small = zeros_archive(tmp_path / "small.npz", {"time": (10**7,), "position": (10**7, 3)}, {"header": header})
    assert small.stat().st_size < 1_000_000
    with memory_below(20_000_000), pytest.raises(tl.InputError, match=r"small\.npz: .* bytes that unpack to 320"):
        Flight.load(small)


def test_a_file_cut_anywhere_is_refused(short, tmp_path):
    whole = short.save(tmp_path / "flight.npz").read_bytes()
    cut = tmp_path / "cut.npz"
    for size in [*range(0, len(whole), len(whole) // 20), len(whole) - 1]:
        cut.write_bytes(whole[:size])
        with pytest.raises(tl.InputError, match=r"cut\.npz"):
            Flight.load(cut)


def test_a_file_with_a_flipped_bit_is_refused_or_harmless(short, tmp_path):
    whole = short.save(tmp_path / "flight.npz").read_bytes()
    flipped, chance = tmp_path / "flipped.npz", random.Random(0)
    refused = 0
    for _ in range(100):
        content = bytearray(whole)
        content[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        flipped.write_bytes(content)
        try:
            loaded = Flight.load(flipped)
        except tl.InputError:
            refused += 1
        else:
            assert loaded == short
    assert refused > 60


def rewritten(path: Path, **changes):
    """The flight's file with its header, or arrays, changed."""
    with np.load(path) as file:
        arrays = dict(file)
    header = json.loads(str(arrays["header"]))
    for name, value in changes.items():
        if isinstance(value, np.ndarray):
            arrays[name] = value
        elif value is None:
            del arrays[name]
        else:
            header[name] = value
    if "header" in arrays:
        arrays["header"] = np.array(json.dumps(header))
    np.savez(path, **arrays)


@pytest.mark.parametrize(
    ("changes", "piece"),
    [
        ({"format": FORMAT + 1}, "written by another version of tandemlift: its format is 3, this one reads 2"),
        ({"header": None}, "no flight that tandemlift saved: it has no header"),
        ({"time": None}, "damaged or no flight"),
        ({"position": None}, "damaged or no flight"),
        ({"position": np.zeros((7, 3))}, "channel position is float64 (7, 3), beside 101 times"),
        ({"position": np.zeros((101, 3), dtype=np.float32)}, "channel position is float32"),
        ({"thrust": np.zeros((101, 1, 1))}, "channel thrust"),
        ({"mission": 5}, "damaged or no flight"),
        ({"ending": [1]}, "damaged or no flight"),
        ({"channels": {"absent": {}}}, "damaged or no flight"),
    ],
    ids=lambda value: (
        ", ".join(f"{k} {getattr(v, 'shape', v)}" for k, v in value.items()) if value.__class__ is dict else ""
    ),
)
def test_a_flight_of_a_wrong_form_is_refused(changes, piece, short, tmp_path):
    path = short.save(tmp_path / "flight.npz")
    rewritten(path, **changes)
    with pytest.raises(tl.InputError) as refused:
        Flight.load(path)
    assert piece in str(refused.value)


def test_a_flight_with_a_channel_of_another_version_is_refused_and_one_of_the_user_s_own_loads(short, tmp_path):
    own = dataclasses.replace(short, channels={**short.channels, "push_on": short.time, "measured_smell": short.time})
    path = own.save(tmp_path / "flight.npz")
    assert Flight.load(path) == own
    described = {"unit": "1", "frame": "", "meaning": "described by another version"}
    with np.load(path) as file:
        channels = json.loads(str(file["header"]))["channels"]
    rewritten(path, channels={**channels, "measured_smell": described})
    assert Flight.load(path) == own
    rewritten(path, channels={**channels, "push_on": described})
    with pytest.raises(tl.InputError, match=r"flight\.npz: unknown channel 'push_on'; there are position, "):
        Flight.load(path)


def test_a_flight_with_a_controller_that_is_not_loaded_here_is_read(short, tmp_path):
    foreign = dataclasses.replace(short, mission={**short.mission, "controller": {"name": "mine", "own_gain": 3.0}})
    assert Flight.load(foreign.save(tmp_path / "flight.npz")) == foreign


def test_what_is_no_flight_is_refused(tmp_path):
    np.savez(tmp_path / "foreign.npz", a=np.arange(3))
    np.save(tmp_path / "array.npy", np.arange(3))
    (tmp_path / "text.npz").write_text("position, velocity\n1, 2\n")
    (tmp_path / "empty.npz").touch()
    with zipfile.ZipFile(tmp_path / "other.npz", "w") as file:
        file.writestr("notes.txt", "no flight")
    for name in ("foreign.npz", "array.npy", "text.npz", "empty.npz", "other.npz", "absent.npz", "."):
        with pytest.raises(tl.InputError) as refused:
            Flight.load(tmp_path / name)
        assert Path(name).name in str(refused.value)


class Harmful:
    """Writes a file when it is unpickled."""

    def __reduce__(self):
        return Path.touch, (Path("harm"),)


def test_loading_never_unpickles(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez("object.npz", header=np.array([Harmful()], dtype=object), allow_pickle=True)
    Path("pickle.npz").write_bytes(pickle.dumps(Harmful()))
    for name in ("object.npz", "pickle.npz"):
        with pytest.raises(tl.InputError):
            Flight.load(name)
    assert not Path("harm").exists()


def test_a_save_that_fails_leaves_the_old_file_and_nothing_else(short, lost, tmp_path, monkeypatch):
    path = short.save(tmp_path / "flight.npz")

    def fail(file, **arrays):
        file.write(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "savez", fail)
    with pytest.raises(KeyboardInterrupt):
        lost.save(path)
    assert Flight.load(path) == short
    assert list(tmp_path.iterdir()) == [path]


def test_a_save_that_is_killed_leaves_the_old_file(short, tmp_path):
    path = short.save(tmp_path / "flight.npz")
    program = (
        "import os, sys, numpy as np, tandemlift as tl\n"
        "flight = tl.Flight.load(sys.argv[1])\n"
        "def die(file, **arrays):\n"
        "    file.write(b'half'); file.flush(); os._exit(9)\n"
        "np.savez = die\n"
        "flight.save(sys.argv[1])\n"
    )
    assert completed([sys.executable, "-c", program, str(path)], check=False).returncode == 9
    assert Flight.load(path) == short
