"""What the project promises to the outside keeps its name; public_names.txt records all of it, a line each.

A change is recorded by `python tests/repository/test_promised_names.py`: a name that goes stays in the file, marked as
gone, and one that comes is marked as new. CHANGELOG.md must name both above its section of 1.0.0.
"""

import re
import sys
from pathlib import Path

RECORD = Path(__file__).with_name("public_names.txt")
ROOT = Path(__file__).parents[2]
GONE, NEW = "gone", "new"  # since 1.0.0
CHANGED = "record it: python tests/repository/test_promised_names.py, and name it in CHANGELOG.md"


def public_names():
    """Each name that users write or read: commands, exit codes, Python, missions, keys, channels, metrics, findings."""
    from mission_schema import SCHEMA

    import tandemlift as tl
    import tandemlift.core.algebra as algebra
    import tandemlift.parts.controllers as tc
    from tandemlift.analysis.studies.metric_descriptions import METRIC_GROUPS
    from tandemlift.apps.cli import flying, main
    from tandemlift.core.findings import KINDS
    from tandemlift.flight.channels import GROUPS
    from tandemlift.missions.loading import built_in

    for name, command in main.cli.commands.items():
        yield f"command {name}"
        for p in command.params:
            yield f"command {name} {p.opts[0] if p.opts[0].startswith('-') else p.human_readable_name}"
    yield from (f"exit code {code}" for code in (0, main.BAD_INPUT, flying.FAILED, main.INTERRUPTED))
    for module in (tl, tc, algebra):
        yield from (f"python {module.__name__}.{name}" for name in module.__all__)
    for one in (tl.Flight, tl.Simulation, tl.Pilot, tl.Block, tl.Study, tl.LinearModel):
        yield from (f"python tandemlift.{one.__name__}.{name}" for name in dir(one) if not name.startswith("_"))
    yield from (f"mission {name}" for name in built_in())
    yield from (f"key {name}" for name in SCHEMA)
    yield from (f"channel {name}" for group in GROUPS for name in group.channels)
    yield from (f"metric {name}" for group in METRIC_GROUPS for name in group.metrics)
    yield from (f"finding {kind.name}" for kind in KINDS)


def recorded():
    """Each name of the record, and what became of it."""
    rows = (line.partition("  (") for line in RECORD.read_text("utf-8").splitlines())
    return {name: mark.removesuffix(")") for name, _, mark in rows}


def changed(before, now):
    """The record `before`, brought to the names that there are now."""
    came = {name: NEW for name in now if before.get(name, GONE) == GONE}
    went = dict.fromkeys(before.keys() - now, GONE)
    return before | came | went


def unexplained(record, changelog):
    """The names that came or went and are not named since 1.0.0."""
    since = changelog.partition("\n## [1.0.0]")[0]
    words = set(re.findall(r"[\w-]+", since))
    return [name for name, mark in record.items() if mark and re.split("[ .]", name)[-1] not in words]


def test_what_is_recorded_is_what_there_is():
    record, now = recorded(), set(public_names())
    changes = {name: mark for name, mark in changed(record, now).items() if mark != record.get(name)}
    assert changes == {}, f"a promised name changed: {CHANGED}"


def test_what_changed_is_in_the_changelog():
    assert unexplained(recorded(), (ROOT / "CHANGELOG.md").read_text("utf-8")) == []


def test_a_name_that_comes_or_goes_needs_an_entry_above_that_of_1_0_0():
    record = changed(
        {"key a.kept": "", "command fly --old": "", "key b.back": GONE}, {"key a.kept", "metric x", "key b.back"}
    )
    assert record == {"key a.kept": "", "command fly --old": GONE, "key b.back": NEW, "metric x": NEW}
    assert unexplained(record, "\n## [1.0.0]\n--old, b.back and x\n") == ["command fly --old", "key b.back", "metric x"]
    assert unexplained(record, "`fly --old` is gone; new: `b.back`, `x`\n\n## [1.0.0]\n") == []


if __name__ == "__main__":
    sys.path += [str(ROOT / "src"), str(ROOT / "tests" / "support")]
    record = changed(recorded(), set(public_names()))
    RECORD.write_text("".join(f"{n}  ({mark})\n" if mark else f"{n}\n" for n, mark in sorted(record.items())), "utf-8")
    print(f"{RECORD.name}: {len(record)} names, {sum(map(bool, record.values()))} of them new or gone since 1.0.0")
