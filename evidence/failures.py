"""The failures and findings among the flights of a study, each with its row, and the bound on a failure's probability.

python evidence/failures.py FOLDER

The study may still be unfinished: what its folder holds is counted. `tandemlift run --from FOLDER --row N` flies a
row again.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from pathlib import Path

from pyarrow import parquet

from tandemlift.analysis.studies.design.settings import REFUSED
from tandemlift.analysis.studies.execution.random_flights import probability_bound
from tandemlift.core.phases import FAILURES

COLUMNS = ["row", "outcome", "reason", "findings"]


def main() -> None:
    """Count and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="of a study that keeps outcome and findings")
    given = parser.parse_args()
    files = sorted((given.folder / "chunks").glob("*.parquet"))
    rows = sorted(
        (row for file in files for row in parquet.read_table(file, columns=COLUMNS).to_pylist()), key=lambda r: r["row"]
    )
    failed = [row for row in rows if row["outcome"] in (*FAILURES, REFUSED)]
    for row in failed:
        print(f"row {row['row']}: {row['outcome']}: {row['reason']}")
    kinds = Counter[str]()
    for row in rows:
        findings = json.loads(row["findings"] or "[]")
        kinds.update({kind for _, kind, _ in findings})
        for time, kind, text in findings:
            print(f"row {row['row']}, at {time:g} s: {kind}: {text}")
    bound = probability_bound(len(failed), len(rows))
    print(f"{len(failed)} of {len(rows)} flights failed: a probability of at most {bound:.3g}, with 95 % confidence")
    print(f"outcomes: {dict(Counter(row['outcome'] for row in rows))}")
    print(f"flights with findings: {dict(kinds)}")


if __name__ == "__main__":
    main()
