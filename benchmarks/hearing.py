"""Measure the share of visitors' sayings that is understood, by kind and language: known and held-back ones.

    python benchmarks/hearing.py                     # the words that come with Lumen, and the shipped tour
    python benchmarks/hearing.py --failed            # and which sayings were misunderstood; not those held back
    python benchmarks/hearing.py --tour FILE         # the tour on sayings in a file like benchmarks/hearing/tour.yaml
    python benchmarks/hearing.py --cost              # processor time of a text that was not heard before

A name is tried alone: a state that hears it and `else`. Every third saying is held back from who writes the word lists.
"""

import argparse
import statistics
import sys
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

import lumen
from lumen import statechart
from lumen.language.commands import Start
from lumen.language.events import Event
from lumen.talk.hearing import hearing_of

HERE = Path(__file__).parent / "hearing"
LANGUAGES = ("en", "id", "de")
HELD_BACK = 3
"""One of this many sayings is held back."""
PLACES = {"fine", "not_fine", "dance", "sing", "photo", "goodbye", "answer", "explain"}
"""The states of the tour to which a saying may lead."""


class Tried(NamedTuple):
    """A saying that was tried: its kind and language, whether it was held back, and whether it was understood.

    `wanted` is the expected result, and `found` the actual one.
    """

    kind: str
    language: str
    held_back: bool
    said: str
    wanted: Any
    found: Any
    right: bool


def words_tried(languages: Sequence[str], names: Sequence[str]) -> Iterator[Tried]:
    """Yield each saying for the names of Lumen's word lists; a `near` saying must not match the name."""
    for language in languages:
        for name, both in yaml.safe_load((HERE / f"{language}.yaml").read_text()).items():
            if names and name not in names:
                continue
            machine = statechart.Machine.from_dict(alone(name))
            for what in ("sayings", "near"):
                for number, saying in enumerate(both[what]):
                    text = saying["say"] if isinstance(saying, dict) else saying
                    wanted = saying["name"] if isinstance(saying, dict) else what == "sayings"
                    found = heard(machine, text)
                    right = same(found, wanted) if isinstance(saying, dict) else (found is not False) == wanted
                    kind = name if what == "sayings" else f"near {name}"
                    yield Tried(kind, language, held_back(number), text, wanted, found, right)


def alone(name: str) -> dict[str, Any]:
    """Return a behaviour that listens for one name."""
    row: dict[str, Any] = {"target": "hit"}
    if name == "my_name":
        row["actions"] = {"assign": {"caught": "heard.name"}}
    states = {"asked": {"hears": {name: row, "else": "missed"}}, "hit": {}, "missed": {}}
    return {"words": ["common"], "context": {"caught": ""}, "states": states}


def heard(machine: Any, text: str) -> Any:
    """Return False if the name was not recognized, else the captured value, or True."""
    after = statechart.step(machine, statechart.initial(machine).snapshot, Event("heard", {"result": text})).snapshot
    return "hit" in after.configuration and (after.context["caught"] or True)


def same(name: Any, wanted: Any) -> bool:
    """Return True if two names are equal, ignoring case because a recogniser writes no capitals."""
    return str(name).casefold() == str(wanted).casefold()


def held_back(number: int) -> bool:
    """Return True for every `HELD_BACK`th number."""
    return number % HELD_BACK == HELD_BACK - 1


class Tour:
    """The shipped tour, brought to the states in which it asks."""

    def __init__(self) -> None:
        self.machine = lumen.load(Path(__file__).parents[1]).machine
        begun = self.settled(statechart.initial(self.machine, language="en"))
        greeted = self.settled(statechart.step(self.machine, begun, Event("face", {"x": 0, "y": 0}, 1.0)))
        self.at = {"name": greeted}
        self.at["mood"] = self.settled(self.said(greeted, "My name is Bob"))
        self.at["offer"] = self.settled(self.said(self.at["mood"], "Fine"))
        self.at["language"] = self.at["offer"]
        for kind, state in (("name", "ask_name"), ("mood", "how_are_you"), ("offer", "offer")):
            if state not in self.at[kind].configuration:
                raise SystemExit(f"the tour is not in `{state}` but in {sorted(self.at[kind].configuration)}")

    def said(self, snapshot: Any, text: str) -> Any:
        """Return the step after a text was heard."""
        return statechart.step(self.machine, snapshot, Event("heard", {"result": text}, snapshot.at + 1))

    def settled(self, step: Any) -> Any:
        """Return the snapshot after the robot has finished all started commands, one after another."""
        waiting = list(step.commands)
        while waiting:
            command = waiting.pop(0)
            if isinstance(command, Start):
                event = Event(f"done.command.{command.id}", None, step.snapshot.at + 0.1)
                step = statechart.step(self.machine, step.snapshot, event)
                waiting += step.commands
        return step.snapshot

    def try_all(self, file: Path, *, all_known: bool) -> Iterator[Tried]:
        """Yield each saying of a file, tried on the tour."""
        for kind, by_language in yaml.safe_load(file.read_text()).items():
            for language, rows in by_language.items():
                for number, (text, wanted) in enumerate(rows):
                    found, right = self.tried(kind, language, text, wanted)
                    yield Tried(kind, language, not all_known and held_back(number), text, wanted, found, right)

    def tried(self, kind: str, language: str, text: str, wanted: Any) -> tuple[Any, bool]:
        """Return the result of a saying, and whether it is the right one."""
        step = self.said(self.at[kind]._replace(language=language), text)
        if kind == "name":
            found = step.snapshot.context["visitor"] or None
            return found, same(found, wanted)
        if kind == "language":
            found = step.snapshot.language
            return found, found == wanted
        entered = set(step.entered)
        found = ", ".join(
            sorted(entered & {"fine", "not_fine", "dance", "sing", "photo", "goodbye", "answer", "explain"})
        )
        if isinstance(wanted, str) and wanted.startswith("not "):
            return found, wanted.removeprefix("not ") not in entered
        return found, wanted in entered or (wanted == "answer" and "explain" in entered)


def table(tried: list[Tried]) -> Iterator[str]:
    """Yield the shares by kind and language, for known sayings and for those held back."""
    groups: dict[tuple[str, str], list[Tried]] = defaultdict(list)
    for one in tried:
        groups[one.kind, one.language].append(one)
        groups["all", "near" if one.kind.startswith("near ") else "sayings"].append(one)
    yield "| kind | language | known | held back |"
    yield "| --- | --- | --- | --- |"
    for (kind, language), several in groups.items():
        yield f"| {kind} | {language} | {share(several, held=False)} | {share(several, held=True)} |"


def share(tried: list[Tried], *, held: bool) -> str:
    """Return the share of right ones, as text; `-` if there are none to count."""
    of = [one.right for one in tried if one.held_back == held]
    return f"{sum(of)} of {len(of)}, {100 * sum(of) / len(of):.0f} %" if of else "-"


def cost() -> str:
    """Return the processor time to find the row of a new text among the tour's phrases [us]."""
    machine = lumen.load(Path(__file__).parents[1]).machine
    hearing = hearing_of(machine)
    texts = [
        row[0]
        for by_language in yaml.safe_load((HERE / "tour.yaml").read_text()).values()
        for rows in by_language.values()
        for row in rows
    ]
    row = next(number for number, block in hearing.blocks.items() if len(block) > 5)
    hearing.order(row, "something before", {})
    times = []
    for round_ in range(9):
        for text in texts:
            fresh = f"{text} {round_}"
            begin = time.process_time_ns()
            hearing.order(row, fresh, {})
            times.append((time.process_time_ns() - begin) / 1000)
    known, median = len(hearing.finder.phrases), statistics.median(times)
    return f"a new text against {known:,} phrases: {median:.0f} us, median of {len(times):,}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--failed", action="store_true", help="list what was misunderstood")
    parser.add_argument("--tour", type=Path, metavar="FILE", help="sayings to the tour, all of them known")
    parser.add_argument("--only", choices=("words", "tour"), help="only one of the two")
    parser.add_argument("--language", action="append", choices=LANGUAGES, help="only the words of this language")
    parser.add_argument("--name", action="append", default=[], help="only the words of this name")
    parser.add_argument("--cost", action="store_true", help="measure the processor time instead")
    options = parser.parse_args()
    if options.cost:
        print(cost())
        return 0
    if options.tour:
        parts = {"the tour": list(Tour().try_all(options.tour, all_known=True))}
    else:
        parts = (
            {}
            if options.only == "tour"
            else {"the words that come with Lumen": list(words_tried(options.language or LANGUAGES, options.name))}
        )
        if options.only != "words":
            parts["the tour"] = list(Tour().try_all(HERE / "tour.yaml", all_known=False))
    for title, tried in parts.items():
        print(f"{title}\n", *table(tried), "", sep="\n")
        for one in tried if options.failed else ():
            if not one.right and not one.held_back:
                print(f"{one.kind} {one.language}: {one.said!r} -> {one.found!r}, wanted {one.wanted!r}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
