"""The command line as a process of its own: pipes, signals and terminals."""

import os
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from patience import COMPILING, PATIENCE, completed

OURS = {"mission.toml", "flight.npz", "metrics.json", "findings.json", "report.html"}
SHORT = ("--no-figures", "--set", "mission.duration=0.5")


def process(*arguments: str, folder: Path, **environment: str) -> subprocess.CompletedProcess:
    """The command line as a process of its own."""
    return completed(
        [sys.executable, "-m", "tandemlift", *arguments],
        cwd=folder,
        capture_output=True,
        env={**os.environ, **environment},
        check=False,
    )


@pytest.mark.thorough
def test_in_a_terminal_of_ascii_the_template_goes_to_a_file_that_flies_and_an_error_is_shown(tmp_path):
    ascii_only = {"folder": tmp_path, "PYTHONIOENCODING": "ascii", "LC_ALL": "C", "PYTHONUTF8": "0"}
    template = process("template", **ascii_only)
    (tmp_path / "mine.toml").write_bytes(template.stdout)
    done = process("run", "mine.toml", *SHORT, **ascii_only)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in (tmp_path / "out" / "my-mission").iterdir()} >= OURS
    refused = process("run", "hover", "--set", "mission.step=1", **ascii_only)
    assert refused.returncode == 2
    assert b"must be a number > 0" in refused.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_full_standard_output_is_named(tmp_path):
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tandemlift", "explain", "admittance.mass"]
        done = completed(command, cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, check=False)
    assert (done.returncode, done.stderr) == (2, b"error: standard output: No space left on device\n")


def told(terminal: int, pattern: bytes) -> bytes:
    """What a process tells a terminal, until a pattern is in it."""
    text, end = b"", time.monotonic() + COMPILING
    while not re.search(pattern, text, re.DOTALL):
        if not select.select([terminal], [], [], max(0.0, end - time.monotonic()))[0]:
            raise TimeoutError(f"after {text!r} it is silent")
        text += os.read(terminal, 4096)  # an OSError, if it has ended
    return text


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_ctrl_c_ends_a_flight_without_a_traceback_or_results(tmp_path):
    endless = ("--set", "mission.duration=900000", "--set", "mission.log_interval=10")
    command = [sys.executable, "-m", "tandemlift", "run", "hover", *endless]
    reading, writing = os.openpty()  # a terminal, on which it shows how far it is
    flying = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=writing)
    os.close(writing)
    try:
        err = told(reading, rb"Flying.*\d\d:\d\d")  # how long it will take is known once some of it is flown
        assert (tmp_path / "out" / "hover").exists()
        flying.send_signal(signal.SIGINT)
        err += told(reading, b"stopped")
        out, _ = flying.communicate(timeout=PATIENCE)
    finally:
        os.close(reading)
        flying.kill()
    assert flying.returncode == 130
    assert b"Traceback" not in err
    assert out == b""
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
@pytest.mark.parametrize("arguments", [("--help",), ("run", "hover", *SHORT)], ids=" ".join)
def test_a_reader_that_leaves_early_is_no_error(arguments, tmp_path):
    command = [sys.executable, "-m", "tandemlift", *arguments]
    reading, writing = os.pipe()
    os.close(reading)  # as if `head` had ended before the first line
    try:
        done = completed(command, cwd=tmp_path, stdout=writing, stderr=subprocess.PIPE, check=False)
    finally:
        os.close(writing)
    assert b"Traceback" not in done.stderr
    assert b"BrokenPipe" not in done.stderr
    if "run" in arguments:
        assert done.returncode == 0
        assert (tmp_path / "out" / "hover" / "metrics.json").exists()
