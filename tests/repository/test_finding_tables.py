"""Every kind of finding has a name, a meaning and a remedy of its own, and every key that a kind names exists."""

from tandemlift.core.findings import FINDING_NAMES, KINDS
from tandemlift.missions.key_descriptions import sections


def test_each_name_has_a_kind_of_its_own():
    assert tuple(kind.name for kind in KINDS) == FINDING_NAMES
    assert len({kind.meaning for kind in KINDS}) == len({kind.remedy for kind in KINDS}) == len(KINDS)


def test_the_keys_of_thresholds_exist_and_each_serves_a_kind():
    known = {key.name for section in sections() for key in section.keys}
    used = [key for kind in KINDS for key in kind.keys]
    assert set(used) <= known
    ours = {name for name in known if name.startswith(("promise.", "findings."))} - {"findings.ignore"}
    assert sorted(key for key in used if key.startswith(("promise.", "findings."))) == sorted(ours)
