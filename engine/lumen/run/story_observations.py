"""Observations while a story plays, and the expectations that they do not meet."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from functools import partial
from typing import Any, NamedTuple

from lumen.language.commands import Do
from lumen.language.events import FALLEN, Event
from lumen.language.machines import MachineDefinition
from lumen.language.stories import Expect, Happen, SetSkills, Story


class UnmetExpectation(NamedTuple):
    """An unmet expectation and the actual outcome, in words."""

    expected: str
    was: str
    state: bool = False
    """Whether a state was missing."""


@dataclass
class StoryObservations:
    """The present state of an exhibition, and what happened since the last expectation that was met."""

    states: frozenset[str] = frozenset()
    """The names of the active states."""
    context: dict[str, object] = field(default_factory=dict)
    """The behaviour's context."""
    place: str = ""
    """The robot's place; empty if the robot is at none."""
    said: list[str] = field(default_factory=list)
    """Texts that the robot began to say."""
    played: list[str] = field(default_factory=list)
    """Motions that ended."""
    did: list[Do] = field(default_factory=list)
    """The skills that ended."""
    published: list[tuple[str, Any]] = field(default_factory=list)
    """Messages that were sent, with their routes."""
    playing: dict[str, str] = field(default_factory=dict)
    """Motions under way, by id."""
    doing: dict[str, Do] = field(default_factory=dict)
    """The skills under way, by id."""
    asked: str = ""
    """The id of the question that was not answered yet; empty for none."""
    _compared: tuple[object, ...] = ()
    """The values that `unmet` compared last: a story asks twice a tick, and most ticks change nothing."""
    _lacking: tuple[UnmetExpectation, ...] = ()

    def unmet(self, expected: Expect) -> tuple[UnmetExpectation, ...]:
        """Return everything in `expected` that is not met now."""
        observed = len(self.said), len(self.played), len(self.did), len(self.published)
        compared = (expected, self.states, self.context, self.place, *observed)
        if compared != self._compared:
            self._compared, self._lacking = compared, tuple(self._unmet(expected))
        return self._lacking

    def _unmet(self, expected: Expect) -> Iterator[UnmetExpectation]:
        if missing := [s for s in expected.states if s not in self.states]:
            yield UnmetExpectation(f"state `{missing[0]}`", f"the active states are {listed(self.states)}", state=True)
        if expected.place is not None and expected.place != self.place:
            yield UnmetExpectation(f"the robot to be at `{expected.place}`", f"it is {_at(self.place)}")
        part, whole = expected.said, expected.said_exactly
        if part is not None and not any(part.lower() in text.lower() for text in self.said):
            yield UnmetExpectation(f"to hear “{part}”", f"it said {_texts(self.said, part)}")
        if whole is not None and whole not in self.said:
            yield UnmetExpectation(f"to hear exactly “{whole}”", f"it said {_texts(self.said, whole)}")
        if expected.played is not None and expected.played not in self.played:
            yield UnmetExpectation(f"the motion `{expected.played}`", f"it played {listed(self.played)}")
        for lack in (self._undone(expected), self._unsent(expected), self._unlike(expected.context)):
            if lack:
                yield lack

    def _undone(self, expected: Expect) -> UnmetExpectation | None:
        verb, wanted = expected.did, expected.arguments
        if verb is None or any(done.skill == verb and _holds(done.arguments, wanted) for done in self.did):
            return None
        with_arguments = f" with {dict(wanted)!r}" if wanted else ""
        did = "; ".join(f"`{done.skill}` with {dict(done.arguments)!r}" for done in self.did)
        return UnmetExpectation(f"the robot to finish `{verb}`{with_arguments}", f"it finished {did or 'nothing'}")

    def _unsent(self, expected: Expect) -> UnmetExpectation | None:
        route, body = expected.published, expected.body
        if route is None or any(name == route and _holds(sent, body) for name, sent in self.published):
            return None
        wanted = f" with {body!r}" if body is not None else ""
        sent = "; ".join(f"{sent!r} on `{name}`" for name, sent in self.published)
        return UnmetExpectation(f"a message on `{route}`{wanted}", f"it sent {sent or 'nothing'}")

    def _unlike(self, context: Mapping[str, Any]) -> UnmetExpectation | None:
        for key, value in context.items():
            if self.context.get(key) != value:
                return UnmetExpectation(f"{key} = {value!r}", f"it is {self.context.get(key)!r}")
        return None

    def hear(self, event: Event | None) -> None:
        """Record that the question is answered if this event answers it; a filler is no answer."""
        if event and self.asked and event.name.endswith(f".command.{self.asked}"):
            self.asked = self.asked if event.data and event.data.get("filler") else ""

    def forget(self) -> None:
        """Delete the texts, motions, skills and messages observed so far."""
        self.said, self.played, self.did, self.published = [], [], [], []
        self._compared = ()


def expects_fall(story: Story, machine: MachineDefinition) -> bool:
    """Return whether a story includes a fall: as an event, or by expecting a state to which a fall leads."""
    answers = {
        machine.states[target].name
        for state in machine.states.values()
        for transition in state.transitions
        if transition.event == FALLEN
        for target in transition.targets
    }
    actions = [step.action for step in story.steps]
    return any(isinstance(a, Happen) and a.name == FALLEN for a in actions) or any(
        isinstance(a, Expect) and not answers.isdisjoint(a.states) for a in actions
    )


def expects_error(story: Story, machine: MachineDefinition) -> bool:
    """Return whether a story includes an error of a `do`.

    The story sets an error, or expects a state to which only errors lead.
    """
    transitions = [t for m in (machine, *machine.invoked.values()) for s in m.states.values() for t in s.transitions]
    names = {path: state.name for m in (machine, *machine.invoked.values()) for path, state in m.states.items()}
    failed, other = set[str](), set[str]()
    for transition in transitions:
        into = failed if transition.event.startswith("error.") else other
        into.update(names[target] for target in transition.targets)
    expected = {s for step in story.steps if isinstance(step.action, Expect) for s in step.action.states}
    ends = [end for step in story.steps if isinstance(step.action, SetSkills) for end in step.action.ends.values()]
    return bool(story.robot) or "fails" in ends or any(name.rpartition("/")[2] in failed - other for name in expected)


def _holds(body: Any, wanted: Any) -> bool:
    """Return whether a body has everything wanted: the given keys of a map with these values, or an equal value."""
    if isinstance(wanted, Mapping) and isinstance(body, Mapping):
        return all(key in body and _holds(body[key], value) for key, value in wanted.items())
    return wanted is None or bool(body == wanted)


def listed(names: object) -> str:
    """Return names as `a`, `b`, sorted; `nothing` if there are none."""
    all_of_them = ", ".join(f"`{n}`" for n in sorted(names))  # type: ignore[call-overload]
    return all_of_them or "nothing"


def _at(place: str) -> str:
    return f"at `{place}`" if place else "at none of the project's places"


def _texts(texts: list[str], wanted: str) -> str:
    """Return the texts that were said; if there are several, also the one most like the wanted text."""
    shown = "; ".join(f"“{t}”" for t in texts) or "nothing"
    return f"{shown}; the nearest is “{max(texts, key=partial(_likeness, wanted))}”" if len(texts) > 1 else shown


def _likeness(wanted: str, text: str) -> int:
    """Return the number of letters that a text shares with the wanted one, in runs of three or more."""
    blocks = SequenceMatcher(None, wanted.lower(), text.lower(), autojunk=False).get_matching_blocks()
    return sum(block.size for block in blocks if block.size > 2)
