"""Machine code on disk: shared by processes, whole or not there, of the user alone, and never a reason to fail."""

from __future__ import annotations

import errno
import json
import os
import random
import re
import shutil
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import NamedTuple

import pytest
from patience import PATIENCE

import tandemlift as tl
from tandemlift.compiler.machine_code import machine, store
from tandemlift.core import law
from tandemlift.core.caching import LastUsed
from tandemlift.core.plugs import plug
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.guidance.admittance import gate
from tandemlift.simulation import plan

CHANGES = {"mission.duration": 0.5}
FLY = """
import sys, tandemlift as tl
flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 0.5}))
print(flight["thrust"].tobytes().hex()[-4000:])
"""
ENTRY = store.StoredCode({"size": 3, "rooms": {"hands": [0, 3]}}, b"\0code\nmore\xff")


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """What a flight says that finds nothing on disk, and the cache that it leaves."""
    left = tmp_path_factory.mktemp("left")
    environment = {**os.environ, "TANDEMLIFT_CACHE": str(left), "TANDEMLIFT_OPTIMISE": "0"}
    command = [sys.executable, "-c", FLY]
    process = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=True, env=environment)
    return process.stdout, left


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, for this process and others, and no code in this process; nothing is optimised unasked."""
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("TANDEMLIFT_OPTIMISE", "0")
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))
    return tmp_path / "cache"


@pytest.fixture
def filled(cache, right):
    """The cache after a flight."""
    return shutil.copytree(right[1], cache)


def here():
    """The end of a flight's thrusts in this process, by what is on disk now."""
    plan.LOOP_CODE.clear()
    return tl.fly(tl.load_mission("one-push", CHANGES))["thrust"].tobytes().hex()[-4000:] + "\n"


def started(code=FLY):
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def check_output(process):
    out, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, errors) == (0, "")
    return out


OPTIMISED = """import os; os.environ["TANDEMLIFT_OPTIMISE"] = "1"
from tandemlift.compiler.machine_code import code; code.PAYS = 0.0"""


def check_entries(cache):
    """The files of machine code in the cache; each of all files is a whole one, named by a hash alone."""
    files = sorted((cache / "code").iterdir())
    for file in files:
        assert re.fullmatch(r"[0-9a-f]+-(quick|best|text|module)\.o", file.name)
        assert store.read(file.stem) is not None
    return [file for file in files if not file.stem.endswith(("-text", "-module"))]


class OwnGate(NamedTuple):
    """A gate of a test, whose laws it registers."""

    threshold: Vec3


def test_a_law_of_ones_own_that_is_registered_anew_flies_at_once_and_leaves_no_code_under_its_name(cache, right):
    plug("gate", "of-a-test")(lambda table: OwnGate(ZERO))
    mission, ends = tl.load_mission("one-push", {"mission.duration": 8.0, "admittance.gate": "of-a-test"}), []
    for own in (lambda kind, F: kind.threshold, lambda kind, F: F, lambda kind, F: F * 2.0):
        gate.register(OwnGate)(own)
        assert store.key_of(OwnGate(ZERO)) == ""
        ends.append(tl.fly(mission)["reference_position"][-1, 0])
    law.REPLACED.clear()
    assert ends[0] == 0.0 < ends[1] == pytest.approx(0.5 * ends[2])
    assert here() == right[0]


# Several processes


@pytest.mark.thorough
def test_processes_that_compile_the_same_at_once_all_fly_and_leave_one_good_file(cache, right):
    processes = [started() for _ in range(2)]
    assert [check_output(process) for process in processes] == [right[0]] * 2
    assert len(check_entries(cache)) == 1
    assert here() == right[0]


@pytest.mark.thorough
def test_after_a_process_is_killed_at_any_moment_the_next_one_flies(cache, right, monkeypatch):
    """Four are killed, from the first import until they have flown; nothing half is ever read."""
    monkeypatch.delenv("TANDEMLIFT_OPTIMISE")
    chance = random.Random(1)
    began = time.monotonic()
    check_output(started())
    whole = time.monotonic() - began
    for i in range(4):
        if i % 2:  # compiled anew every other time
            for file in (cache / "code").iterdir():
                file.unlink(missing_ok=True)  # an optimising process may still be at it
        process = started(FLY.replace("flight = ", f"{OPTIMISED}\nflight = "))
        time.sleep(chance.uniform(0.2, 1.1) * whole if i else 0.0)  # wherever it is by then
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=PATIENCE)
        assert here() == right[0]


def test_what_a_killed_process_leaves_behind_is_removed_in_time(cache, monkeypatch):
    store.write("one", ENTRY)
    rest = cache / "code" / ".tmp-of-a-killed-process"
    rest.write_bytes(b"x" * 1000)
    os.utime(rest, (1.0, 1.0))
    monkeypatch.setattr(store, "MOST_BYTES", 500)
    store.write("two", ENTRY)
    assert sorted(p.name for p in (cache / "code").iterdir()) == ["one.o", "two.o"]


# What is kept


def test_the_folder_and_its_files_are_the_users_own(cache):
    before = os.umask(0)
    try:
        assert store.write("key", ENTRY)
    finally:
        os.umask(before)
    assert store.read("key") == ENTRY
    assert store.read("another") is None
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


def test_an_entry_on_a_disk_that_can_only_be_read_is_used(cache, monkeypatch):
    store.write("key", ENTRY)
    monkeypatch.setattr(store.os, "utime", fails(errno.EROFS))
    assert store.read("key") == ENTRY


# What cannot be trusted


def damaged(file, way):
    data = bytearray(file.read_bytes())
    if way == "cut short":
        file.write_bytes(data[: len(data) // 2])
    elif way == "empty":
        file.write_bytes(b"")
    elif way == "of another version":
        file.write_bytes(data.replace(store.MAGIC, store.MAGIC.replace(b"1", b"0"), 1))
    elif way == "for the group to write":
        file.chmod(0o620)
    elif way == "for all to write":
        file.chmod(0o602)
    elif way == "a link":
        other = file.with_name("elsewhere")
        file.rename(other)
        file.symlink_to(other)
    elif way == "a folder":
        file.unlink()
        file.mkdir()
    else:
        data[{"a bit of its code": -100, "a bit of its checksum": len(store.MAGIC) + 3}[way]] ^= 1
        file.write_bytes(data)


WAYS = ["cut short", "empty", "of another version", "for the group to write", "for all to write", "a link"]
WAYS += ["a bit of its code", "a bit of its checksum"]


@pytest.mark.parametrize("way", WAYS)
def test_an_entry_that_cannot_be_trusted_is_not_read_and_can_be_written_again(way, cache):
    entry = store.StoredCode({"size": 3}, bytes(range(256)))
    assert store.write("key", entry)
    damaged(cache / "code" / "key.o", way)
    assert store.read("key") is None
    assert store.write("key", entry)
    assert store.read("key") == entry
    assert store._is_own((cache / "code" / "key.o").lstat(), stat.S_ISREG)


def test_a_flight_whose_entry_is_damaged_has_it_made_anew_once(filled, right, monkeypatch):
    (file,) = check_entries(filled)
    damaged(file, "a bit of its code")
    made, compiled = [], machine.compiled
    monkeypatch.setattr(machine, "compiled", lambda *given: made.append(given) or compiled(*given))
    for _ in range(2):
        assert here() == right[0]
        assert len(made) == 1
    assert store.read(file.stem) is not None


def test_a_module_on_disk_that_cannot_be_trusted_is_traced_again(filled, right):
    (text,) = filled.glob("code/*-text.o")
    damaged(text, "a bit of its code")
    found = plan.FlightPlan(tl.load_mission("one-push", CHANGES)).loop_code.loop(1)
    found.optimise().join(PATIENCE)
    assert found.is_best
    assert here() == right[0]


def test_a_folder_in_the_place_of_an_entry_is_left_alone(filled, right):
    (file,) = check_entries(filled)
    damaged(file, "a folder")
    assert here() == right[0]
    assert file.is_dir()


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


@pytest.mark.parametrize("mode", [0o770, 0o702])
def test_a_folder_that_others_may_write_to_is_not_used(mode, filled):
    (filled / "code").chmod(mode)
    before = sorted((filled / "code").iterdir())
    assert store.folder() is None
    assert store.read(before[0].stem) is None
    assert not store.write("key", ENTRY)
    assert sorted((filled / "code").iterdir()) == before


@pytest.mark.parametrize("what", ["a file", "a link"])
def test_a_cache_that_is_no_folder_is_not_used(what, cache, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    cache.mkdir()
    (cache / "code").write_text("") if what == "a file" else (cache / "code").symlink_to(tmp_path / "elsewhere")
    assert store.folder() is None
    assert not store.write("key", ENTRY)
    assert not list(tmp_path.glob("elsewhere/*"))


# What cannot be written


def fails(number):
    def call(*args, **kwargs):
        raise OSError(number, os.strerror(number))

    return call


def break_at(where, number, broken):
    """Let a step of a write fail."""
    if where == "mkdir":
        broken.setattr(Path, "mkdir", fails(number))
    elif where == "mkstemp":
        broken.setattr(store.tempfile, "mkstemp", fails(number))
    elif where == "replace":
        broken.setattr(store.os, "replace", fails(number))
    else:
        broken.setattr(store, "open", lambda handle, mode: Full(handle, number), raising=False)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES])
@pytest.mark.parametrize("where", ["mkdir", "mkstemp", "replace", "write"])
def test_an_entry_that_cannot_be_written_leaves_nothing_behind(where, number, cache, monkeypatch):
    with monkeypatch.context() as broken:
        break_at(where, number, broken)
        assert not store.write("key", ENTRY)
    assert not list(cache.glob("code/*"))
    assert store.write("key", ENTRY)


def test_a_flight_flies_without_a_cache_and_heals_it(cache, right, monkeypatch):
    with monkeypatch.context() as broken:
        break_at("mkdir", errno.EACCES, broken)
        assert here() == right[0]
    assert not cache.exists()
    assert here() == right[0]
    assert len(check_entries(cache)) == 1


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


def test_a_full_disk_is_no_reason_not_to_optimise(cache, right, monkeypatch):
    monkeypatch.setattr(store.os, "replace", fails(errno.ENOSPC))
    found = plan.FlightPlan(tl.load_mission("one-push", CHANGES)).loop_code.loop(1)
    found.optimise().join(PATIENCE)
    assert found.is_best
    assert here() == right[0]
    assert list(cache.glob("code/*")) == []
