"""The control loop of the paper as blocks: from the person's push to the rotor thrusts, and back.

Each block carries the label of its equation in the paper, or the numbers that the mission gives it.
"""
# paper: fig2

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from tandemlift.figures.diagrams.canvas import Canvas
from tandemlift.figures.drawing.figure import Caption
from tandemlift.figures.drawing.style import BLUE, DIM, GREEN, GREY, TAN, VERMILLION, styled

CAPTION = Caption(
    "Control loop",
    "The push acts on the vehicle and, beyond the threshold, on the admittance. Its reference, with lift and landing, "
    "is what the position law tracks. That law gives the thrust U₁, and the roll and pitch that the attitude law "
    "tracks. The allocation divides thrust and moments among the rotors. A title stands above its equation’s label.",
    "Block diagram in two rows: person, sensors, gate, admittance, lift and landing; position law, attitude law, "
    "allocation, vehicle; with the state fed back to both laws.",
)

HEIGHT = 3.3  # in
WIDE, TALL = 1.12, 0.66
TOP, BOTTOM, MIDDLE, FEEDBACK = 2.45, 1.05, 1.77, 0.3
GUIDE = dict(zip(("person", "sensors", "gate", "admittance", "phases"), np.linspace(0.66, 6.1, 5), strict=True))
PILOT = {"position": 0.76, "attitude": 2.75, "allocation": 4.55, "vehicle": 6.2}
TINTS = {"human": VERMILLION, "guide": BLUE, "control": GREEN, "body": TAN}


class Block(NamedTuple):
    """A box of the diagram: its centre [in], a title, a smaller text, and its colour."""

    centre: tuple[float, float]
    title: str
    below: str
    tint: str


def blocks(mission: Mapping[str, Any]) -> dict[str, Block]:
    """The blocks of a mission's loop by name."""
    admittance = mission["admittance"]
    numbers = {name: float(np.ravel(admittance[name])[0]) for name in ("threshold", "mass", "damping", "stiffness")}
    law = mission["controller"]["name"].upper()
    tuned = "$\\mathbb{{M}}$ {mass:g}, $\\mathbb{{C}}$ {damping:g}, $\\mathbb{{K}}$ {stiffness:g}".format(**numbers)
    rows = {
        "person": ("Person", "pushes the payload", "human"),
        "sensors": ("Force sensors", "at the two joints", "guide"),
        "gate": ("Gate", f"|F| > {numbers['threshold']:g} N", "guide"),
        "admittance": ("Admittance", tuned, "guide"),
        "phases": ("Lift, landing", "by the clock", "guide"),
        "position": (f"Position {law}", "pos_cont_equ", "control"),
        "attitude": (f"Attitude {law}", "orient_cont_equ", "control"),
        "allocation": ("Allocation", "optim_cont_final_equ", "control"),
        "vehicle": ("Vehicle", "trans_rot_sys_equ", "body"),
    }
    places = {name: (x, TOP) for name, x in GUIDE.items()} | {name: (x, BOTTOM) for name, x in PILOT.items()}
    return {name: Block(places[name], *row) for name, row in rows.items()}


def _between(canvas: Canvas, a: float, b: float, y: float, label: str, **look: Any) -> None:
    """An arrow from the right side of a box to the left side of the next, with a label above."""
    canvas.arrow((a + WIDE / 2, y), (b - WIDE / 2, y), **look)
    canvas.text(((a + b) / 2, y + 0.11), label, fontsize=8)


def _guidance(canvas: Canvas) -> None:
    x = list(GUIDE.values())
    for k, label in enumerate((r"$F_{ext}$", r"$\hat F$", r"$F$", r"$T_r$")):
        _between(canvas, x[k], x[k + 1], TOP, label)
    down = [(x[4], TOP - TALL / 2), (x[4], MIDDLE), (PILOT["position"], MIDDLE), (PILOT["position"], BOTTOM + TALL / 2)]
    canvas.route(down, color=BLUE)
    canvas.text((2.0, MIDDLE + 0.12), r"$x_d, y_d, z_d$ and their rates", fontsize=8, color=BLUE)
    over = HEIGHT - 0.2
    side, at = 6.98, BOTTOM + 0.16
    push = [(x[0], TOP + TALL / 2), (x[0], over), (side, over), (side, at), (PILOT["vehicle"] + WIDE / 2, at)]
    canvas.route(push, color=VERMILLION)
    canvas.text((3.5, over - 0.12), "the push also acts on the vehicle", fontsize=8, color=VERMILLION)


def _control(canvas: Canvas) -> None:
    x = PILOT
    _between(canvas, x["position"], x["attitude"], BOTTOM - 0.12, r"$\phi_d, \theta_d$")
    _between(canvas, x["attitude"], x["allocation"], BOTTOM - 0.12, r"$U_2, U_3, U_4$")
    _between(canvas, x["allocation"], x["vehicle"], BOTTOM, r"$f_{ji}$")
    over = BOTTOM + TALL / 2 + 0.17
    start = x["position"] + WIDE / 2
    thrust = [(start, BOTTOM + 0.16), (start + 0.25, BOTTOM + 0.16), (start + 0.25, over), (x["allocation"], over)]
    canvas.route([*thrust, (x["allocation"], BOTTOM + TALL / 2)])
    canvas.text((start + 0.42, over - 0.11), "$U_1$", fontsize=8)
    canvas.route([(x["attitude"] - 0.85, BOTTOM + 0.2), (x["attitude"] - WIDE / 2, BOTTOM + 0.2)], color=GREY)
    canvas.text((x["attitude"] - 0.76, BOTTOM + 0.3), r"$\psi_d$", fontsize=8, color=GREY)
    body = x["vehicle"]
    for law in ("attitude", "position"):
        back = [(body, BOTTOM - TALL / 2), (body, FEEDBACK), (x[law], FEEDBACK), (x[law], BOTTOM - TALL / 2)]
        canvas.route(back, color=DIM)
    canvas.text((5.0, FEEDBACK - 0.12), r"state: $p, v, \phi, \theta, \psi, \omega$", fontsize=8)


@styled
def draw(mission: Mapping[str, Any]) -> Figure:
    """Draw the loop of a mission that is guided by the clock, as the paper's is."""
    canvas = Canvas(HEIGHT)
    for block in blocks(mission).values():
        canvas.box(block.centre, (WIDE, TALL), block.title, block.below, facecolor=(TINTS[block.tint], 0.12))
    _guidance(canvas)
    _control(canvas)
    return canvas.figure
