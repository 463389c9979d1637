"""Machine code on disk: shared by processes, whole or not there, of the user alone, and never a reason to fail."""

from __future__ import annotations

import errno
import json
import os
import random
import re
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from patience import PATIENCE

import tandemlift as tl
from tandemlift.compiler.machine_code import code, machine, store
from tandemlift.core.caching import LastUsed
from tandemlift.simulation import plan

CHANGES = {"mission.duration": 0.5}
FLY = """
import sys, tandemlift as tl
flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 0.5}))
print(flight["thrust"].tobytes().hex()[-4000:])
"""
ENTRY = store.StoredCode({"size": 3, "rooms": {"hands": [0, 3]}}, b"\0code\nmore\xff")


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, for this process and others, and no code in this process; nothing is optimised unasked."""
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("TANDEMLIFT_OPTIMISE", "0")
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))
    return tmp_path / "cache"


def started(code=FLY):
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def check_output(process):
    out, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, errors) == (0, "")
    return out


OPTIMISED = """import os; os.environ["TANDEMLIFT_OPTIMISE"] = "1"
from tandemlift.compiler.machine_code import code; code.PAYS = 0.0"""


def check_entries(cache):
    """The files of machine code in the cache; each of all files is a whole one."""
    files = sorted((cache / "code").iterdir())
    for file in files:
        assert not file.name.startswith(".")
        assert store._entry(file.read_bytes()) is not None
    return [file for file in files if not file.stem.endswith(("-text", "-module"))]


@pytest.fixture(scope="module")
def right():
    """What a flight says that finds nothing on disk and cannot keep anything."""
    process = subprocess.run(
        [sys.executable, "-c", FLY],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
        env={**os.environ, "TANDEMLIFT_CACHE": os.devnull},
    )
    return process.stdout


# Several processes


def test_processes_that_compile_the_same_at_once_all_fly_and_leave_one_good_file(cache, right):
    processes = [started() for _ in range(3)]
    assert [check_output(process) for process in processes] == [right] * 3
    assert len(check_entries(cache)) == 1
    assert check_output(started()) == right


def test_after_a_process_is_killed_at_any_moment_the_next_one_flies(cache, right, monkeypatch):
    """Six are killed, from the first import until they have flown; nothing half is ever read."""
    monkeypatch.delenv("TANDEMLIFT_OPTIMISE")
    chance = random.Random(1)
    began = time.monotonic()
    check_output(started())
    whole = time.monotonic() - began
    for i in range(6):
        if i % 2:  # compiled anew every other time
            for file in (cache / "code").iterdir():
                file.unlink(missing_ok=True)  # an optimising process may still be at it
        process = started(FLY.replace("flight = ", f"{OPTIMISED}\nflight = "))
        time.sleep(chance.uniform(0.2, 1.1) * whole if i else 0.0)  # wherever it is by then
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=PATIENCE)
        if i == 5:
            assert check_output(started()) == right
        else:
            assert np.array_equal(here()["thrust"], here.first["thrust"])


def here():
    """A flight in this process, by what is on disk now."""
    plan.LOOP_CODE.clear()
    flight = tl.fly(tl.load_mission("one-push", CHANGES))
    here.first = getattr(here, "first", flight)
    return flight


def test_what_a_killed_process_leaves_behind_is_removed_in_time(cache, monkeypatch):
    store.write("one", ENTRY)
    rest = cache / "code" / ".tmp-of-a-killed-process"
    rest.write_bytes(b"x" * 1000)
    os.utime(rest, (1.0, 1.0))
    monkeypatch.setattr(store, "MOST_BYTES", 500)
    store.write("two", ENTRY)
    assert sorted(p.name for p in (cache / "code").iterdir()) == ["one.o", "two.o"]


# What is kept


def test_an_entry_is_read_as_it_was_written(cache):
    assert store.write("key", ENTRY)
    assert store.read("key") == ENTRY
    assert store.read("another") is None


def test_the_folder_and_its_files_are_the_users_own(cache):
    before = os.umask(0)
    try:
        store.write("key", ENTRY)
    finally:
        os.umask(before)
    assert stat.S_IMODE((cache / "code").stat().st_mode) == 0o700
    assert stat.S_IMODE((cache / "code" / "key.o").stat().st_mode) == 0o600


def test_the_folder_keeps_the_newest_within_its_bound(cache, monkeypatch):
    size = len(store.MAGIC) + store.CHECKSUM + len(json.dumps(ENTRY.about)) + 1 + len(ENTRY.code)
    monkeypatch.setattr(store, "MOST_BYTES", 3 * size + size // 2)
    for i in range(6):
        store.write(f"key{i}", ENTRY)
        os.utime(cache / "code" / f"key{i}.o", (i + 1.0, i + 1.0))
        if i == 3:
            store.read("key1")  # used again, so newer than the others
    kept = sorted(p.name for p in (cache / "code").iterdir())
    assert kept == ["key1.o", "key4.o", "key5.o"]


def test_a_reader_sees_whole_entries_alone_while_others_write(cache):
    """Two threads write, each its own entry under one key; every read gives one of the two."""
    long = [store.StoredCode({"writer": i}, bytes([i]) * 300_000) for i in (1, 2)]
    done = threading.Event()
    writers = [threading.Thread(target=lambda e=e: [store.write("key", e) for _ in range(40)]) for e in long]
    store.write("key", long[0])
    for writer in writers:
        writer.start()
    threading.Thread(target=lambda: ([w.join() for w in writers], done.set())).start()
    while not done.is_set():
        assert store.read("key") in long
    assert [p.name for p in (cache / "code").iterdir()] == ["key.o"]


# What cannot be trusted


def damaged(file, way):
    data = bytearray(file.read_bytes())
    if way == "cut short":
        file.write_bytes(data[: len(data) // 2])
    elif way == "empty":
        file.write_bytes(b"")
    elif way == "of another version":
        file.write_bytes(data.replace(store.MAGIC, store.MAGIC.replace(b"1", b"0"), 1))
    elif way == "longer":
        file.write_bytes(data + b"\0")
    elif way == "for the group to write":
        file.chmod(0o620)
    elif way == "for all to write":
        file.chmod(0o602)
    elif way == "a link":
        other = file.with_name("elsewhere")
        file.rename(other)
        file.symlink_to(other)
    elif way == "a link to nowhere":
        file.unlink()
        file.symlink_to(file.with_name("nowhere"))
    elif way == "a folder":
        file.unlink()
        file.mkdir()
    else:
        place = {"a bit of its code": -100, "a bit of its checksum": len(store.MAGIC) + 3, "its first bit": 0}[way]
        data[place] ^= 1
        file.write_bytes(data)


WAYS = ["cut short", "empty", "of another version", "longer", "for the group to write", "for all to write", "a link"]
WAYS += ["a link to nowhere", "a bit of its code", "a bit of its checksum", "its first bit"]


@pytest.mark.parametrize("way", WAYS)
def test_an_entry_that_cannot_be_trusted_is_not_read_and_can_be_written_again(way, cache):
    entry = store.StoredCode({"size": 3}, bytes(range(256)))
    assert store.write("key", entry)
    damaged(cache / "code" / "key.o", way)
    assert store.read("key") is None
    assert store.write("key", entry)
    assert store.read("key") == entry
    assert store._is_own((cache / "code" / "key.o").lstat(), stat.S_ISREG)


def test_a_flight_whose_entry_is_damaged_has_it_made_anew_once(cache, monkeypatch):
    first = here()
    (file,) = check_entries(cache)
    damaged(file, "a bit of its code")
    made, compiled = [], machine.compiled
    monkeypatch.setattr(machine, "compiled", lambda *given: made.append(given) or compiled(*given))
    for _ in range(2):
        assert np.array_equal(here()["thrust"], first["thrust"])
        assert len(made) == 1
    assert store.read(file.stem) is not None


def test_a_module_on_disk_that_cannot_be_trusted_is_traced_again(cache):
    first, mission = here(), tl.load_mission("one-push", CHANGES)
    plan.LOOP_CODE.clear()
    (text,) = cache.glob("code/*-text.o")
    damaged(text, "a bit of its code")
    found = plan.FlightPlan(mission).loop_code.loop(1)
    found.optimise().join(PATIENCE)
    assert found.is_best
    assert np.array_equal(tl.fly(mission)["thrust"], first["thrust"])


def test_a_folder_in_the_place_of_an_entry_is_left_alone(cache):
    first = here()
    (file,) = check_entries(cache)
    damaged(file, "a folder")
    assert np.array_equal(here()["thrust"], first["thrust"])


def test_an_entry_of_another_user_is_not_loaded(cache, monkeypatch):
    """Neither is anything read from a folder of another user, nor written there."""
    store.write("key", ENTRY)
    own = os.geteuid()
    monkeypatch.setattr(store.os, "geteuid", lambda: own + 1)
    assert store.read("key") is None
    assert store.folder() is None
    assert not store.write("key", ENTRY)
    monkeypatch.setattr(store.os, "geteuid", lambda: own)
    assert store.read("key") == ENTRY


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs root, to give a file away")
def test_a_file_that_is_owned_by_another_is_removed(cache):
    store.write("key", ENTRY)
    os.chown(cache / "code" / "key.o", 12345, -1)
    assert store.read("key") is None
    assert not (cache / "code" / "key.o").exists()
    os.chown(cache / "code", 12345, -1)
    assert store.folder() is None


@pytest.mark.parametrize("mode", [0o770, 0o702, 0o777])
def test_a_folder_that_others_may_write_to_is_not_used(mode, cache):
    first = here()
    (cache / "code").chmod(mode)
    before = sorted((cache / "code").iterdir())
    assert store.folder() is None
    assert np.array_equal(here()["thrust"], first["thrust"])
    assert sorted((cache / "code").iterdir()) == before


@pytest.mark.parametrize("what", ["a file", "a link", "a link to nowhere"])
def test_a_cache_that_is_no_folder_is_not_used(what, cache, tmp_path):
    cache.mkdir()
    if what == "a file":
        (cache / "code").write_text("")
    else:
        (tmp_path / "elsewhere").mkdir() if what == "a link" else None
        (cache / "code").symlink_to(tmp_path / "elsewhere")
    assert np.array_equal(here()["thrust"], here()["thrust"])
    assert store.folder() is None
    assert not list(tmp_path.glob("elsewhere/*"))


def test_keys_are_plain_names(cache, monkeypatch):
    """Nothing of a mission gets into the path of its code but by a hash."""
    asked = []
    path_of = store.path_of
    monkeypatch.setattr(store, "path_of", lambda key: asked.append(key) or path_of(key))
    here()
    assert asked
    assert all(set(re.sub("-(quick|best|text|module)$", "", key)) <= set("0123456789abcdef") for key in asked)


# What cannot be written


def fails(number):
    def call(*args, **kwargs):
        raise OSError(number, os.strerror(number))

    return call


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES])
@pytest.mark.parametrize("where", ["mkdir", "mkstemp", "replace", "write"])
def test_a_flight_flies_without_a_cache_and_heals_it(where, number, cache, right, monkeypatch):
    with monkeypatch.context() as broken:
        if where == "mkdir":
            broken.setattr(Path, "mkdir", fails(number))
        elif where == "mkstemp":
            broken.setattr(store.tempfile, "mkstemp", fails(number))
        elif where == "replace":
            broken.setattr(store.os, "replace", fails(number))
        else:
            broken.setattr(store, "open", lambda handle, mode: Full(handle, number), raising=False)
        flight = here()
    assert not list(cache.glob("code/*"))
    assert np.array_equal(here()["thrust"], flight["thrust"])
    assert len(check_entries(cache)) == 1
    assert flight["thrust"].tobytes().hex()[-4000:] + "\n" == right


class Full:
    """A file on a disk that is full after some bytes."""

    def __init__(self, handle, number):
        self.handle, self.number = handle, number

    def __enter__(self):
        return self

    def __exit__(self, *what):
        os.close(self.handle)

    def write(self, data):
        os.write(self.handle, data[:100])
        raise OSError(self.number, os.strerror(self.number))


def test_a_full_disk_is_no_reason_not_to_optimise(cache, monkeypatch):
    monkeypatch.setattr(store.os, "replace", fails(errno.ENOSPC))
    mission = tl.load_mission("one-push", CHANGES)
    first, found = here(), plan.FlightPlan(mission).loop_code.loop(1)
    thread = found.optimise()
    assert thread is not None
    thread.join(PATIENCE)
    assert found.is_best
    assert np.array_equal(tl.fly(mission)["thrust"], first["thrust"])
    assert list(cache.glob("code/*")) == []
    assert code.store is store
