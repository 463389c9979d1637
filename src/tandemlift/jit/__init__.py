"""Compiling the laws with Numba.

`install()` reads the marks that the laws left in `tandemlift.law` and gives every law, operator and elementary
operation its compiled form. `fuse` makes all compiled forms of a law round alike, `layout` maps nested values to flat
arrays, `cache` keeps compiled loops on disk.

Only the loop and the compiled pilot import this package, so that Numba is loaded when something first flies.
"""

from tandemlift.jit.cache import cached_in, folder
from tandemlift.jit.layout import Layout, flat, leaves, load, load_lane, store, store_lane, unflat, zeroed
from tandemlift.jit.overloads import install

__all__ = [
    "Layout",
    "cached_in",
    "flat",
    "folder",
    "install",
    "leaves",
    "load",
    "load_lane",
    "store",
    "store_lane",
    "unflat",
    "zeroed",
]
