"""Ideal rotors, true readings, no floor, no wind: missions fly as they did before any of these could be otherwise.

The numbers were recorded then. They are bit for bit the same on the machine that recorded them; elsewhere NumPy's
matrix products may round another way, so they are compared to 1e-12.
"""

import numpy as np
import pytest

import tandemlift as tl

RECORDED = """\
paper 22.0
0x1.40147ee591534p-1 -0x1.37f72473333fdp-63 0x1.0b78645c0f7b4p+1
0x1.fff89b6dd46dbp-1 0x1.a6de32e054078p-66 0x1.5c064c9acb763p-7 0x1.a44eaf2b263efp-70
paper 41.0
0x1.5d7109ee86ad3p+2 -0x1.73f7daea80b3ap-1 0x1.0b78835cf5a23p+1
0x1.ff0895ffda044p-1 -0x1.f71a6ec6ddcedp-5 -0x1.d097a296e879fp-18 0x1.c99a3d786d09dp-22
flight-ready 22.0
0x1.2534a7d12a082p-1 -0x1.fa02fbc61314bp-32 0x1.c0c7e89290fd8p+0
0x1.ffd8e8a336218p-1 0x1.a0e421d5c7ac2p-33 0x1.901e0cfc8f6d9p-6 0x1.2cece0f95a931p-27
flight-ready 41.0
0x1.1fa96ec90441cp+2 -0x1.0f076f9d4282cp+0 0x1.c0c7d3ccc9b00p+0
0x1.fe61d0eabdedbp-1 -0x1.455de660edb35p-4 0x1.c6d651d6d9431p-17 0x1.3ed6352261a13p-21
one-push 4.0
0x1.3fd8d957217fbp-1 -0x1.3fc29006d8c3fp-71 0x1.83c99d27f96fdp-30
0x1.fff88aa702195p-1 -0x1.0ad337221137cp-72 0x1.5d904dc98d538p-7 -0x1.0c3480f47275ap-72
one-push 5.0
0x1.f5e0e770e140bp+0 -0x1.d3da67bd471dbp-70 -0x1.4481e67152b98p-31
0x1.ff075a1d4749bp-1 0x1.6361b6407b379p-71 -0x1.f85ae5c993ae3p-5 0x1.3f379b31e96b0p-74
one-push 12.0
0x1.5d718feb6062cp+1 -0x1.6432372c5aa7dp-78 0x1.86a73a0bdd9e0p-58
0x1.fffffffffdd11p-1 -0x1.824de886e6b05p-68 -0x1.7a49bf7e1e675p-20 0x1.3f2f5d6f06ceap-69
four 22.0
0x1.0189d93f09d54p-1 -0x1.2fca3868638f4p-31 0x1.c0c7dadf07949p+0
0x1.ff79ea976368fp-1 0x1.9e6032e1955e3p-32 0x1.727294528cb30p-5 0x1.2d411e07b903fp-27
four 41.0
0x1.1fa2ac601fe9dp+2 -0x1.d225e9963e251p-1 0x1.c0c7ea20e706dp+0
0x1.fefe7a92e1651p-1 -0x1.00a2216b11428p-4 -0x1.1a8e40ed3cd29p-17 -0x1.3d0907fd2c980p-20
"""  # mission and time [s]; position [m]; attitude w, x, y, z


def recorded():
    """(position, attitude) by mission and time [s]."""
    lines = iter(RECORDED.splitlines())
    for name, time in map(str.split, lines):
        yield name, float(time), *[np.array([*map(float.fromhex, next(lines).split())]) for _ in range(2)]


@pytest.mark.parametrize("mission", sorted({name for name, *_ in recorded()}))
def test_ideal_settings_reproduce_the_flights_of_the_first_issue(mission):
    flight = tl.fly(tl.load_mission(mission))
    rows = [(time, position, attitude) for name, time, position, attitude in recorded() if name == mission]
    assert len(rows) >= 2
    for time, position, attitude in rows:
        k = np.searchsorted(flight.time, time - 1e-9)
        for name, expected in (("position", position), ("attitude", attitude)):
            np.testing.assert_allclose(flight[name][k], expected, rtol=0.0, atol=1e-12 * np.linalg.norm(expected))
