"""`tandemlift feel`: what it prints, and its exit codes."""

from functools import partial

import pytest
from verbs import verb

import tandemlift as tl
from tandemlift.core.errors import InputError

call = partial(verb, "feel")


def test_it_prints_the_closed_form_and_the_gate():
    code, text, _ = call("one-push", "--strict")
    assert code == 0
    assert "the response to a standard push, by the closed form" in text
    assert "0.62 m/s" in text  # 1 N / 1.6 N s/m
    assert "A push must exceed 0.3 N; beyond it the whole force acts." in text
    assert text.endswith("no check applies to this mission\n"), "with ideal rotors and exact sensors"
    assert tl.feel("one-push").summary()["axes"][0]["final_speed"] == pytest.approx(1.0 / 1.6)


def test_with_a_spring_there_is_no_final_speed():
    assert "1 N   0.3 N       –            –           –" in str(
        tl.feel(tl.load_mission("one-push", {"admittance.stiffness": 2.0}))
    )


def test_a_check_that_fails_says_the_bound_and_ends_with_3_if_strict():
    quick = "admittance.feel={force=1.0, speed=1.2, time=0.5}"
    arguments = ("one-push", "--set", quick, "--set", "pilot.guidance=interactive")
    assert call(*arguments)[0] == 0
    code, text, _ = call(*arguments, "--strict")
    assert code == 3
    assert "fails: the response to 1 N along x begins with 7.19 m/s²" in text
    assert "allow it at least 1.2 s for 1.2 m/s" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("iris", "--set", "admittance.feel.preset=hard"), 'must be "light", "firm" or "slow"'),
        (("irsi",), "Did you mean 'iris'"),
    ],
    ids=str,
)
def test_bad_input_is_refused(arguments, said):
    _, _, error = call(*arguments)
    assert isinstance(error, InputError)
    assert said in str(error)
