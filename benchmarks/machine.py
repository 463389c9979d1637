"""The machine of a benchmark and the output of its results: versions, processor pinning, Markdown tables."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

NO_RESULT = "–"


def processors() -> list[int]:
    """Numbers of the processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return sorted(os.sched_getaffinity(0))
    return list(range(os.cpu_count() or 1))


def pin(count: int) -> None:
    """Keep this process, and every thread and process that it starts from now on, on its first `count` processors."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, set(processors()[:count]))


def _processor_name() -> str:
    """Its name, with family and model, because virtual machines shorten the name."""
    pairs = [line.partition(":")[::2] for line in Path("/proc/cpuinfo").read_text().splitlines()]
    about = {key.strip(): value.strip() for key, value in reversed(pairs)}
    if "model name" not in about:
        return platform.processor() or platform.machine()
    numbers = [f"{key.removeprefix('cpu ')} {about[key]}" for key in ("cpu family", "model") if key in about]
    return about["model name"] + (f" ({', '.join(numbers)})" if numbers else "")


def _processor() -> str:
    try:
        return _processor_name()
    except OSError:
        return platform.processor() or platform.machine()


def version(package: str) -> str | None:
    """Version of an installed package, or None."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def describe(packages: Iterable[str]) -> dict[str, Any]:
    """The machine, the system, and the versions of the measured software."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "processor": _processor(),
        "cores": len(processors()),
        "load_at_start": load,
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "python": platform.python_version(),
        "versions": {p: v for p in packages if (v := version(p))},
    }


def heading(about: dict[str, Any]) -> str:
    """One paragraph on the machine; a load well above 0 means that something else was running."""
    versions = ", ".join(f"{name} {v}" for name, v in about["versions"].items())
    load = "" if about["load_at_start"] is None else f", load at the start {about['load_at_start']:.2f}"
    machine = f"{about['processor']}, {about['cores']} cores{load}"
    return f"{machine} · {about['system']} · Python {about['python']} · {versions} · {about['date']}"


def table(header: Sequence[str], rows: Iterable[Sequence[str]], texts: int = 1) -> str:
    """A Markdown table; the first `texts` columns are text, the others are numbers."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * texts + "---:|" * (len(header) - texts)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def number(value: float | None, digits: int = 3) -> str:
    """A value to so many significant digits, with thousands separated; a dash if there is none."""
    if value is None:
        return NO_RESULT
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.0f}" if abs(rounded) >= 10 ** (digits - 1) else f"{rounded:,.{digits}g}"


def save(path: str | None, results: dict[str, Any]) -> None:
    """Write the results as JSON, if a path is given."""
    if path:
        Path(path).write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n", "utf-8")
