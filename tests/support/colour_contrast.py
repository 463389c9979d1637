"""Contrast of two colours by WCAG 2.2, and what the filters of CSS make of a colour (W3C, Filter Effects 1)."""

import numpy as np
from matplotlib.colors import to_rgb

HUE_TURNED = np.array(  # hue-rotate(180deg) on sRGB, for cos = -1, sin = 0
    [
        [0.213 - 0.787, 0.715 + 0.715, 0.072 + 0.072],
        [0.213 + 0.213, 0.715 - 0.285, 0.072 + 0.072],
        [0.213 + 0.213, 0.715 + 0.715, 0.072 - 0.928],
    ]
)


def luminance(colour):
    """Relative luminance of a colour."""
    c = np.array(to_rgb(colour))
    return float(np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722])


def contrast(a, b):
    """Contrast ratio, 1 to 21."""
    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def inverted(colour):
    """A colour after invert(1) hue-rotate(180deg)."""
    return tuple(np.clip(HUE_TURNED @ (1.0 - np.array(to_rgb(colour))), 0.0, 1.0))


def on_screen(colour, behind):
    """A colour laid on another one with mix-blend-mode: screen."""
    return tuple(1.0 - (1.0 - np.array(to_rgb(colour))) * (1.0 - np.array(to_rgb(behind))))
