"""What the project promises to the outside keeps its name; public_names.txt records all of it, a line each.

A new name is recorded by `python tests/repository/test_promised_names.py`. A name that goes stays in the file, marked
as gone, and CHANGELOG.md must name it.
"""

import sys
from pathlib import Path

import numpy as np

RECORD, GONE = Path(__file__).with_name("public_names.txt"), "  (gone)"
ROOT = Path(__file__).parents[2]
NEW = "a name is not recorded: run python tests/repository/test_promised_names.py, and name the change in CHANGELOG.md"


def public_names():
    """Each name that users write or read: commands, exit codes, Python, keys, channels, metrics, findings."""
    from mission_schema import SCHEMA

    import tandemlift as tl
    import tandemlift.parts.controllers as tc
    from tandemlift.apps.cli import flying, main
    from tandemlift.core.findings import KINDS
    from tandemlift.flight.channels import GROUPS
    from tandemlift.flight.metric_descriptions import METRIC_GROUPS

    for name, command in main.cli.commands.items():
        yield f"command {name}"
        for p in command.params:
            yield f"command {name} {p.opts[0] if p.opts[0].startswith('-') else p.human_readable_name}"
    yield from (f"exit code {code}" for code in (0, main.BAD_INPUT, flying.FAILED, main.INTERRUPTED))
    yield from (f"python tandemlift.{name}" for name in tl.__all__)
    yield from (f"python tandemlift.parts.controllers.{name}" for name in tc.__all__)
    for one in (tl.Flight, tl.Simulation, tl.Pilot, tl.Block, tl.Study, tl.LinearModel):
        yield from (f"python tandemlift.{one.__name__}.{name}" for name in dir(one) if not name.startswith("_"))
    yield from (f"key {name}" for name in SCHEMA)
    yield from (f"channel {name}" for group in GROUPS for name in group.channels)
    yield from (f"metric {name}" for group in METRIC_GROUPS for name in group.metrics)
    yield from (f"finding {kind.name}" for kind in KINDS)


def recorded():
    return dict.fromkeys(RECORD.read_text("utf-8").splitlines())


def test_what_is_recorded_is_what_there_is():
    there = set(public_names())
    missing = [name for name in recorded() if not name.endswith(GONE) and name not in there]
    assert missing == [], "a promised name went: keep it, or record that it is gone and name it in CHANGELOG.md"
    assert sorted(there - set(recorded())) == [], NEW


def test_what_is_gone_is_in_the_changelog():
    changelog = (ROOT / "CHANGELOG.md").read_text("utf-8")
    gone = [name.removesuffix(GONE).split()[-1].split(".")[-1] for name in recorded() if name.endswith(GONE)]
    assert [name for name in gone if name not in changelog] == []


def test_metrics_of_a_flight_are_recorded_ones():
    import tandemlift as tl

    metrics = tl.fly(tl.load_mission("one-push")).metrics()
    assert {f"metric {name}" for name in metrics} <= set(recorded())
    assert np.shape(metrics["position_rmse_m"]) == (3,)


if __name__ == "__main__":
    sys.path += [str(ROOT / "src"), str(ROOT / "tests" / "support")]
    now = set(public_names())
    old = {name.removesuffix(GONE) for name in recorded()} if RECORD.exists() else set()
    RECORD.write_text("".join(f"{name}\n" for name in sorted(now | {name + GONE for name in old - now})), "utf-8")
    print(f"{RECORD.name}: {len(now)} names, {len(old - now)} gone")
