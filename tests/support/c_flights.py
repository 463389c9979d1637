"""Flights of a mission in its C code, beside the native ones: the same numbers in, all numbers out."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import numpy as np

from tandemlift.codegen.c_package import code_texts, written
from tandemlift.core.types import leaves
from tandemlift.missions import changed
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import FlightMemory, leaf_offset

STRICT = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off")
HARNESS = """#include "{p}_flight.h"
int64_t fly(const {p}_FlightModel *model, const {p}_Inputs *inputs, int64_t steps, {p}_Sample *log, {p}_Sample *last,
    {p}_FlightModel *end);
int64_t fly(const {p}_FlightModel *model, const {p}_Inputs *inputs, int64_t steps, {p}_Sample *log, {p}_Sample *last,
    {p}_FlightModel *end)
{{
    static {p}_Flight flight;
    {p}_Sample sample;
    {p}_flight_start_from(&flight, model, inputs);
    for (int64_t k = 0; k <= steps && {p}_flight_step(&flight, &sample); k++) {{
        if (k % {P}_FLIGHT_EVERY == 0) {{
            log[k / {P}_FLIGHT_EVERY] = sample;
        }}
        if (k == {P}_FLIGHT_STEPS) {{
            *last = sample;
        }}
    }}
    *end = flight.model;
    return flight.k;
}}
"""


def unfused(mission):
    """The mission, computed alike on every machine."""
    return changed(mission, "mission.fma", False)


def same(a, b):
    """Whether numbers are equal to the last bit; NaN equals NaN."""
    a, b = np.asarray(a), np.asarray(b)
    return a.shape == b.shape and bool(np.all((a.view(np.int64) == b.view(np.int64)) | (np.isnan(a) & np.isnan(b))))


class CFlight:
    """A mission's flight as a shared library, or as a program for another machine."""

    def __init__(self, mission, folder: Path, compiler: str = "gcc", *options: str) -> None:
        self.mission, self.folder = mission, Path(folder)
        files = written(code_texts(mission), self.folder)
        self.header = next(f for f in files if f.name.endswith("_flight.h"))
        self.prefix = self.header.name.removesuffix("_flight.h")
        harness = self.folder / "harness.c"
        harness.write_text(HARNESS.format(p=self.prefix, P=self.prefix.upper()))
        library = self.folder / f"{compiler}.so"
        source = self.folder / f"{self.prefix}_flight.c"
        sources = [str(source), str(harness)]
        subprocess.run(
            [compiler, *STRICT, *(options or ("-O1",)), "-shared", "-fPIC", *sources, "-o", library, "-lm"], check=True
        )
        self.library = ctypes.CDLL(str(library))
        self.library.fly.restype = ctypes.c_int64

    def inputs(self, start, delays):
        """The struct of inputs of a flight, and the arrays that it points to."""
        text, fields, values, kept = self.header.read_text(), [], {}, []
        for name, count, table in zip(
            ("pushes", "gusts", "walls", "legs"),
            ("push_count", "gust_count", "wall_count", "leg_count"),
            start.tables,
            strict=True,
        ):
            if f"int64_t {count};" not in text:
                assert not len(table), f"{name} without a table in C"
                continue
            table = np.ascontiguousarray(table, dtype=float)
            kept.append(table)
            pair = [(name, ctypes.c_void_p), (count, ctypes.c_int64)]
            fields += pair
            values |= {name: table.ctypes.data, count: len(table)}
        if "int64_t delays[" in text:
            fields.append(("delays", ctypes.c_int64 * len(delays)))
            values["delays"] = tuple(int(d) for d in delays)
        fields.append(("keys", ctypes.c_double * 2))
        values["keys"] = tuple(map(float, start.keys))
        return type("Inputs", (ctypes.Structure,), {"_fields_": fields})(**values), kept

    def fly(self, p, start):
        """(Step reached, log, last sample, all numbers at the end) of a flight of the same variant."""
        columns = leaves(p.sample)
        log, last = np.zeros((p.steps // p.every + 1, columns)), np.full(columns, np.nan)
        end, numbers = np.zeros(len(start.numbers)), np.ascontiguousarray(start.numbers)
        inputs, kept = self.inputs(start, p.delays)
        places = [ctypes.c_void_p(a.ctypes.data) for a in (log, last, end)]
        given = ctypes.c_void_p(numbers.ctypes.data), ctypes.byref(inputs), ctypes.c_int64(p.steps)
        k = self.library.fly(*given, *places)
        del kept
        return k, log, last, end


def native(p, start):
    """(Step reached, log, last sample, all numbers at the end) of a flight in machine code."""
    memory = FlightMemory(p.loop_code.loop(1), [start], p.grid(p.steps // p.every + 1, p.every), leaves(p.sample))
    memory.fly(p.steps + 1)
    return memory.k, memory.log[0], memory.last, np.array(memory.numbers)


def drawn(mission, number):
    """(Plan, start) of a flight with another seed, another payload, and a blow at its start; every fifth diverges."""
    chance = np.random.default_rng(number)
    mission = changed(mission, "mission.seed", number)
    mass = mission.vehicle.payload.mass * float(chance.uniform(0.97, 1.03))
    p = FlightPlan(changed(mission, "vehicle.payload.mass", mass))
    start = p.start()
    at = leaf_offset(p.model, "flight_state", "state", "velocity").at
    turn = leaf_offset(p.model, "flight_state", "state", "rates").at
    is_violent = number % 5 == 4
    start.numbers[at : at + 3] += chance.normal(scale=5000.0 if is_violent else 0.1, size=3)
    start.numbers[turn : turn + 3] += chance.normal(scale=50.0 if is_violent else 0.2, size=3)
    return p, start


def differences(c_flight, mission, draws):
    """(Names of what differs, how many flights diverged) over draws of a mission, each flown in C and natively."""
    wrong, lost = [], 0
    for number in draws:
        p, start = drawn(mission, number)
        in_c, by_us = c_flight.fly(p, start), native(p, start)
        lost += by_us[0] < p.steps
        parts = zip(("step", "log", "last", "end"), in_c, by_us, strict=True)
        wrong += [f"draw {number}: {name}" for name, a, b in parts if not same(np.float64(a), np.float64(b))]
    return wrong, lost
