"""Machine code is linked wherever memory is left."""

import sys

from patience import completed

SCATTERED = """
import mmap, re
import tandemlift as tl
from tandemlift.simulation.plan import FlightPlan
from tandemlift.compiler.machine_code import machine

loop_code = FlightPlan(tl.load_mission("hover", {"mission.duration": 0.1})).loop_code
text = loop_code.written("loop", 1).text
code, names = machine.compiled(text, machine.QUICK), re.findall(r"define i64 @(\\w+)\\(", text)
RESERVED_ONLY = 0x4000  # MAP_NORESERVE of Linux
LAZY, kept = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | RESERVED_ONLY, []
for i in range(100):  # holes of all sizes, 3 GiB apart
    kept.append(mmap.mmap(-1, 3 << 30, flags=LAZY))
    hole = mmap.mmap(-1, mmap.PAGESIZE * (1 + 7 * i), flags=LAZY)
    kept.append(mmap.mmap(-1, 3 << 30, flags=LAZY))
    hole.close()
    kept.append(machine.Loaded(code, names))
print("linked")
"""


def test_code_links_where_free_memory_is_scattered_over_more_than_what_a_relative_address_reaches():
    done = completed([sys.executable, "-W", "ignore", "-c", SCATTERED], capture_output=True, text=True)
    assert (done.returncode, done.stdout.strip()) == (0, "linked"), done.stderr[-2000:]
