"""A study from its file to its folder."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study, part_from
from tandemlift.analysis.studies.execution.store import StudyFolder, open_folder
from tandemlift.analysis.studies.execution.workers import executor_of
from tandemlift.analysis.studies.table import Study, load_study
from tandemlift.core.errors import InputError
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress
from tandemlift.missions import Mission


def study(
    study: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str] | None = None,
    *,
    threads: int | None = None,
    processes: int | None = None,
    executor: Executor | None = None,
    part: str = "1/1",
    progress: Progress | None = None,
) -> Study:
    """Fly a study; what its folder already holds is not flown again.

    Args:
        study: path of a study file, or its tables.
        out: folder of the study; by default out/NAME.
        threads: number of threads; by default one for each processor.
        processes: number of processes in place of threads; a script that asks for them has its own statements under
            `if __name__ == "__main__":`, as each of them imports it.
        executor: flies the chunks in place of threads of this process; `threads` is then the number of its workers.
        part: "K/N" to fly part K of N only; the parts may run at the same time, on machines that share the folder.
        progress: called with (rows flown, rows in all); by default, a notebook shows a bar.

    Returns:
        The study, with its table and the mission of each row.

    Raises:
        InputError: processes are given beside threads or an executor, the study cannot be flown, the folder is that of
            another study, or it cannot be written to.
    """
    with executor_of(threads, processes, executor) as workers:
        plan = load_plan(study)
        folder = open_folder(plan, Path("out") / plan.settings.study.name if out is None else Path(out))
        chosen, count = part_from(part), processes or threads
        with progress_or_own(plan.settings.study.name, progress) as shown:
            fly_study(plan, folder, threads=count, executor=workers, part=chosen, progress=shown, say=print)
    return load_study(folder.path)


def mission_of_row(folder: Path, number: int, changes: Mapping[str, Any] | None = None) -> tuple[Mission, str, str]:
    """The mission of a row of a study, to be flown alone.

    Args:
        folder: of the study.
        number: of the row, from 0.
        changes: further changes of the mission, by dotted key.

    Returns:
        The mission, the name of its engine, and a name for its results.

    Raises:
        InputError: there is no such study or row, or the row is refused.
    """
    plan = StudyFolder(folder).plan()
    if not 0 <= number < plan.count:
        raise InputError(f"row {number}: the study in {folder} has rows 0 to {plan.count - 1}")
    row = plan.rows(number, number + 1)[0]
    variant = plan.variants[row.variant]
    try:
        mission = variant.template().mission({**row.changes, **(changes or {})})
    except InputError as error:
        raise InputError(f"row {number} of {folder} is refused: {error}") from None
    return mission, variant.engine, f"{plan.settings.study.name}-row-{number}"
