"""Memory: what a long run has freed is given back to the system, and what a closed exhibition leaves is found."""

import gc
import platform
import sys

import lumen
from lumen.upkeep.garbage import NEVER, GcScheduler
from tests import ROOT
from tests.guarded import run_guarded

SCATTERED = """
from lumen.upkeep.heap import give_back
{first}
def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4 // 1024
large = bytearray(30_000_000)  # glibc takes what is smaller from its heap, once this is freed
del large
before, kept, blocks = resident(), [], []
for n in range(300):
    blocks.append(bytearray(200_000))
    kept.append(bytearray(2_000))
blocks.clear()
print(resident() - before)
"""


def test_what_is_freed_is_given_back() -> None:
    def grown(first: str) -> int:
        return int(run_guarded([sys.executable, "-c", SCATTERED.format(first=first)], capture_output=True).stdout)

    if platform.libc_ver()[0] == "glibc":  # others have no such limits
        assert grown("give_back()") <= 5 < 40 <= grown("")


def test_what_an_exhibition_leaves_is_searched_for_garbage_after_the_next_one_ran() -> None:
    """A program that opens one after another would otherwise keep something of each."""
    frozen = []
    for _ in range(3):
        with lumen.open(ROOT / "examples/minimal", robot="recording") as exhibition:
            exhibition.run(seconds=0.1)
        frozen.append(gc.get_freeze_count())
    assert frozen == sorted(frozen, reverse=True)


def test_python_searches_by_itself_again_after_the_last_of_two_exhibitions() -> None:
    usual = gc.get_threshold()
    first, second = GcScheduler(), GcScheduler()
    for each in (first, second):
        assert gc.get_threshold() == (*usual[:2], NEVER)
        each.close()
    assert gc.get_threshold() == usual
