"""An exhibition's current activity: when each state became active, what the robot says and does, and what it heard."""

import re
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from lumen.language.commands import Ask, Command, GoTo, Move, Play, Posture, Rest, Say, Start, VerbCommand, Wake, Walk
from lumen.language.events import Event
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.language.verbs import verb_of
from lumen.ports import Message
from lumen.robot.command_table import speech_duration
from lumen.run.approvals import HeldEvent
from lumen.run.loop import Observer
from lumen.run.visitor import SPEECH_ROUTE
from lumen.statechart import Snapshot, Step
from lumen.statechart.nesting import active_names, entered_names

_OWN = re.compile(r"(.*\.)?[cd]\d+(@.*)?")
"""The id of a command of the behaviour, also with the suffix it has between processes."""
MAX_UNDER_WAY = 200
"""The number of unfinished commands of a kind that are remembered; if there are more, the oldest are forgotten."""


class UnderWay(NamedTuple):
    """A text that is being said, or a motion under way."""

    what: str
    """The verb."""
    name: str
    """The text, or the name of the motion or posture."""
    since: float
    """When the activity began [s]."""
    seconds: float | None = None
    """The duration of the activity [s]; None if unknown."""
    language: str = ""
    """The language of a text."""


class Spoken(NamedTuple):
    """The last words of a visitor."""

    text: str
    at: float
    """When the words were said [s]."""


class ActivityTracker(Observer):
    """An observer that records the current activity.

    `project`, `snapshot` and `now` return the bundle, the snapshot (None before the start) and the time [s]. A command
    that waits for another of its kind counts as begun when the earlier command ends.
    """

    def __init__(
        self, project: Callable[[], Project], snapshot: Callable[[], Snapshot | None], now: Callable[[], float]
    ) -> None:
        self._project, self._snapshot, self._now = project, snapshot, now
        self._last: Snapshot | None = None
        self.since: dict[str, float] = {}
        """When each active state became active [s], by name."""
        self.heard: Spoken | None = None
        """The last words that a visitor said; None until a visitor has spoken."""
        self._speaking: dict[str, UnderWay] = {}
        self._moving: dict[str, UnderWay] = {}
        self._others: dict[str, None] = {}
        self.told: deque[Message] = deque(maxlen=MAX_UNDER_WAY)
        """Texts for the robot that arrived on the bus; any thread may append a message."""

    @property
    def saying(self) -> UnderWay | None:
        """The text that is being said; None if there is none.

        A text that does not come from the behaviour is dropped after its expected duration, because its end is not
        reported.
        """
        for id, said in tuple(self._speaking.items()):
            if said.seconds is None or self._now() - said.since < said.seconds:
                return said
            self._end(self._speaking, id)
        return None

    @property
    def motion(self) -> UnderWay | None:
        """The oldest motion under way; None if there is none."""
        return next(iter(self._moving.values()), None)

    @property
    def commands(self) -> int:
        """The number of unfinished commands."""
        return len(self._speaking) + len(self._moving) + len(self._others)

    def look(self) -> None:
        """Read the texts from the bus, and update the active states after a reload; call this before each tick."""
        while self.told:
            self._hear(self.told.popleft())
        now = self._snapshot()
        if now is not None and now is not self._last:
            self._last = now
            names = active_names(now)
            self.since = {name: self.since.get(name, now.at) for name in names}

    def stepped(self, step: Step) -> None:
        self._last = step.snapshot
        if step.exited or step.entered or step.invoked:
            came, names = set(entered_names(step)), active_names(step.snapshot)
            at, since = step.snapshot.at, self.since
            self.since = {name: at if name in came else since.get(name, at) for name in names}
        if step.event and (said := self._words(step.event)):
            self.heard = Spoken(said, step.event.at)

    def approval(self, how: str, held: HeldEvent, why: str) -> None:
        """Record a visitor's words when their event starts to wait: they were said, whether or not it is approved."""
        if how == "waits" and (said := self._words(held.event)):
            self.heard = Spoken(said, held.event.at)

    def performing(self, command: Command, now: float) -> None:
        if not isinstance(command, Start):
            return
        match command.command:
            case Say(text, language):
                self._begin(self._speaking, command.id, UnderWay("say", text, now, None, language))
            case Play() | Posture() | Walk() | Move() | GoTo() | Rest() | Wake() as moves:
                self._begin(self._moving, command.id, self._moves(moves, now))
            case Ask():
                return
            case other if not verb_of(other).instant:
                self._others[command.id] = None
                _keep_few(self._others)

    def answered(self, event: Event) -> None:
        _kind, separator, id = event.name.partition(".command.")
        if separator:
            self._others.pop(id, None)
            self._end(self._speaking, id)
            self._end(self._moving, id)

    def forget(self, person: PersonName) -> None:
        """Forget the texts said and heard, because they may contain the person's name."""
        self.heard = None
        self._speaking.clear()

    def _hear(self, message: Message) -> None:
        """Record a text that did not come from the behaviour; its end is never reported, so it is estimated."""
        body = message.body
        if isinstance(body, dict) and not _OWN.fullmatch(message.cause) and (text := str(body.get("text") or "")):
            said = UnderWay("say", text, self._now(), speech_duration(text), str(body.get("language") or ""))
            self._begin(self._speaking, f"said {message.id}", said)

    def _words(self, event: Event) -> str:
        """Return a visitor's words if the event belongs to the route `speech`, else an empty string."""
        route = self._project().routes.get(SPEECH_ROUTE)
        if route is None or event.name != route.event or not isinstance(event.data, Mapping):
            return ""
        return str(event.data.get("result") or "")

    def _moves(self, command: VerbCommand, now: float) -> UnderWay:
        verb, motions = verb_of(command).name, self._project().motions
        match command:
            case Play(name):
                return UnderWay(verb, name, now, motions[name].duration if name in motions else None)
            case Posture(name) | GoTo(name):
                return UnderWay(verb, name, now)
        return UnderWay(verb, "", now)

    def _begin(self, all: dict[str, UnderWay], id: str, what: UnderWay) -> None:
        all[id] = what
        _keep_few(all)

    def _end(self, all: dict[str, UnderWay], id: str) -> None:
        """Remove a command; if it was the first of its kind, the next one begins now."""
        was_first = next(iter(all), None) == id
        if all.pop(id, None) is not None and was_first and all:
            first = next(iter(all))
            all[first] = all[first]._replace(since=max(all[first].since, self._now()))


def _keep_few(all: dict[str, Any]) -> None:
    if len(all) > MAX_UNDER_WAY:
        del all[next(iter(all))]
