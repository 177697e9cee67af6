"""Run all attacks, the lanes in parallel, and narrow a batch that breaks its target to the attacks responsible."""

import time
from collections import Counter
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from tests.attack.attacks import attack, batches
from tests.attack.lanes import Lane, lanes
from tests.attack.targets import BrokenError, Size

BOUND = Size(memory=16.0, threads=0, handles=0)
"""The growth allowed to a process after it has settled."""
SETTLED, LAST = 5, 3
"""The number of first checks, at least a quarter of all, with which the last ones are compared; and of these last ones.

Imported files vary in size, and the process stays as large as the largest one needed: it levels off within about 1,500.
"""


@dataclass
class Trouble:
    """A fault of a target, with the smallest group of attacks found to cause it by itself."""

    numbers: list[int]
    text: str


@dataclass
class Survey:
    """The results of the attacks through one lane."""

    name: str
    count: int = 0
    checks: int = 0
    seconds: float = 0.0
    outcomes: Counter[str] = field(default_factory=Counter)
    sizes: list[Size] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)

    @property
    def growth(self) -> Size:
        """Return the growth from the largest of the first sizes to the smallest of the last ones; peaks don't count."""
        if not self.sizes:
            return Size(0.0, 0, 0)
        settled = max(SETTLED, len(self.sizes) // 4)
        first = zip(*self.sizes[:settled], strict=True)
        last = zip(*(self.sizes[settled:] or self.sizes)[-LAST:], strict=True)
        return Size(*(min(ends) - max(begins) for begins, ends in zip(first, last, strict=True)))


def grown(found: Survey) -> list[str]:
    """Return a line for each resource of a lane's target that grew beyond `BOUND`."""
    return [
        f"{found.name}: {more:+.0f} {what}, at most {most:+.0f}"
        for what, more, most in zip(Size._fields, found.growth, BOUND, strict=True)
        if more > most
    ]


def survey(numbers: Iterable[int], url: str) -> list[Survey]:
    """Run these attacks, all lanes in parallel, and return a survey of each lane; `url` is a broker's."""
    kinds = {number: attack(number).kind for number in numbers}
    found = {
        name: ([number for number, kind in kinds.items() if kind in taken], begin)
        for name, (taken, begin) in lanes(url).items()
    }
    with ThreadPoolExecutor(len(found)) as pool:
        running = [pool.submit(surveyed, name, mine, begin) for name, (mine, begin) in found.items() if mine]
        return [one.result() for one in running]


def surveyed(name: str, numbers: list[int], begin: Callable[[], Lane]) -> Survey:
    """Run these attacks through one lane; replace its target after each batch that breaks it."""
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
    """Return the outcome of each attack; raise BrokenError if the target no longer works after them."""
    came = [target.strike(attack(number)) for number in batch]
    target.check()
    return came


def narrowed(batch: list[int], text: str, begin: Callable[[], Lane]) -> Trouble:
    """Return the fault of the smallest part of the batch that still breaks a new target, found by halving the batch."""
    half = len(batch) // 2
    for part in (batch[:half], batch[half:]):
        if part and half and (again := broken_by(part, begin)):
            return narrowed(part, again, begin)
    return Trouble(batch, text)


def broken_by(batch: list[int], begin: Callable[[], Lane]) -> str:
    """Return the fault that these attacks cause in a new target, or an empty string if it survives."""
    target = begin()
    try:
        struck(target, batch)
    except BrokenError as broken:
        return str(broken)
    finally:
        target.close()
    return ""
