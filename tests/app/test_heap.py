"""Memory that a long run has freed is given back to the system."""

import platform
import sys

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
