"""The command line as a process of its own: pipes, signals and terminals."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

OURS = {"mission.toml", "flight.npz", "metrics.json", "report.html"}
SHORT = ("--no-figures", "--set", "mission.duration=0.5")


def process(*arguments: str, folder: Path, **environment: str) -> subprocess.CompletedProcess:
    """The command line as a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "tandemlift", *arguments],
        cwd=folder,
        capture_output=True,
        env={**os.environ, **environment},
        check=False,
    )


def test_the_template_goes_to_a_file_that_flies(tmp_path):
    template = process("template", folder=tmp_path)
    (tmp_path / "mine.toml").write_bytes(template.stdout)
    done = process("run", "mine.toml", *SHORT, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in (tmp_path / "out" / "my-mission").iterdir()} >= OURS


def test_a_terminal_of_ascii_shows_everything(tmp_path):
    for arguments in (
        ("template",),
        ("missions",),
        ("run", "hover", *SHORT),
        ("run", "hover", "--set", "mission.step=1"),
    ):
        done = process(*arguments, folder=tmp_path, PYTHONIOENCODING="ascii", LC_ALL="C", PYTHONUTF8="0")
        assert done.returncode == (2 if "mission.step=1" in arguments else 0)
        assert b"Traceback" not in done.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_ctrl_c_ends_a_flight_without_a_traceback_or_results(tmp_path):
    endless = ("--set", "mission.duration=900000", "--set", "mission.log_interval=10")
    command = [sys.executable, "-m", "tandemlift", "run", "hover", *endless]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as flying:
        deadline = time.monotonic() + 60.0
        while not (tmp_path / "out" / "hover").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(1.0)
        flying.send_signal(signal.SIGINT)
        out, err = flying.communicate(timeout=30)
    assert flying.returncode == 130
    assert b"Traceback" not in err
    assert b"stopped" in err
    assert out == b""
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
@pytest.mark.parametrize(
    "arguments", [("template",), ("missions",), ("--help",), ("run", "hover", *SHORT)], ids=" ".join
)
def test_a_reader_that_leaves_early_is_no_error(arguments, tmp_path):
    command = [sys.executable, "-m", "tandemlift", *arguments]
    reading, writing = os.pipe()
    os.close(reading)  # as if `head` had ended before the first line
    try:
        done = subprocess.run(command, cwd=tmp_path, stdout=writing, stderr=subprocess.PIPE, check=False)
    finally:
        os.close(writing)
    assert b"Traceback" not in done.stderr
    assert b"BrokenPipe" not in done.stderr
    if "run" in arguments:
        assert done.returncode == 0
        assert (tmp_path / "out" / "hover" / "metrics.json").exists()
