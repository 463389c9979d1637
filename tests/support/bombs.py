"""Small files that become large when they are read."""

import zipfile
from contextlib import contextmanager
from tracemalloc import get_traced_memory, start, stop

import numpy as np

ZEROS = bytes(1_000_000)


def zeros_archive(path, shapes, kept=None):
    """Write an archive as `np.savez_compressed` does: float64 zeros by names and shapes, and arrays that are kept."""
    np.savez_compressed(path, **(kept or {}))
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        for name, shape in shapes.items():
            with archive.open(f"{name}.npy", "w") as file:
                header = {"descr": "<f8", "fortran_order": False, "shape": shape}
                np.lib.format.write_array_header_1_0(file, header)
                for _ in range(8 * int(np.prod(shape)) // len(ZEROS)):
                    file.write(ZEROS)
    return path


@contextmanager
def memory_below(most):
    """Check that no more bytes than that are in use at once."""
    start()
    try:
        yield
        assert get_traced_memory()[1] < most
    finally:
        stop()
