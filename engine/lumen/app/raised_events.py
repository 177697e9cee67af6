"""Events that a person lets happen: each is taken as any other, and whoever asked hears what became of it."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from lumen.interpreters.statechart import Step
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.ports import Message
from lumen.runtime.loop import BehaviorLoop, Observer

SOMEBODY = "somebody"
MAX_NAME = 100
"""Characters of the name of an event, and of a person."""
_INTERNAL = ("done.", "error.", "cancelled.", "lost.")
"""How the names of answers begin: an event of such a name would be taken for one."""

Reply = Callable[[Message, Mapping[str, Any]], None]


def person_in(body: Mapping[str, Any]) -> str:
    """Who asks, as far as that is said."""
    by = body.get("by")
    return str(by)[:MAX_NAME] if by else SOMEBODY


def refusal(reason: str) -> dict[str, Any]:
    return {"verdict": "refused", "reason": reason}


class _Raised(NamedTuple):
    message: Message
    cause: Cause


class RaisedEvents(Observer):
    """Lets events happen for who asks; `reply` is called with what became of each.

    An event is known again by its very cause, which no other has.
    """

    def __init__(self, loop: BehaviorLoop, reply: Reply) -> None:
        self._loop, self._reply = loop, reply
        self._open: list[_Raised] = []

    def happen(self, message: Message, now: float) -> None:
        """Let the event in that message happen in this tick; it is refused where it can't be one."""
        match message.body:
            case {"event": str(name), **more} if name and len(name) <= MAX_NAME:
                if name.startswith(_INTERNAL):
                    self._reply(message, refusal(f"`{name}` is not for people: only the robot says what is done"))
                    return
                cause = Cause("person", message.id, sender=person_in(message.body))
                self._open.append(_Raised(message, cause))
                self._loop.happen(Event(name, more.get("data"), now, cause=cause))
            case _:
                self._reply(message, refusal("`event` is the name of an event"))

    def look(self) -> None:
        """Say of those that were not stepped that they were not: nothing waits any more."""
        if self._open and not self._loop.waiting:
            for one in self._open:
                self._reply(one.message, refusal("the behaviour could not take it: its log says why"))
            self._open.clear()

    def stepped(self, step: Step) -> None:
        for one in self._open:
            if step.event and step.event.cause is one.cause:
                self._open.remove(one)
                self._reply(one.message, {"verdict": "done", "taken": takes(step)})
                return


def takes(step: Step) -> bool:
    """Whether a transition was taken, here or in an invoked behaviour, for what happened."""
    return bool(step.transitions) or any(takes(inner) for _, inner in step.invoked)
