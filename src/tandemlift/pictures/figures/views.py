"""Photographs of a flight from the cameras of a world, side by side, each with its letter, title and time."""
# paper: fig9

from __future__ import annotations

import io
from collections.abc import Sequence

import matplotlib.image
from matplotlib.figure import Figure

from tandemlift.pictures.drawing.figure import Caption, current_style
from tandemlift.pictures.drawing.style import page_figure, points, styled

CAPTION = Caption(
    "Photographs",
    "The flight as seen by cameras in Gazebo.",
    "Photographs of the vehicle in its surroundings, each with its letter, what it shows, and the time.",
)
ACROSS = 2  # pictures side by side
HEAD = 0.24  # in, over each picture


@styled
def draw(pictures: Sequence[tuple[str, bytes]]) -> Figure:
    """Draw pictures, each with its title.

    Args:
        pictures: title and JPEG of each, all of one size.
    """
    shown = [matplotlib.image.imread(io.BytesIO(jpeg), format="jpeg") for _, jpeg in pictures]
    rows = -(-len(shown) // ACROSS)
    height, width = shown[0].shape[:2]
    figure = page_figure(rows * (HEAD + current_style().page / ACROSS * height / width))
    axes = figure.subplots(rows, ACROSS, squeeze=False)
    for letter, ax, image, (title, _) in zip("abcdefgh", axes.flat, shown, pictures, strict=False):
        ax.imshow(image, interpolation="lanczos")
        ax.set_title(f"({letter}) {title}", fontsize=points(8.5), pad=3)
    for ax in axes.flat:
        ax.set_axis_off()
    return figure
