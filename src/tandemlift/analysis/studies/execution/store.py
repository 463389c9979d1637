"""The folder of a study: its plan, and one Parquet file for each finished chunk, written atomically."""

from __future__ import annotations

import contextlib
import json
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tandemlift.analysis.studies.design.keys import leaves_of
from tandemlift.analysis.studies.design.plan import TRIAL_ROWS, StudyPlan
from tandemlift.analysis.studies.design.study_files import checked_settings
from tandemlift.analysis.studies.design.variants import variant_from
from tandemlift.analysis.studies.execution.checked_file import CheckedFile, DamagedFile
from tandemlift.analysis.studies.execution.chunk import chunk_names, sources_digest, study_digest
from tandemlift.analysis.studies.execution.columns import ALWAYS, INTEGERS, NOT_KEPT, Columns, write_columns
from tandemlift.core.errors import InputError, extra, shown, unknown
from tandemlift.core.files import __version__, write_file
from tandemlift.flight.channels import DERIVED
from tandemlift.missions import format_toml
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import channel_names, metric_names

LEFT_OVER = 3600.0  # s, after which a half-written file, or a claim, is abandoned


class ChunkFiles:
    """The files of chunks in a folder, by the chunks' names.

    Args:
        path: of the folder.
        about: the metadata of every file, beside its chunk and the version.
    """

    def __init__(self, path: Path, about: Mapping[str, str]) -> None:
        self.path, self._about = path, dict(about)

    def file(self, name: str) -> Path:
        """The path of a chunk's results, whether it exists or not."""
        return self.path / f"{name}.parquet"

    def is_flown(self, name: str) -> bool:
        """Whether a chunk has an intact file; a damaged one is replaced when the chunk is flown.

        Raises:
            InputError: there is a file that this process cannot read.
        """
        path = self.file(name)
        if not path.exists():
            return False
        try:
            CheckedFile(path).read()
        except (FileNotFoundError, DamagedFile):
            return False
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
        return True

    def claim(self, name: str) -> bool:
        """Claim a chunk; False if another process has claimed it, even if that was killed.

        Processes that share the folder treat each other's claims as advice: they fly other chunks first.

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
        """Withdraw the claim of a chunk."""
        with contextlib.suppress(OSError):
            self._claim_file(name).unlink()

    def _claim_file(self, name: str) -> Path:
        return self.path / f".{name}.claim"

    def write(self, name: str, columns: Columns) -> None:
        """Write the results of a chunk atomically.

        Raises:
            InputError: the file cannot be written.
        """
        write_columns(columns, self.file(name), {**self._about, "version": __version__})

    def clean(self) -> None:
        """Remove the half-written files and the claims of processes that were killed."""
        for path in self.path.glob(".*"):
            with contextlib.suppress(OSError):
                if time.time() - path.stat().st_mtime > LEFT_OVER:
                    path.unlink()


STUDY, PLAN, CHUNKS = "study.toml", "study.json", "chunks"
FORMAT = 3


class StudyFolder:
    """The folder of a study.

    Args:
        path: of the folder.

    Attributes:
        digest: of the study.
        count: number of rows.
        rows_per_chunk: rows of each chunk but the last.
        sources: digest of the sources that fly it.
        files: those of its chunks.

    Raises:
        InputError: the folder holds no study.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._said = _plan_in(path)
        self.digest, self.sources = self._said["digest"], self._said["sources"]
        self.count, self.rows_per_chunk = self._said["rows"], self._said["rows_per_chunk"]
        self.files = ChunkFiles(path / CHUNKS, {"study": self.digest, "sources": self.sources})

    def plan(self) -> StudyPlan:
        """The plan, from the folder alone."""
        variants = [variant_from(said) for said in self._said["variants"]]
        return StudyPlan(checked_settings(self._said["settings"], str(self.path / PLAN)), variants)

    def names(self) -> list[str]:
        """The names of all chunks, in order."""
        return list(chunk_names(self.digest, self.count, self.rows_per_chunk))


def open_folder(plan: StudyPlan, path: Path) -> StudyFolder:
    """The folder of a study, made if it is not there.

    Raises:
        InputError: a kept metric or channel does not exist, or the folder holds another study or cannot be written to.
    """
    check_names(plan)
    contents = _contents(plan)
    if (path / PLAN).exists():
        folder = StudyFolder(path)
        if folder.digest != contents["digest"]:
            if name := _changed_file(folder, plan):
                said = f"{path} was flown with another version of {name}"
                raise InputError(f"{said}: choose another --out, or remove the folder to fly it anew")
            raise InputError(f"{path} holds another study: {_difference(folder, plan)}; choose another --out")
        folder.files.clean()
        return folder
    _make(path, contents)
    return StudyFolder(path)


def _contents(plan: StudyPlan) -> dict[str, Any]:
    """The content of a plan's file; the study's digest is that of all other content."""
    contents = {
        "format": FORMAT,
        "sources": sources_digest(),
        "rows": plan.count,
        "rows_per_chunk": plan.rows_per_chunk,
        "varied": plan.varied,
        "settings": plan.settings.model_dump(mode="json", exclude_none=True),
        "variants": [variant._asdict() for variant in plan.variants],
    }
    return {**contents, "digest": study_digest(contents)}


def _make(path: Path, contents: dict[str, Any]) -> None:
    text = format_toml(contents["settings"])
    try:
        if (path / STUDY).exists() and (path / STUDY).read_text("utf-8", "replace") != text:
            raise InputError(f"--out {path}: would replace {path / STUDY}: choose another --out, or move it")
        (path / CHUNKS).mkdir(parents=True, exist_ok=True)
        write_file(path / STUDY, text)
        write_file(path / PLAN, json.dumps(contents) + "\n")  # last: with it, the folder is a study's
    except OSError as error:
        raise InputError(f"--out {path}: cannot be made or written to: {error.strerror or error}") from None


def is_study(path: Path) -> bool:
    """Whether a folder is that of a study, even if it is damaged."""
    return (path / PLAN).is_file() or (path / STUDY).is_file()


def _plan_in(path: Path) -> dict[str, Any]:
    try:
        said: dict[str, Any] = json.loads((path / PLAN).read_text("utf-8"))
        made_by, digest = said["format"], said["digest"]
    except FileNotFoundError:
        raise InputError(f"{path} is not the folder of a study: it has no {PLAN}") from None
    except OSError as error:
        raise InputError(f"{path / PLAN}: {error.strerror or error}") from None
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(f"{path / PLAN} is not the plan of a study") from None
    if made_by != FORMAT:
        raise InputError(f"{path}: the study was made by another version of tandemlift; fly it again")
    if digest != study_digest(said):
        again = "Remove this file and start the study again: finished rows are kept"
        raise InputError(f"{path / PLAN} is damaged, or was edited: it does not fit its digest. {again}")
    return said


def _changed_file(folder: StudyFolder, plan: StudyPlan) -> str:
    """The controller's file or recording that alone has changed since a study was flown; "" if there is none."""
    there = [variant_from(said) for said in folder._said["variants"]]
    settings = plan.settings.model_dump(mode="json", exclude_none=True)
    if (folder._said["settings"], folder.sources, len(there)) != (settings, sources_digest(), len(plan.variants)):
        return ""
    for flown, here in zip(there, plan.variants, strict=True):
        for old, new in (*zip(flown.plugins, here.plugins, strict=False), (flown.recording, here.recording)):
            if old != new and old[:1] == new[:1]:
                return str(new[0])
    return ""


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


def check_names(plan: StudyPlan, reported: Iterable[str] = ()) -> None:
    """Check, before anything flies, each name in `[keep]`, and those of a report, such as `position_rmse_m.0`.

    Raises:
        InputError: no flight has it; the message lists the existing ones. Or what writes tables is not installed.
    """
    with extra("study", "a study"):
        import pyarrow  # noqa: F401
    keep, stems = plan.settings.keep, [name.partition(".")[0] for name in reported]
    if not keep.metrics and not keep.channels and not stems:
        return
    flights = list(_samples(plan))
    metrics = [name for name in _together(map(metric_names, flights)) if name not in NOT_KEPT]
    _check("metric of keep.metrics", keep.metrics, metrics)
    _check("metric of --for", stems, [name for name in keep.metrics or metrics if name not in (*ALWAYS, *INTEGERS)])
    if keep.channels:
        _check("channel of keep.channels", keep.channels, [*_together(map(channel_names, flights)), *DERIVED])


def _check(what: str, chosen: Iterable[str], known: Sequence[str]) -> None:
    for name in chosen:
        if name not in known:
            raise unknown(what, name, known)


def _together(names: Iterable[Sequence[str]]) -> list[str]:
    return list(dict.fromkeys(name for some in names for name in some))


def _samples(plan: StudyPlan) -> Iterator[FlightPlan]:
    """A flight of each variant and case that is not refused."""
    cells = len(plan.variants) * len(plan.cases)
    each = plan.count // cells
    templates = [variant.template() for variant in plan.variants]
    for cell in range(cells):
        for row in plan.rows(cell * each, cell * each + min(TRIAL_ROWS, each)):
            try:
                yield FlightPlan(templates[row.variant].mission(row.changes), in_block=True)
            except InputError:
                continue
            break
