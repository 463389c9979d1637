"""FMUs of a mission: its pilot, its vehicle and its whole flight for importers of FMI 2.0 and 3.0.

An FMU is a ZIP file with a description, sources of C and libraries. The same mission gives the same bytes, apart from
those of the compiler.
"""

from __future__ import annotations

import hashlib
import io
import tempfile
import uuid
import zipfile
from collections.abc import Sequence
from pathlib import Path

from tandemlift.codegen.fmu_binaries import HOST, chosen_platforms, libraries
from tandemlift.codegen.fmu_description import build_description, model_description, sources
from tandemlift.codegen.fmu_sources import FmuPart, flight_part, pilot_part
from tandemlift.core.errors import InputError
from tandemlift.core.files import write_files
from tandemlift.missions import Mission
from tandemlift.simulation.graphs import portable_mission

VERSIONS = (2, 3)
FILE_TIME = (1980, 1, 1, 0, 0, 0)  # the time of all files in an FMU: the first that ZIP has
MARK = "/*@TOKEN@*/"


def write_fmus(
    mission: Mission, folder: Path | str, fmi: int = VERSIONS[0], platforms: Sequence[str] = (HOST,)
) -> list[Path]:
    """Write the FMUs of a mission, for co-simulation: NAME_pilot.fmu, NAME_vehicle.fmu, NAME_flight.fmu.

    The flight has the bits of a native flight with `mission.fma = false`.

    Args:
        mission: from `load_mission`.
        folder: made if it does not exist.
        fmi: version of FMI, 2 or 3.
        platforms: names in `PLATFORMS`, "host" for this machine, or "none" for sources alone.

    Returns:
        The files.

    Raises:
        InputError: a platform or the version is unknown, there is no compiler, the mission's controller is plain
            Python, or the mission changes while it is flown.
    """
    if fmi not in VERSIONS:
        raise InputError(f"fmi = {fmi}: must be {' or '.join(map(str, VERSIONS))}")
    wanted, mission = chosen_platforms(platforms), portable_mission(mission)
    parts = [pilot_part(mission), *(flight_part(mission, part) for part in ("vehicle", "flight"))]
    return write_files(Path(folder), {f"{part.identifier}.fmu": fmu_of(part, fmi, wanted) for part in parts})


def fmu_of(part: FmuPart, fmi: int, platforms: Sequence[str]) -> bytes:
    """The FMU of a part."""
    token = token_of(part)
    texts = {name: text.replace(MARK, token) for name, text in part.texts.items()}
    content = {"modelDescription.xml": model_description(part, fmi, token)}
    content |= {f"sources/{name}": text.encode() for name, text in texts.items()}
    if fmi == 3:
        content["sources/buildDescription.xml"] = build_description(part)
    with tempfile.TemporaryDirectory() as work:
        write_files(Path(work), texts)
        files = [Path(work) / name for name in sources(part)]
        for name in platforms:
            content |= libraries(files, part.identifier, name, fmi, Path(work))
    with zipfile.ZipFile(packed := io.BytesIO(), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(zipfile.ZipInfo(name, FILE_TIME), data, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def token_of(part: FmuPart) -> str:
    """What the descriptions of a part and its sources have in common, as a GUID."""
    digest = hashlib.sha256(model_description(part, VERSIONS[-1], ""))
    for name, text in sorted(part.texts.items()):
        digest.update(f"{name}\n{text}\n".encode())
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"
