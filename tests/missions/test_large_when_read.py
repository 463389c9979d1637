"""Small files and short keys that would take much memory to read are refused before they do."""

import zipfile

import numpy as np
import pytest
import tomli_w
from bombs import memory_below, zeros_archive
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.core.files import MAX_PARTS
from tandemlift.missions import refusals
from tandemlift.missions.recording import MAX_UNPACKED, WIDTH, Recording, read_recording, write_recording

LONG = ".".join("a" * 5_000)
MOST = 20_000_000  # bytes


@pytest.fixture
def write(tmp_path, monkeypatch):
    tl.load_mission("hover")  # what is loaded once is not counted
    monkeypatch.chdir(tmp_path)
    return lambda text: (tmp_path / "mine.toml").write_text(f'extends = "hover"\n{text}\n', "utf-8")


@pytest.mark.parametrize("text", [f"{LONG} = 1", f"[{LONG}]", tomli_w.dumps({"changes": [{"key": LONG}]})])
def test_a_mission_with_a_key_of_thousands_of_parts_is_refused_in_little_memory(write, text):
    write(text)
    with (
        memory_below(MOST),
        pytest.raises(tl.InputError, match=rf"mine.toml: (changes\.0: )?a\.a.*at most {MAX_PARTS} parts"),
    ):
        tl.load_mission("mine.toml")


def test_a_key_of_thousands_of_parts_is_refused_by_set_and_by_explain(tmp_path):
    for command in (["explain", LONG], ["run", "hover", "--out", str(tmp_path / "out"), "--set", f"{LONG}=1"]):
        result = CliRunner().invoke(cli, command)
        assert isinstance(result.exception, tl.InputError)
        assert f"a key has at most {MAX_PARTS} parts" in str(result.exception)
    assert not any(tmp_path.iterdir())


def test_a_recording_that_unpacks_to_more_than_any_flight_has_is_refused_unread(tmp_path):
    count = MAX_UNPACKED // (8 * WIDTH) + 1
    path = zeros_archive(tmp_path / "hand.npz", {"hand": (count, WIDTH)}, {"step": np.arange(1)})
    assert path.stat().st_size < MAX_UNPACKED / 500
    with memory_below(MOST), pytest.raises(tl.InputError, match=rf"unpacks to \d+ bytes, more than {MAX_UNPACKED}"):
        read_recording(str(path))


def test_a_recording_whose_array_claims_more_than_the_file_holds_is_refused(tmp_path):
    for rows in (10**9, 10**16):
        path = zeros_archive(tmp_path / "hand.npz", {}, {"step": np.arange(1)})
        with_claim(path, rows)
        with pytest.raises(tl.InputError, match="not a recording"):
            read_recording(str(path))


def with_claim(path, rows):
    """Add an array that has nothing but its header."""
    with zipfile.ZipFile(path, "a") as archive, archive.open("hand.npy", "w") as file:
        header = {"descr": "<f8", "fortran_order": False, "shape": (rows, WIDTH)}
        np.lib.format.write_array_header_1_0(file, header)


def test_an_hour_of_a_hand_that_moves_without_rest_is_read_again(tmp_path):
    steps = np.arange(0, 3_600_000, 7)  # of a millisecond: a page sends a move every 7 ms at most
    hands = np.zeros((len(steps), WIDTH))
    hands[:100] = np.random.default_rng(1).normal(size=(100, WIDTH))
    write_recording(tmp_path / "hand.npz", Recording(steps, hands))
    again = read_recording(str(tmp_path / "hand.npz"))
    assert np.array_equal(again.steps, steps)
    assert np.array_equal(again.hands, hands)


@pytest.mark.parametrize(
    ("text", "what"),
    [("\n".join(f"k{i} = 1" for i in range(6_000)), "k0 = 1"), ("pushes = [" + "{a=1}," * 3_000 + "]", "pushes.0")],
)
def test_of_thousands_of_problems_only_those_that_are_told_are_put_into_words(write, monkeypatch, text, what):
    worded = []
    for name in ("_unknown_key", "_refusal"):
        word = getattr(refusals, name)
        monkeypatch.setattr(refusals, name, lambda *args, word=word: (worded.append(args), word(*args))[1])
    write(text)
    with pytest.raises(tl.InputError) as refused:
        tl.load_mission("mine.toml")
    first, *_, last = str(refused.value).splitlines()
    assert what in first
    assert int(last.split()[-2]) > 5_000  # all are counted
    assert len(worded) <= 4 * refusals.MOST_PROBLEMS  # some keys have several problems, told as one
