"""Maps with one mistake drawn at random: refused, or right; and the cause that is named is the true one.

python evidence/mistaken_maps.py --draws 200 --out out/mistaken

Vehicles of 1 to 4 unlike quadrotors are simulated by `other_body.py`, by no code of the package, and written as
tables as strange instruments would: front, right, down; a world with y up; millimetres; degrees; pounds; a tracked
body whose axes are turned; quaternions x, y, z, w; rotors and quadrotors in an order of their own; revolutions per
minute; late stamps. Each table has a right map. From it one mistake is made: a key left out or changed (sign, unit,
axis, order, frame, quadrotor, delay, stamp). A log read by the mistaken map must be refused, or give the numbers of the
right one. If the message has keys to paste, they are pasted into the map, and the log is read and tested again: the
named cause counts as the true one if its streams then are those of the right map. Right maps must not be refused.

Results are lines of JSON in OUT/draws.jsonl, which a second run continues; the table is printed at the end.
"""

from __future__ import annotations

import argparse
import json
import re
import time
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from other_body import drawn, flown, log_of

import tandemlift as tl
from tandemlift.analysis.logs.causes import check_streams
from tandemlift.analysis.logs.columns import turned_by
from tandemlift.analysis.logs.log import JOINTS, MOTION, Log, Stream, conjugate, quaternion_product, rotated
from tandemlift.analysis.logs.maps import factor_of
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.missions import Mission

FIRST_SEED = 41000
SAME = 0.01  # of the spread of a stream: logs that differ by less are the same
SECONDS = 20.0  # of a flight
RATES, FORCE, SPEEDS = "measured_rates", "measured_specific_force", "rotor_speed_commands"
POSITION, VELOCITY, ATTITUDE = MOTION
NAMES = {RATES: "gyro", FORCE: "acc", POSITION: "pos", VELOCITY: "vel", ATTITUDE: "q", SPEEDS: "esc"}
NAMES |= {JOINTS[0]: "ftf", JOINTS[1]: "ftm"}
Map = dict[str, Any]


class Instruments:
    """A table of a log as strange instruments write it, and the right map of it."""

    def __init__(self, log: Log, chance: np.random.Generator) -> None:
        self.chance, self.streams, self.map = chance, dict(log.streams), {}
        self.count = log[JOINTS[0]].values.shape[1] // 3
        for name, stream in log.items():
            width = stream.values.shape[1]
            columns = [f"{NAMES[name]}{i}" for i in range(width)]
            self.map[name] = {"columns": columns, "time": f"t_{NAMES[name]}"}
        if chance.random() < 0.5:
            self.change(RATES, unit="deg/s")
        if chance.random() < 0.5:
            for name in (RATES, FORCE):
                self.scale(name, [1, -1, -1])
        if chance.random() < 0.3:
            self.change(FORCE, unit="g")
        if chance.random() < 0.3:
            self.change(VELOCITY, frame="body")
        if chance.random() < 0.3:
            self.change(POSITION, unit="mm")
        if chance.random() < 0.3:
            self.change(ATTITUDE, turn=[round(x, 1) for x in (chance.uniform(-60.0, 60.0, 3)).tolist()])
        if chance.random() < 0.4:
            for name in (POSITION, ATTITUDE, *([] if "frame" in self.map[VELOCITY] else [VELOCITY])):
                self.change(name, up="y")
        if chance.random() < 0.5:
            self.order(ATTITUDE, [1, 2, 3, 0])
        if chance.random() < 0.3:
            self.change(JOINTS[0], unit=str(chance.choice(["lbf", "kgf"])))
        if chance.random() < 0.3:
            for name in JOINTS:
                self.scale(name, [-1] * (3 * self.count))
        if self.count > 1 and chance.random() < 0.4:
            order = [*range(1, self.count), 0]
            for name in JOINTS:
                self.order(name, [3 * i + a for i in order for a in range(3)])
        if chance.random() < 0.5:
            self.change(SPEEDS, unit="rpm")
        if chance.random() < 0.5:
            rotors = [1, 2, 3, 0] if chance.random() < 0.5 else [2, 0, 1, 3]
            self.order(SPEEDS, [4 * i + r for i in range(self.count) for r in rotors])
        if chance.random() < 0.4:
            late = round(float(chance.uniform(0.03, 0.12)), 3)
            for name in MOTION:
                self.change(name, delay=late)

    def change(self, name: str, **keys: Any) -> None:
        """What the instrument writes, so that these keys make it right."""
        (time_, values), way = self.streams[name], self.map[name]
        if "unit" in keys:
            values = values / factor_of(keys["unit"])
        if "frame" in keys:
            q = Stream(*self.streams[ATTITUDE]).at(time_)
            values = rotated(conjugate(q), values)
        if "turn" in keys:
            values = quaternion_product(values, np.tile(turned_by(keys["turn"]), (len(values), 1)))
        if "up" in keys:
            q = np.tile([np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0], (len(values), 1))
            is_attitude = name == ATTITUDE
            values = (
                quaternion_product(quaternion_product(q, values), conjugate(q)) if is_attitude else rotated(q, values)
            )
        if "delay" in keys:
            time_ = time_ + keys["delay"]
        self.streams[name] = Stream(time_, values)
        way |= keys

    def scale(self, name: str, signs: list[int]) -> None:
        """Signs of an instrument."""
        time_, values = self.streams[name]
        self.streams[name] = Stream(time_, values * signs)
        self.map[name]["scale"] = signs

    def order(self, name: str, order: list[int]) -> None:
        """Columns in the order of an instrument: its column i is ours `order[i]`."""
        columns = self.map[name]["columns"]
        self.streams[name] = Stream(self.streams[name].time, self.streams[name].values[:, order])
        renamed = dict(zip([columns[i] for i in order], columns, strict=True))
        self.map[name]["columns"] = [renamed[c] for c in columns]
        if "scale" in self.map[name]:
            signs = np.array(self.map[name]["scale"])
            assert np.all(signs == signs[0])

    def write(self, path: Path) -> None:
        """The table: a block of rows for each stream, with a clock of its own."""
        heads = [f"t_{NAMES[n]}" for n in self.streams] + [
            f"{NAMES[n]}{i}" for n, s in self.streams.items() for i in range(s.values.shape[1])
        ]
        longest = max(len(s.time) for s in self.streams.values())
        table = np.full((longest, len(heads)), "", dtype="U16")
        at = len(self.streams)
        for k, s in enumerate(self.streams.values()):
            table[: len(s.time), k] = np.char.mod("%.6f", s.time)
            width = s.values.shape[1]
            table[: len(s.time), at : at + width] = np.char.mod("%.8g", s.values)
            at += width
        path.write_text("\n".join([",".join(heads), *(",".join(row) for row in table)]) + "\n", "utf-8")


def mistaken(right: Map, count: int, chance: np.random.Generator) -> tuple[str, Map]:
    """(The kind of a mistake, the map with it)."""
    wrong = {name: dict(way) for name, way in right.items()}
    kind = str(chance.choice(["sign", "unit", "axis", "order", "frame", "quadrotor", "delay", "stamp"]))
    vectors = [RATES, FORCE, POSITION, VELOCITY]

    def signs(name: str) -> list[float]:
        width = len(right[name]["columns"])
        return np.broadcast_to(np.array(right[name].get("scale", 1.0)), (width,)).tolist()

    if kind == "sign":
        name = str(chance.choice([*vectors, ATTITUDE, *JOINTS]))
        scale = signs(name)
        if name in JOINTS and chance.random() < 0.6:
            for own in JOINTS:
                wrong[own]["scale"] = [-s for s in signs(own)]
        else:
            i = int(chance.integers(len(scale)))
            i = max(i, 1) if name == ATTITUDE else i
            scale[i] = -scale[i]
            wrong[name]["scale"] = scale
    elif kind == "unit":
        name = str(chance.choice([RATES, FORCE, POSITION, *JOINTS, SPEEDS]))
        other = {
            RATES: "deg/s",
            FORCE: "g",
            POSITION: "mm",
            JOINTS[0]: str(chance.choice(["kgf", "lbf"])),
            JOINTS[1]: "mN m",
            SPEEDS: "rpm",
        }
        wrong[name]["unit"] = "1" if "unit" in right[name] else other[name]
    elif kind == "axis":
        name = str(chance.choice([*vectors, *JOINTS]))
        i, j = chance.choice(3, 2, replace=False)
        at = 3 * int(chance.integers(len(right[name]["columns"]) // 3))
        columns = list(right[name]["columns"])
        columns[at + i], columns[at + j] = columns[at + j], columns[at + i]
        wrong[name]["columns"] = columns
    elif kind == "order":
        columns = list(right[ATTITUDE]["columns"])
        if chance.random() < 0.5:
            wrong[ATTITUDE]["columns"] = (
                columns[1:] + columns[:1] if chance.random() < 0.5 else columns[-1:] + columns[:-1]
            )
        else:
            rotors = [[1, 0, 3, 2], [1, 2, 3, 0], [0, 2, 1, 3], [3, 2, 1, 0]][int(chance.integers(4))]
            columns = list(right[SPEEDS]["columns"])
            wrong[SPEEDS]["columns"] = [columns[4 * i + r] for i in range(count) for r in rotors]
    elif kind == "frame":
        which = int(chance.integers(4))
        if which == 0:
            for name in MOTION:
                if name != VELOCITY or "frame" not in right[VELOCITY]:
                    wrong[name]["up"] = "z" if right[name].get("up") == "y" else "y"
        elif which == 1:
            wrong[VELOCITY]["frame"] = "" if right[VELOCITY].get("frame") else "body"
        elif which == 2:
            for name in (RATES, FORCE):
                wrong[name]["scale"] = [a * b for a, b in zip(signs(name), [1, -1, -1], strict=True)]
        else:
            wrong[ATTITUDE]["turn"] = (
                [0.0, 0.0, 0.0]
                if "turn" in right[ATTITUDE]
                else [0.0, 0.0, float(chance.choice([90.0, -90.0, 45.0, 15.0]))]
            )
    elif kind == "quadrotor":
        if count == 1:
            return mistaken(right, count, chance)
        if chance.random() < 0.5:
            columns = right[SPEEDS]["columns"]
            wrong[SPEEDS]["columns"] = columns[4:8] + columns[:4] + columns[8:]
        else:
            for name in JOINTS:
                columns = right[name]["columns"]
                wrong[name]["columns"] = columns[3:6] + columns[:3] + columns[6:]
    elif kind == "delay":
        late = float(chance.choice([-1.0, 1.0]) * chance.uniform(0.03, 0.12))
        group = [MOTION, JOINTS, (ATTITUDE,), (VELOCITY,), (RATES,), (FORCE,)][int(chance.integers(6))]
        for name in group:
            wrong[name]["delay"] = right[name].get("delay", 0.0) + late
    else:
        name = str(chance.choice([RATES, POSITION, ATTITUDE, JOINTS[0], SPEEDS]))
        wrong[name]["time_unit"] = str(chance.choice(["ms", "us"]))
    return kind, wrong


def pasted(way: Map, message: str) -> Map | None:
    """The map with the keys of a message; None if it has none."""
    found = re.findall(r"\[(\w+)\] ((?:\w+ = (?:\[[^\]]*\]|\"[^\"]*\"|[^,\s\[\]]+)(?:, )?)+)", message)
    if not found:
        return None
    new = {name: dict(keys) for name, keys in way.items()}
    for name, text in found:
        keys = re.findall(r"(\w+) = (\[[^\]]*\]|\"[^\"]*\"|[^,\s]+)", text)
        new[name] |= tomllib.loads("\n".join(f"{key} = {value}" for key, value in keys))
    return new


def error_between(one: Log, other: Log) -> tuple[str, float]:
    """(The stream in which two logs differ most, by how much of its own spread)."""
    worst = ("", 0.0)
    for name in one:
        a, b = one[name], other[name]
        if len(a.time) != len(b.time):
            return name, np.inf
        values = b.values
        if name == ATTITUDE:
            values = values * np.sign(np.sum(a.values * values, axis=1, keepdims=True))
        offset = abs(float(np.median(a.time - a.time[0] - b.time + b.time[0])))
        size = 1.0 if name == ATTITUDE else max(float(np.sqrt(np.mean(a.values**2))), 1e-9)
        error = float(np.sqrt(np.mean((a.values - values) ** 2))) / size + offset
        worst = max(worst, (name, error), key=lambda item: item[1])
    return worst


def late_between(one: Log, other: Log) -> float:
    """The largest difference of stamps of two logs of one table [s], their common shift left out."""
    shifts = [float(one[name].time[0] - other[name].time[0]) for name in one]
    return float(np.ptp(shifts))


def moved_by(right: Log, wrong: Log, mission: Mission) -> float:
    """The largest difference of what is identified from two logs, in half intervals of the first."""
    weighed, silent = {"vehicle.payload.mass": mission.vehicle.payload.mass}, {"progress": lambda done, of: None}
    try:
        a, b = (tl.identify(log, mission, weighed=weighed, **silent) for log in (right, wrong))
    except InputError:
        return 0.0  # refused after all
    return max(abs(x.value - y.value) / x.half for x, y in zip((*a.rows, *a.whole), (*b.rows, *b.whole), strict=True))


def verdict(path: Path, wrong: Map, right: Log, mission: Mission) -> dict[str, Any]:
    """What becomes of a log that is read by a mistaken map."""

    def read(way: Mapping[str, Any]) -> Log:
        log = tl.read_log(path, {"stamp_offset": 0.0, **way})
        check_streams(log, mission.vehicle)
        return log

    try:
        log = read(wrong)
    except InputError as error:
        said = str(error)
    else:
        found = {"refused": False, "error": error_between(right, log), "late": late_between(right, log)}
        return found | {"moved": moved_by(right, log, mission) if found["error"][1] > SAME else 0.0}
    new, found = pasted(wrong, said), {"refused": True, "said": said}
    if new is None:
        return found | {"named": False}
    try:
        log = read(new)
    except InputError as error:
        return found | {"named": False, "again": str(error)}
    (name, error), late = error_between(right, log), late_between(right, log)
    return found | {"named": error < 0.06 and late < 0.008, "differs": [name, error, late]}


def start_of(changes: dict[str, Any]) -> Mission:
    """The mission of about such a vehicle: iris, with its quadrotors at their places."""
    base = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(exclude_none=True)
    quadrotors = [base | {"position": q["position"], "max_speed": 1500.0} for q in changes["vehicle.quadrotors"]]
    with without_flight_warnings():
        return tl.load_mission("iris", {"vehicle.quadrotors": quadrotors, "pushes": []})


def flights(out: Path, vehicles: int, seconds: float, first: int) -> list[tuple[dict[str, Any], dict[str, np.ndarray]]]:
    """Some vehicles of 1 to 4 quadrotors each from a seed on, and their flights, kept in a folder."""
    found = []
    for count in (1, 2, 3, 4):
        file = out / f"flights-{first}-{count}-{vehicles}-{seconds:g}.npz"
        changes = [drawn(first + 100 * count + i, count) for i in range(vehicles)]
        if not file.exists():
            with without_flight_warnings():
                made = flown([tl.load_mission("iris", c) for c in changes], seconds, first + count)
            np.savez(file, **{f"{i}:{name}": v for i, one in enumerate(made) for name, v in one.items()})
        with np.load(file) as data:
            for i, change in enumerate(changes):
                found.append((change, {n.split(":")[1]: data[n] for n in data.files if n.startswith(f"{i}:")}))
    return found


def draw(seed: int, pool: list[Any], out: Path) -> dict[str, Any]:
    """One draw: a vehicle, its instruments, a right map and one with a mistake."""
    chance = np.random.default_rng(seed)
    changes, flight = pool[int(chance.integers(len(pool)))]
    log = log_of(flight, float(chance.choice([250.0, 500.0, 1000.0])), seed)
    mission, count, path = start_of(changes), len(changes["vehicle.quadrotors"]), out / "table.csv"
    table = Instruments(log, chance)
    table.write(path)
    right = tl.read_log(path, {"stamp_offset": 0.0, **table.map})
    began, found = time.process_time(), {"seed": seed, "quadrotors": count}
    try:
        check_streams(right, mission.vehicle)
        found["right"] = "accepted"
    except InputError as error:
        found["right"] = str(error)
    found["error_of_right"] = error_between(log, right)[1]
    kind, wrong = mistaken(table.map, count, chance)
    changed = {n: {k: v for k, v in way.items() if v != table.map[n].get(k)} for n, way in wrong.items()}
    found |= {"kind": kind, "mistake": {n: keys for n, keys in changed.items() if keys}}
    return found | verdict(path, wrong, right, mission) | {"seconds": time.process_time() - began}


def main() -> None:
    """Draw mistakes, and print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--draws", type=int, default=200)
    options.add_argument("--first-seed", type=int, default=FIRST_SEED)
    options.add_argument("--vehicles", type=int, default=3, help="of each number of quadrotors")
    options.add_argument("--out", type=Path, default=Path("out/mistaken"))
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    file = given.out / "draws.jsonl"
    rows = [json.loads(line) for line in file.read_text("utf-8").splitlines()] if file.exists() else []
    done, pool = {row["seed"] for row in rows}, flights(given.out, given.vehicles, SECONDS, given.first_seed)
    for seed in range(given.first_seed, given.first_seed + given.draws):
        if seed not in done:
            rows.append(draw(seed, pool, given.out))
            with file.open("a", encoding="utf-8") as out:
                out.write(json.dumps(rows[-1]) + "\n")
    refused = [row for row in rows if row["refused"]]
    print(f"{len(rows)} draws; right maps refused: {sum(row['right'] != 'accepted' for row in rows)}")
    for kind in sorted({row["kind"] for row in rows}):
        own = [row for row in rows if row["kind"] == kind]
        named = sum(row.get("named", False) for row in own)
        print(
            f"{kind:10} {len(own):4} drawn, {sum(row['refused'] for row in own):4} refused, "
            f"{named:4} with the true cause"
        )
    named = sum(row.get("named", False) for row in refused)
    print(f"refused {len(refused)}, the true cause in {named} ({named / max(len(refused), 1):.1%})")
    for row in rows:
        if not row["refused"]:
            name, error = row["error"]
            print(
                f"accepted: seed {row['seed']}, {row['kind']}: {name} differs by {error:.3f} of its spread; what is "
                f"identified, by {row['moved']:.2f} half intervals at most"
            )


if __name__ == "__main__":
    main()
