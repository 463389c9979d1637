"""Every kind of finding has a name, a meaning and a remedy of its own, and every key that a kind names exists."""

import pytest
from pydantic import ValidationError

from tandemlift.core.findings import FINDING_NAMES, KINDS, finding
from tandemlift.missions.key_descriptions import sections
from tandemlift.missions.outcomes import FindingsTable


def test_each_kind_has_a_name_of_its_own_which_missions_may_ignore_and_no_other():
    assert len(set(FINDING_NAMES)) == len(KINDS)
    FindingsTable(ignore=FINDING_NAMES)
    with pytest.raises(ValidationError):
        FindingsTable(ignore=("other",))
    with pytest.raises(KeyError):
        finding("other", "of no kind", time=0.0)
    assert len({kind.meaning for kind in KINDS}) == len({kind.remedy for kind in KINDS}) == len(KINDS)


def test_the_keys_of_thresholds_exist_and_each_serves_a_kind():
    known = {key.name for section in sections() for key in section.keys}
    used = [key for kind in KINDS for key in kind.keys]
    assert set(used) <= known
    ours = {name for name in known if name.startswith(("promise.", "findings."))} - {"findings.ignore"}
    assert sorted(key for key in used if key.startswith(("promise.", "findings."))) == sorted(ours)
