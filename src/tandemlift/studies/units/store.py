"""The folder of a study: what it flies, and one Parquet file for each unit that was flown."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tandemlift.common.errors import InputError
from tandemlift.common.extras import extra
from tandemlift.common.files import atomic_write
from tandemlift.missions import format_toml
from tandemlift.missions.values import shown
from tandemlift.studies.design.keys import leaves_of
from tandemlift.studies.design.plan import StudyPlan
from tandemlift.studies.design.study_files import checked_settings
from tandemlift.studies.design.variants import variant_from
from tandemlift.studies.units.columns import Columns, write_columns
from tandemlift.studies.units.unit import sources_digest, study_digest, unit_names

STUDY, PLAN, UNITS = "study.toml", "study.json", "units"
FORMAT = 1
LEFT_OVER = 3600.0  # s, after which a half-written file, or a claim, is nobody's


class StudyFolder:
    """The folder of a study.

    Args:
        path: of the folder.

    Attributes:
        digest: of the study.
        count: number of rows.
        rows_per_unit: rows of each unit but the last.
        sources: digest of the sources that fly it.

    Raises:
        InputError: the folder holds no study.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._said = _plan_in(path)
        self.digest, self.sources = self._said["digest"], self._said["sources"]
        self.count, self.rows_per_unit = self._said["rows"], self._said["rows_per_unit"]

    def plan(self) -> StudyPlan:
        """The plan, from what the folder holds alone."""
        variants = [variant_from(said) for said in self._said["variants"]]
        return StudyPlan(checked_settings(self._said["settings"], str(self.path / PLAN)), variants)

    def names(self) -> list[str]:
        """The names of all units, in order."""
        return list(unit_names(self.digest, self.count, self.rows_per_unit))

    def file(self, name: str) -> Path:
        """The file of a unit's results, be it there or not."""
        return self.path / UNITS / f"{name}.parquet"

    def is_flown(self, name: str) -> bool:
        """Whether a unit's file is there, and whole; one that was cut short is written anew when the unit is flown.

        Raises:
            InputError: there is a file that this process cannot read.
        """
        path = self.file(name)
        if not path.exists():
            return False
        with extra("study", "a study"):
            from pyarrow import parquet
        try:
            parquet.read_metadata(path)
        except FileNotFoundError:
            return False
        except (OSError, ValueError) as error:  # one without a number says that it is no Parquet file
            if getattr(error, "errno", None) is not None:
                raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', error)}") from None
            return False
        return True

    def claim(self, name: str) -> bool:
        """Say that a unit is flown here; False if a process says so already, or said so and was killed.

        Processes that share the folder take each other's claims as advice: they fly other units first.

        Raises:
            InputError: the folder cannot be written to.
        """
        try:
            self._claim_file(name).touch(exist_ok=False)
        except FileExistsError:
            return False
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written to: {error.strerror or error}") from None
        return True

    def release(self, name: str) -> None:
        """Take back that a unit is flown here."""
        with contextlib.suppress(OSError):
            self._claim_file(name).unlink()

    def _claim_file(self, name: str) -> Path:
        return self.path / UNITS / f".{name}.claim"

    def flown(self) -> Iterator[tuple[str, Path]]:
        """The units whose files are there, in order: names and files."""
        for name in self.names():
            if self.is_flown(name):
                yield name, self.file(name)

    def write(self, name: str, columns: Columns) -> None:
        """Write the results of a unit, whole or not at all.

        Raises:
            InputError: the file cannot be written.
        """
        from tandemlift.common.version import __version__

        about = {"study": self.digest, "unit": name, "sources": self.sources, "version": __version__}
        write_columns(columns, self.file(name), about)

    def clean(self) -> None:
        """Remove the half-written files and the claims of processes that were killed."""
        for path in (self.path / UNITS).glob(".*"):
            with contextlib.suppress(OSError):
                if time.time() - path.stat().st_mtime > LEFT_OVER:
                    path.unlink()


def open_folder(plan: StudyPlan, path: Path) -> StudyFolder:
    """The folder of a study, made if it is not there.

    Raises:
        InputError: the folder holds another study, or cannot be made or written to.
    """
    with extra("study", "a study"):  # before anything flies
        import pyarrow  # noqa: F401
    digest = study_digest(plan)
    if (path / PLAN).exists():
        folder = StudyFolder(path)
        if folder.digest != digest:
            raise InputError(f"{path} holds another study: {_difference(folder, plan)}; choose another --out")
        folder.clean()
        return folder
    _make(path, plan, digest)
    return StudyFolder(path)


def _make(path: Path, plan: StudyPlan, digest: str) -> None:
    settings = plan.settings.model_dump(mode="json", exclude_none=True)
    said = {
        "format": FORMAT,
        "digest": digest,
        "sources": sources_digest(),
        "rows": plan.count,
        "rows_per_unit": plan.rows_per_unit,
        "varied": plan.varied,
        "settings": settings,
        "variants": [variant._asdict() for variant in plan.variants],
    }
    try:
        (path / UNITS).mkdir(parents=True, exist_ok=True)
        with atomic_write(path / STUDY) as partial:
            partial.write_text(format_toml(settings), "utf-8")
        with atomic_write(path / PLAN) as partial:  # last: with it, the folder is a study's
            partial.write_text(json.dumps(said) + "\n", "utf-8")
    except OSError as error:
        raise InputError(f"--out {path}: cannot be made or written to: {error.strerror or error}") from None


def _plan_in(path: Path) -> dict[str, Any]:
    try:
        said: dict[str, Any] = json.loads((path / PLAN).read_text("utf-8"))
        if said["format"] != FORMAT:
            raise InputError(f"{path}: the study was made by another version of tandemlift; fly it again")
        return said
    except FileNotFoundError:
        raise InputError(f"{path} is not the folder of a study: it has no {PLAN}") from None
    except OSError as error:
        raise InputError(f"{path / PLAN}: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError):
        raise InputError(f"{path / PLAN} is not the plan of a study") from None


def _difference(folder: StudyFolder, plan: StudyPlan) -> str:
    """The first difference of the study in a folder from another one."""
    there, here = folder._said["settings"], plan.settings.model_dump(mode="json", exclude_none=True)
    sides = [dict(leaves_of(side, lambda _: False)) for side in (there, here)]
    for place in {**sides[0], **sides[1]}:
        if sides[0].get(place) != sides[1].get(place):
            values = ["none" if place not in side else shown(side[place]) for side in sides]
            return f"its {'.'.join(map(str, place))} is {values[0]}, here it is {values[1]}"
    if folder.sources != sources_digest():
        return f"it was flown by sources with digest {folder.sources}, these have {sources_digest()}"
    return "its missions differ from those that their files say now"
