"""One-line reports of events that changed nothing; frequent ones are reported once."""

import json
import re
from typing import Any

from lumen.insight.explaining.ignored_events import FalseGuard, IgnoredEvent, ignored
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.run.visitor import SPEECH_ROUTE
from lumen.statechart import Step

_TIME = re.compile(r"(after|at)\.(.+)\.[^.]*")
"""The names of the events of `after` and `at`; the groups are the key and the time."""
_ENDS = {
    f"{kind}.{what}.": key
    for kind, key in (("done", "onDone"), ("error", "onError"))
    for what in ("do", "state", "invoke")
}
"""The keys in the file for the ends of actions, states and invocations, by the prefixes of the events' names."""

BURST = 1.0
"""The time within which another event with the same name and texts is not reported [s]."""
MAX_GUARDS = 3
"""The number of false guards that a line shows."""
MAX_VALUE = 40
"""The number of characters of a value that a line shows."""
MAX_REMEMBERED = 1_000
"""The number of events that are remembered to recognize bursts; at that number all are forgotten."""


class IgnoredEvents:
    """The reports on steps whose event changed nothing.

    A face is seen many times a second, and few states use it, so an event is not reported soon after a similar one.
    """

    def __init__(self) -> None:
        self._last: dict[tuple[str, tuple[str, ...]], float] = {}

    def line(self, machine: MachineDefinition, step: Step) -> str:
        """Return a line such as `“dance” while goodbye does not listen`.

        Return an empty string if the step changed something, or a similar event came just before.
        """
        if step.event is None or self._follows(step.event, step.snapshot.at):
            return ""
        found = ignored(machine, step)
        return _words(found) if found else ""

    def _follows(self, event: Event, at: float) -> bool:
        texts = tuple(v for v in event.data.values() if isinstance(v, str)) if isinstance(event.data, dict) else ()
        if len(self._last) >= MAX_REMEMBERED:
            self._last.clear()
        before, self._last[event.name, texts] = self._last.get((event.name, texts)), at
        return before is not None and at - before < BURST


def _words(found: IgnoredEvent) -> str:
    what = _shown(found.event)
    if found.deaf:
        return f"{what} while {' and '.join(found.deaf)} {'does' if len(found.deaf) == 1 else 'do'} not listen"
    false = [_false(guard, found.event) for guard in found.refused[:MAX_GUARDS]]
    more = len(found.refused) - len(false)
    nothing = [f"no row of {state} matches" for state in found.unheard]
    return f"{what} while {', and '.join([*nothing, *false])}" + (
        f", and {more} more {'guard is' if more == 1 else 'guards are'} false" if more else ""
    )


def _false(guard: FalseGuard, event: Event) -> str:
    said = _said(event)
    news = {name: value for name, value in guard.values.items() if not said or value != said}
    values = guard.why or ", ".join(f"{name} is {_value(value)}" for name, value in news.items())
    return f"{guard.guard.shown} is false in {guard.state}" + (f" ({values})" if values else "")


def _shown(event: Event) -> str:
    if said := _said(event):
        return f"“{said}”"
    if found := _TIME.fullmatch(event.name):
        return f"{found[1]} {found[2]}"
    return next((key for begin, key in _ENDS.items() if event.name.startswith(begin)), event.name)


def _said(event: Event) -> str:
    """Return a visitor's words if the event is speech, else an empty string."""
    said = event.data.get("result") if event.name == SPEECH_ROUTE and isinstance(event.data, dict) else None
    return said if isinstance(said, str) else ""


def _value(value: Any) -> str:
    text = f"'{value}'" if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= MAX_VALUE else f"{text[: MAX_VALUE - 1]}…"
