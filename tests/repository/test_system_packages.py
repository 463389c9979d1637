"""How scripts install packages of the system: one after the other, whoever else uses apt."""

import os
import subprocess

import pytest
from repository import ROOT

INSTALL = ROOT / "gazebo/install-packages"
APT = """#!/bin/sh
echo "$@" >> {log}
[ "$1" = install ] && exit 0
[ $(grep -c update {log}) -gt {busy} ] || {{ echo '{error}' >&2; exit 100; }}
"""


@pytest.fixture
def apt(tmp_path):
    """An apt-get that fails so many times with an error; what is then asked of it, and what is said."""

    def run(busy, error):
        log = tmp_path / "log"
        for name, text in {"apt-get": APT.format(log=log, busy=busy, error=error), "sleep": "#!/bin/sh\n"}.items():
            (tmp_path / name).write_text(text)
            (tmp_path / name).chmod(0o755)
        path = {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
        done = subprocess.run(
            [INSTALL, "one", "two"], env=os.environ | path, capture_output=True, text=True, check=False
        )
        return done, log.read_text().splitlines()

    return run


def test_packages_are_installed_when_another_one_has_finished(apt):
    done, asked = apt(3, "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)")
    assert done.returncode == 0, done.stderr
    assert [words.split()[0] for words in asked] == ["update"] * 4 + ["install"]
    assert "DPkg::Lock::Timeout=" in asked[-1]
    assert asked[-1].endswith("one two")
    assert done.stderr.splitlines() == ["Waiting for lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)"]


def test_another_error_ends_it_at_once_with_its_words(apt):
    done, asked = apt(3, "E: The repository is not signed")
    assert done.returncode == 100
    assert asked == ["update -qq"]
    assert "not signed" in done.stderr


def test_no_script_asks_apt_beside_it():
    scripts = [p for folder in ("tools", "gazebo", ".ci") for p in (ROOT / folder).iterdir() if p.is_file()]
    asking = [
        p.name for p in scripts if "apt-get install" in p.read_text("utf-8") or "apt-get update" in p.read_text("utf-8")
    ]
    assert asking == [INSTALL.name]
