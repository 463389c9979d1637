"""What a command loads: nothing that it does not use."""

import os
import sys

import pytest
from patience import completed

RUN = """
import sys
sys.argv = ["tandemlift", "run", *sys.argv[1:]]
from tandemlift.__main__ import main
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
loaded = {name.partition(".")[0] for name in sys.modules} | {".".join(name.split(".")[:2]) for name in sys.modules}
of_interest = ("matplotlib", "PIL", "pydantic", "llvmlite", "tandemlift.parts", "tandemlift.missions")
print("loaded:", *[name for name in of_interest if name in loaded])
"""


def run(folder, *arguments):
    """The modules that `tandemlift run` loads, and the files that it writes."""
    command = [sys.executable, "-W", "error", "-c", RUN, *arguments, "--out", str(folder)]
    environment = os.environ | {"TANDEMLIFT_CACHE": str(folder.parent / "cache")}
    done = completed(command, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.rpartition("loaded: ")[2].split(), {p.name: p.read_bytes() for p in folder.iterdir()}


@pytest.mark.thorough
def test_a_run_without_figures_loads_no_drawing_library_and_a_known_one_no_tables_or_laws(tmp_path):
    arguments = ("hover", "--no-figures", "--set", "mission.duration=1.0")
    first, before = run(tmp_path / "first", *arguments)
    assert first == ["pydantic", "llvmlite", "tandemlift.parts", "tandemlift.missions"]
    second, after = run(tmp_path / "second", *arguments)
    assert second == ["llvmlite"]
    assert before.keys() == after.keys()
    same = {"mission.toml", "findings.json"}
    assert {name: after[name] for name in same} == {name: before[name] for name in same}
    pages = [files["report.html"].decode() for files in (before, after)]
    setup = [page.partition("<h2>Set-up</h2>")[2].partition("</section>")[0] for page in pages]
    assert setup[0] == setup[1] != ""
    assert "tandemlift run mission.toml" in pages[1]


@pytest.mark.thorough
def test_another_setting_is_not_the_known_flight(tmp_path):
    for i, seconds in enumerate(("1.0", "0.5", "1.0")):
        loaded, files = run(tmp_path / str(i), "hover", "--no-figures", "--set", f"mission.duration={seconds}")
        assert ("tandemlift.parts" in loaded) is (i < 2)
        assert f"duration = {seconds}" in files["mission.toml"].decode()
