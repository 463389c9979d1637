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
from tandemlift.core.files import DATA, toml_tables
from tandemlift.missions import MAX_FILE, changed_tables, problems_in


def template() -> str:
    """A study file with every table, and comments."""
    return (DATA / "study.toml").read_text("utf-8")


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
        plan = StudyPlan(settings, variants_of(settings, folder))
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
