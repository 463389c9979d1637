"""With ideal rotors, exact pushes and no surroundings, flights are those of the version before the real parts."""

import numpy as np
import pytest

import tandemlift as tl

# position and attitude of a logged sample; to 1e-12 and not to the last bit, as matrices are inverted by each
# machine's own linear algebra
BEFORE = {
    ("paper", 500): """
        0x1.a4184f3ca6d9bp-29 -0x1.4d368124e114ep-15 0x1.00000023dd462p-1 0x1.ffffffffbd82dp-1
        0x1.04ee34837ace6p-17 0x1.4ca777d8c17fap-29 0x1.51d9535070b65p-46
    """,
    ("paper", -1): """
        0x1.5d71ea78e0715p+3 -0x1.2d6bdda0d70e4p-4 -0x1.bd953b3240365p-65 0x1.0000000000000p+0
        -0x1.44bcec543b0b7p-60 0x1.6edb3c3dd4734p-53 -0x1.7968dea94e8e8p-69
    """,
    ("flight-ready", 500): """
        0x1.ace9ef63a65f3p-10 -0x1.62a18f7b4c7d7p-8 0x1.00007083bc192p-1 0x1.fffdb36a0dcf7p-1
        0x1.2fbf7b7471fd8p-12 0x1.6babdcdefa591p-14 0x1.83aa2af4d6bf7p-8
    """,
    ("flight-ready", -1): """
        0x1.1fa51dac14129p+3 -0x1.39a09932f5f68p-2 0x1.be83c130a92cep-55 0x1.0000000000000p+0
        0x1.9368b8e24ba5fp-57 -0x1.48be89d8222e1p-53 -0x1.c6a4192f9a348p-55
    """,
    ("one-push", 500): """
        0x1.f5e0e770e140bp+0 -0x1.d3da67bd471dbp-70 -0x1.4481e67152b98p-31 0x1.ff075a1d4749bp-1
        0x1.6361b6407b379p-71 -0x1.f85ae5c993ae3p-5 0x1.3f379b31e96b0p-74
    """,
    ("one-push", -1): """
        0x1.5d718feb6062cp+1 -0x1.6432372c5aa7dp-78 0x1.86a73a0bdd9e0p-58 0x1.fffffffffdd11p-1
        -0x1.824de886e6b05p-68 -0x1.7a49bf7e1e675p-20 0x1.3f2f5d6f06ceap-69
    """,
    ("four", 500): """
        0x1.ac71f345c1819p-10 -0x1.62bc16bec1269p-8 0x1.000070909b46ap-1 0x1.fffdb4d1e017ap-1
        0x1.300ca463c7595p-12 0x1.6b911bf5360f2p-14 0x1.83330fc64098bp-8
    """,
    ("four", -1): """
        0x1.1fa51dac13607p+3 -0x1.39a09932f6a87p-2 0x1.22232dbcbe547p-53 0x1.0000000000000p+0
        -0x1.9fd708659ef1dp-59 0x1.6f38859c86c4bp-54 0x1.80e81e57d3159p-56
    """,
}


@pytest.mark.parametrize(("name", "sample"), BEFORE)
def test_an_ideal_flight_is_what_it_was_before_there_were_real_parts(name, sample):
    flight = tl.fly(tl.load_mission(name))
    expected = [float.fromhex(number) for number in BEFORE[name, sample].split()]
    flown = np.concatenate([flight["position"][sample], flight["attitude"][sample]])
    assert flown == pytest.approx(expected, rel=1e-12, abs=1e-12)
