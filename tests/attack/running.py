"""All attacks, each through its lane and all lanes at once; where a batch breaks its target, which of it did."""

import time
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from tests.attack.attacks import attack, batches
from tests.attack.lanes import Lane, lanes
from tests.attack.targets import BrokenError, Size

BOUND = Size(memory=16.0, threads=0, handles=0)
"""What a process may have more at the end than when it was settled."""
SETTLED, LAST = 5, 3
"""After so many checks, or a quarter of all, everything was used once; that many at the end are compared with these.

What imports read is of all sizes, and the process is as large as the largest needed: it levels off within some 1,500.
"""


@dataclass
class Trouble:
    """What broke a target: the fewest numbers that do so alone."""

    numbers: list[int]
    text: str


@dataclass
class Survey:
    """What came of the attacks through a lane."""

    name: str
    count: int = 0
    checks: int = 0
    seconds: float = 0.0
    outcomes: Counter[str] = field(default_factory=Counter)
    sizes: list[Size] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)

    @property
    def growth(self) -> Size:
        """From the largest of the first sizes to the smallest of the last ones: what comes and goes is no growth."""
        if not self.sizes:
            return Size(0.0, 0, 0)
        settled = max(SETTLED, len(self.sizes) // 4)
        first = zip(*self.sizes[:settled], strict=True)
        last = zip(*(self.sizes[settled:] or self.sizes)[-LAST:], strict=True)
        return Size(*(min(ends) - max(begins) for begins, ends in zip(first, last, strict=True)))


def grown(found: Survey) -> list[str]:
    """What of a lane's target grew beyond `BOUND`."""
    return [
        f"{found.name}: {more:+.0f} {what}, at most {most:+.0f}"
        for what, more, most in zip(Size._fields, found.growth, BOUND, strict=True)
        if more > most
    ]


def survey(numbers: Iterable[int], url: str) -> list[Survey]:
    """What came of those attacks, by lane; `url` is a broker's."""
    kinds = {number: attack(number).kind for number in numbers}
    found = {
        name: ([number for number, kind in kinds.items() if kind in taken], begin)
        for name, (taken, begin) in lanes(url).items()
    }
    with ThreadPoolExecutor(len(found)) as pool:
        running = [pool.submit(surveyed, name, mine, begin) for name, (mine, begin) in found.items() if mine]
        return [one.result() for one in running]


def surveyed(name: str, numbers: list[int], begin: Callable[[], Lane]) -> Survey:
    """What came of those through one lane; after a batch that broke its target there is a new one."""
    found, began = Survey(name), time.monotonic()
    target = begin()
    try:
        for batch in batches(numbers, target.batch):
            try:
                found.outcomes.update(struck(target, batch))
                found.sizes.append(target.size())
            except BrokenError as broken:
                target.close()
                found.troubles.append(narrowed(batch, str(broken), begin))
                target = begin()
            found.count += len(batch)
            found.checks += 1
    finally:
        target.close()
    found.seconds = time.monotonic() - began
    return found


def struck(target: Lane, batch: list[int]) -> list[str]:
    """What became of each; raises BrokenError where the target does not stand them."""
    came = [target.strike(attack(number)) for number in batch]
    target.check()
    return came


def narrowed(batch: list[int], text: str, begin: Callable[[], Lane]) -> Trouble:
    """The half of a batch that breaks a new target, its half, and so on; all of it where neither does alone."""
    half = len(batch) // 2
    for part in (batch[:half], batch[half:]):
        if part and half and (again := broken_by(part, begin)):
            return narrowed(part, again, begin)
    return Trouble(batch, text)


def broken_by(batch: list[int], begin: Callable[[], Lane]) -> str:
    """What these do to a new target; empty where it stands them."""
    target = begin()
    try:
        struck(target, batch)
    except BrokenError as broken:
        return str(broken)
    finally:
        target.close()
    return ""
