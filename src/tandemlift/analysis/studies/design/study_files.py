"""Study files: from TOML, or from tables, to a plan; every error names the key, the value and the allowed values."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tandemlift.analysis.studies.design.plan import StudyPlan
from tandemlift.analysis.studies.design.settings import StudySettings
from tandemlift.analysis.studies.design.variants import variants_of
from tandemlift.core.errors import InputError
from tandemlift.core.files import toml_tables
from tandemlift.missions.changes import changed_tables
from tandemlift.missions.loading import MAX_FILE
from tandemlift.missions.refusals import problems_in


def load_plan(study: str | os.PathLike[str] | Mapping[str, Any], changes: Mapping[str, Any] | None = None) -> StudyPlan:
    """The plan of a study.

    Args:
        study: path of a study file, or its tables.
        changes: values of the study's keys by dotted key, such as {"study.draws": 1000}.

    Raises:
        InputError: the file cannot be read, or is not a study that can be flown.
    """
    if isinstance(study, Mapping):
        source, folder, tables = "study", Path(), dict(study)
    else:
        source, folder, tables = str(study), Path(study).parent, _read(Path(study))
    for key, value in (changes or {}).items():
        tables = changed_tables(tables, key, value, source)
    settings = checked_settings(tables, source)
    try:
        plan = StudyPlan(settings, variants_of(settings.study, folder))
        plan.check()
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    return plan


def checked_settings(tables: dict[str, Any], source: str) -> StudySettings:
    """The settings of a study from nested tables; `source` names them in messages.

    Raises:
        InputError: something is missing, unknown, of the wrong type or out of range.
    """
    try:
        return StudySettings.model_validate(tables)
    except ValidationError as error:
        problems = problems_in(StudySettings, error, tables, whole="a study")
        raise InputError("\n".join(f"{source}: {problem.sentence}" for problem in problems[:8])) from None


def _read(path: Path) -> dict[str, Any]:
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a study file")
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE + 1)
        if len(content) > MAX_FILE:
            raise InputError(f"larger than {MAX_FILE} bytes, the most that a study file may have")
        return toml_tables(content.decode("utf-8-sig").replace("\r\n", "\n"))
    except FileNotFoundError:
        raise InputError(f"study file {path} does not exist; `tandemlift study --template` prints one") from None
    except OSError as error:
        raise InputError(f"study file {path}: {error.strerror or error}") from None
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    except RecursionError:
        raise InputError(f"{path} is not a study: nested too deeply") from None
    except ValueError as error:
        raise InputError(f"{path} is not valid TOML: {error}") from None


TEMPLATE = """\
# A study of tandemlift: many flights in one table. `tandemlift study FILE.toml` flies it, `--dry-run` counts it first.
# Rows are: missions x controllers x engines x cases x grid points x draws x seeds. Omitted keys have their defaults.
# Only [study] with name and missions is required. docs/reference/studies.md explains every table.

[study]
name = "gusts"                  # its folder is out/NAME
missions = ["iris"]             # built-in names, or paths from the folder of this file
controllers = []                # names, or .py files from the folder of this file; empty: each mission's own
engines = ["compiled"]          # see `tandemlift engines`
draws = 40                      # points of [draw]; the same for each grid point, case, controller and mission
sampling = "random"             # random, sobol or latin-hypercube
persons = "own"                 # own, or random: gains, arm, speed, lag of the mission's person x 0.7 to 1.3,
                                # delay 0.1 to 0.3 s, tremor up to 0.1 N, any grip, a wind of up to 1 N
seeds = 1                       # flights of each point, with different noise, wind and tremor (mission.seed)
seed = 0                        # of the points, and first mission.seed

[set]                           # the same in every flight; any key of a mission, as in `tandemlift run --set`
wind.model = "air"

[[cases]]                       # named sets of changes; every case is flown with all points
name = "as it is"

[[cases]]
name = "slow rotors"
set.actuators.delay = 0.03

[grid]                          # keys that take each of some values; all combinations are flown
plant.mass_scale = [0.95, 1.0, 1.05]
# admittance.damping = {low = 2.0, high = 8.0, count = 7}                   # evenly spaced; spacing = "log"

[draw]                          # keys that are drawn at random; relative = true multiplies the mission's own value
wind.velocity = {distribution = "horizontal", low = 0.0, high = 4.0}        # [x, y, 0] of any direction
wind.turbulence = {distribution = "log-uniform", low = 0.5, high = 4.0}
plant.inertia_scale = {distribution = "uniform", low = 0.9, high = 1.1, count = 3}  # a list of 3 values
# initial.position = {distribution = "normal", mean = 0.0, deviation = 0.05, low = -0.2, high = 0.2, count = 3}
# person.delay = {distribution = "uniform", low = 0.1, high = 0.3, step = 0.02}      # multiples of step only
# pushes.0.force.0 = {distribution = "choice", among = [1.0, 2.0, 4.0]}
# mission.seed = {distribution = "integer", low = 0, high = 999}

[keep]                          # data of each flight that goes into the table
metrics = []                    # names in metrics.json; empty: all
channels = []                   # channels of some flights, such as ["position", "push_estimate"]:
rows = []                       #   of these rows,
outcomes = ["crashed"]          #   of rows with these outcomes,
every = 100                     #   and of one row in so many
"""
