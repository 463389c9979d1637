"""The map of the nucleus has the files that a step calls, in its order, as another profiler sees them."""

import cProfile
import pstats
from pathlib import Path

from reference_tables import nucleus
from repository import ROOT

import tandemlift as tl
from tandemlift.simulation.graphs import TracedStep, templates_from
from tandemlift.simulation.plan import FlightPlan

PACKAGE = Path(tl.__file__).parent


def test_the_map_has_the_files_of_the_package_that_a_profiler_sees_in_a_step():
    plan = FlightPlan(tl.load_mission("paper"))
    templates = templates_from(plan.model, plan.given)
    with cProfile.Profile() as profile:
        TracedStep(templates)
    called = {Path(file) for file, _, _ in pstats.Stats(profile).stats if file.startswith(f"{PACKAGE}/")}
    files = {path.relative_to(PACKAGE).as_posix() for path in called}
    laws = {file for file in files if not file.startswith(nucleus.COMPILER)}
    assert laws == set(nucleus.step_of("paper"))


def test_the_map_follows_a_push_from_guidance_to_the_log():
    files = list(nucleus.step_of("paper"))
    way = [
        "simulation/loop/step.py",
        "parts/pilot/pilot.py",
        "parts/guidance/admittance.py",
        "parts/controllers/nftsmc.py",
    ]
    way += ["parts/rotors/allocation.py", "engines/compiled.py", "simulation/loop/log_sample.py"]
    assert [file for file in files if file in way] == way


def test_the_map_gives_each_file_the_labels_of_the_functions_that_are_called_and_no_others():
    rows = [line.split("|")[1:4] for line in nucleus.paper_step().splitlines()[2:]]
    labels = {file.strip().strip("`"): said.strip() for file, _, said in rows}
    assert labels["parts/mechanics/rigid_body.py"] == "`trans_rot_sys_equ`"
    assert labels["parts/controllers/sliding_surface.py"] == "`sliding_surface_equ`, `u_hat_equ`, `control_final1_equ`"
    assert "lyap_fun_equ" in (PACKAGE / "parts/controllers/sliding_surface.py").read_text("utf-8")  # no law of a step
    lines = {file.strip().strip("`"): count.split() for file, count, _ in rows}
    assert all(
        int(whole) == len((PACKAGE / file).read_text("utf-8").splitlines()) for file, (_, _, whole) in lines.items()
    )
    assert all(0 < int(called) <= int(whole) for called, _, whole in lines.values())


def test_the_page_of_the_map_is_linked_from_the_architecture():
    assert "(nucleus.md)" in (ROOT / "docs/explanation/architecture.md").read_text("utf-8")
