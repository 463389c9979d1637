"""Text of a new mission file: a beam on two quadrotors of a model, with forces and moments that suit their weight.

It has the times, speeds and accelerations of `iris`. So its forces are those of `iris` times the ratio of the masses,
its moments those of `iris` times the ratio of the inertias about the same axis, torques at joints those times mass and
length.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, unknown, written
from tandemlift.core.files import DATA, toml_tables
from tandemlift.missions import Mission, VehicleTable, idle_keys, load_mission, tables_of, value_at
from tandemlift.missions.key_descriptions import sections

FOLDER = DATA / "quadrotors"
MOUNT = 1.5  # height of the quadrotors' centres above the beam's axis, by its radius, as in the paper
PUSHES = ((3.0, 0.0, 0.0), 14.0), ((0.0, 3.0, 0.0), 22.0)  # N, of `iris`; s, after the tare
KEYS = ("vehicle.quadrotors", "vehicle.payload", "plant", "person", "wind", "pushes", "disturbance", "admittance.feel")


@functools.cache
def quadrotor_models() -> Mapping[str, str]:
    """The models of quadrotors and their one-line summaries (the first comment of each file)."""
    return {f.stem: f.read_text("utf-8").partition("\n")[0].lstrip("# ") for f in sorted(FOLDER.glob("*.toml"))}


@functools.cache
def _base() -> Mission:
    return load_mission("iris")


def _limit() -> float:
    return _base().compliance.thrust_fraction


@functools.cache
def _model(name: str) -> dict[str, Any]:
    return toml_tables((FOLDER / f"{name}.toml").read_text("utf-8"))


class NewBeam(NamedTuple):
    """A beam on two quadrotors: its length [m], mass [kg], and centre of mass from its middle [m].

    `models`: of the left (+y) and the right quadrotor. The soles of both are level, so that the beam is on the floor.
    """

    models: tuple[str, str]
    length: float
    mass: float
    center: float = 0.0

    @classmethod
    def default(cls, *models: str) -> NewBeam:
        """The beam that suits one model or two: as light as the lighter of their beams, as long as the longer.

        Raises:
            InputError: a model is unknown, or there are more than two.
        """
        if len(models) > 2:
            raise InputError(f"--quadrotor is given {len(models)} times: the beam has two, so at most twice")
        for model in models:
            if model not in quadrotor_models():
                raise unknown("quadrotor", model, quadrotor_models())
        beams = [_model(model)["beam"] for model in models]
        return cls((models[0], models[-1]), max(b["length"] for b in beams), min(b["mass"] for b in beams))

    @property
    def quadrotors(self) -> str:
        """The quadrotors in words."""
        left, right = self.models
        return f"two {left}" if left == right else f"{left} and {right}"

    @property
    def shortest(self) -> float:
        """The shortest beam for the models [m]: the guards at its ends just do not touch."""
        return sum(float(_model(model)["guard_radius"]) for model in self.models)

    @property
    def vehicle(self) -> dict[str, Any]:
        """The table `[vehicle]`."""
        tables = [_model(model) for model in self.models]
        radius = min(table["beam"]["radius"] for table in tables)
        shortest_feet = min(table["feet_depth"] for table in tables)
        payload = {
            "mass": self.mass,
            "length": self.length,
            "radius": radius,
            "center_of_mass": [0.0, self.center, 0.0],
        }
        fleet = []
        for table, end in zip(tables, (0.5, -0.5), strict=True):
            height = round(MOUNT * radius + table["feet_depth"] - shortest_feet, 6)
            own = {key: value for key, value in table.items() if key != "beam"}
            fleet.append({**own, "position": [0.0, end * self.length, height]})
        return {"payload": payload, "quadrotors": fleet}

    @property
    def mission(self) -> Mission:
        """Mission `iris` with this vehicle."""
        return _base().model_copy(update={"vehicle": VehicleTable.model_validate(self.vehicle)})

    @property
    def largest_mass(self) -> float:
        """The largest mass of such a beam [kg]: no rotor hovers with more than the share that guidance uses of it."""
        return self.mission.hover.largest_payload(_limit())


def hover_words(beam: NewBeam) -> Iterator[str]:
    """Lines that say what a vehicle can lift, and how far it is from its limits."""
    hover = beam.mission.hover
    yield f"{beam.quadrotors} and a beam of {beam.length:g} m and {beam.mass:g} kg: {hover.mass:.3g} kg"
    yield f"  thrust over weight          {hover.lift / hover.weight:.2f}"
    yield f"  most loaded rotor in hover  {hover.share:.0%} of its thrust"
    yield f"  heaviest beam               {beam.largest_mass:.3g} kg, at {_limit():.0%}"


def heaviest_words(beam: NewBeam) -> str:
    """The largest mass of such a beam, and what lifts more."""
    others = {model: beam._replace(models=(model, model)) for model in quadrotor_models() if model not in beam.models}
    more = {model: o.largest_mass for model, o in others.items() if beam.length >= o.shortest}
    lift = ", ".join(f"two {m} {mass:.3g} kg" for m, mass in more.items() if mass > beam.largest_mass)
    most = f"{beam.length:g} m and at most {beam.largest_mass:.3g} kg"
    return (
        f"{beam.quadrotors} lift a beam of {most}, with which a rotor "
        f"hovers at {_limit():.0%} of its thrust; {lift or 'no model here lifts more at that length and centre'}"
    )


def scaled(beam: NewBeam) -> Iterator[tuple[str, str, Any]]:
    """Keys of forces and moments with units and values, where these differ from those of `iris`.

    Where these do not act yet, the key that decides is among them, so that the file says so.
    """
    found = list(_scaled(beam))
    resting = {idle.decided_by for idle in idle_keys(_base(), [key for key, _, _ in found])}
    order = {key.name: place for place, key in enumerate(key for section in sections() for key in section.keys)}
    deciding = [(key, "", value_at(tables_of(_base()), tuple(key.split(".")))) for key in resting]
    yield from sorted([*found, *deciding], key=lambda one: order[one[0]])


def _scaled(beam: NewBeam) -> Iterator[tuple[str, str, Any]]:
    base, vehicle, tables = _base().hover.vehicle, beam.mission.hover.vehicle, tables_of(_base())
    force, turning = vehicle.mass / base.mass, np.diag(vehicle.inertia) / np.diag(base.inertia)
    for key in (key for section in sections() for key in section.keys if not key.name.startswith(KEYS)):
        unit, value = key.facts.unit or "", value_at(tables, tuple(key.name.split(".")))
        if not unit.startswith(("N", "kg")) or not isinstance(value, float | list | tuple):
            continue
        factor: Any = force
        if unit == "N, N m":
            factor = np.array([force, *turning])
        elif unit.startswith("N m"):
            at_joints, several = key.name.startswith(("sensors", "supervision")), isinstance(value, list | tuple)
            factor = force * beam.length / 2.0 if at_joints else turning if several else turning[2]
        new = [float(f"{x:.3g}") for x in np.ravel(np.array(value) * factor)]
        if np.any(value) and not np.allclose(new, value, rtol=5e-3):
            yield key.name, unit, new[0] if len(set(new)) == 1 else new


def new_mission(name: str, beam: NewBeam) -> str:
    """The text of a mission with this name, as far as one may have it: lift, a push along x, one along y, and back."""
    payload, fleet, name = *beam.vehicle.values(), re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-._")[:64] or "beam"
    force = beam.mission.hover.vehicle.mass / _base().hover.vehicle.mass
    own = [(FOLDER / f"{model}.toml").read_text("utf-8").partition("\n[beam]")[0].rstrip() for model in beam.models]
    right = f"{own[1]}\nposition = {fleet[1]['position']}  # m"
    if own[0] == own[1]:
        right = "\n".join(f"{key} = {written(value)}" for key, value in fleet[1].items())
    left = f"{own[0]}\nposition = {fleet[0]['position']}  # m"
    text = [
        f"# A beam of {beam.length:g} m and {beam.mass:g} kg on {beam.quadrotors}: two pushes (45 s).",
        f"# Forces are those of mission iris times {force:.3g}, the ratio of masses; moments, times that of inertias.",
        'extends = "iris"\n',
        f"[mission]\nname = {written(name)}\nduration = 45.0          # s\n",
        "[phases]\nland_start = 30.0        # s\n",
        "[vehicle.payload]",
        *(f"{key} = {written(value)}  # {'kg' if key == 'mass' else 'm'}" for key, value in payload.items()),
        f"\n[[vehicle.quadrotors]]\n{left}\n\n[[vehicle.quadrotors]]\n{right}",
    ]
    table = ""
    for key, unit, value in scaled(beam):
        above, _, last = key.rpartition(".")
        text += [f"\n[{above}]"] if above != table else []
        text, table = [*text, f"{last} = {written(value)}{unit and f'  # {unit}'}"], above
    for push, time in PUSHES:
        peak = [float(f"{force * x:.3g}") for x in push]
        text.append(f"\n[[pushes]]\nforce = {peak}  # N, peak\ntime = {time}  # s\nsigma = 0.6  # s")
    return "\n".join(text) + "\n"
