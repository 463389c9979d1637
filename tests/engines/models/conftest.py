"""Missions written as worlds and as MuJoCo models, and read back by the libraries that they are for."""

from types import SimpleNamespace

import pytest
from modelled import loaded
from patience import completed
from repository import SUPPORT

from tandemlift.apps.export.write import export


@pytest.fixture(scope="module")
def reader(program, tmp_path_factory):
    """What libsdformat reads of a world, which is strict: what it does not know, or warns of, is an error."""
    compiler = program("g++")
    package = completed([program("pkg-config"), "--cflags", "--libs", "sdformat12"], capture_output=True, text=True)
    if package.returncode:
        pytest.skip("libsdformat-dev 12 is not installed")
    made, source = tmp_path_factory.mktemp("reader") / "reader", SUPPORT / "sdf_reader.cpp"
    completed([compiler, "-std=c++17", str(source), "-o", str(made), *package.stdout.split()], check=True)

    def read(path):
        done = completed([str(made), str(path)], capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        return [line.split() for line in done.stdout.splitlines()]

    return read


@pytest.fixture(scope="module")
def world(reader, tmp_path_factory):
    """What is in a mission's world: what there is by (kind, names) → words, poses apart."""
    folder, known = tmp_path_factory.mktemp("worlds"), {}

    def read(name):
        if name not in known:
            mission, vehicle = loaded(name)
            path = export(mission, folder / f"{name}.sdf")
            known[name] = SimpleNamespace(mission=mission, vehicle=vehicle, path=path, lines=reader(path))
        return known[name]

    return read


@pytest.fixture(scope="module")
def mujoco():
    return pytest.importorskip("mujoco")


@pytest.fixture(scope="module")
def model_of(mujoco, tmp_path_factory):
    """A mission's file, read by MuJoCo."""
    folder = tmp_path_factory.mktemp("models")

    def read(mission):
        return mujoco.MjModel.from_xml_path(str(export(mission, folder / "model.xml")))

    return read
