"""What an exhibition is busy with: since when each state is active, what is said, moved and heard, and what waits."""

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
"""The id of a command of the behaviour, as it travels between processes, too."""
MAX_UNDER_WAY = 200
"""Commands that are remembered as not over; of more, the oldest is forgotten."""


class UnderWay(NamedTuple):
    """A text, or a motion by its verb and name, since a time [s]; `seconds` it takes, None where nobody knows."""

    what: str
    name: str
    since: float
    seconds: float | None = None
    language: str = ""


class Spoken(NamedTuple):
    """What a visitor said, at `at` [s]."""

    text: str
    at: float


class Doings(Observer):
    """Notes what happens; `project` is asked for the bundle, `snapshot` for where it stands, `now` for the time [s].

    A command that waits for another of its kind counts from when that one has ended. `told` takes the texts on the bus
    that robots say, on any thread.
    """

    def __init__(
        self, project: Callable[[], Project], snapshot: Callable[[], Snapshot | None], now: Callable[[], float]
    ) -> None:
        self._project, self._snapshot, self._now = project, snapshot, now
        self._last: Snapshot | None = None
        self.since: dict[str, float] = {}
        self.heard: Spoken | None = None
        self._speaking: dict[str, UnderWay] = {}
        self._moving: dict[str, UnderWay] = {}
        self._others: dict[str, None] = {}
        self.told: deque[Message] = deque(maxlen=MAX_UNDER_WAY)

    @property
    def saying(self) -> UnderWay | None:
        """What is said now; of what nobody says the end, as long as it takes at most."""
        for id, said in tuple(self._speaking.items()):
            if said.seconds is None or self._now() - said.since < said.seconds:
                return said
            self._end(self._speaking, id)
        return None

    @property
    def motion(self) -> UnderWay | None:
        """The motion under way that was asked for first."""
        return next(iter(self._moving.values()), None)

    @property
    def commands(self) -> int:
        """How many commands are not over."""
        return len(self._speaking) + len(self._moving) + len(self._others)

    def look(self) -> None:
        """Note where the behaviour stands before a tick: elsewhere than after its last step, it was reloaded."""
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
        """A visitor's words are heard before a person decides what comes of them."""
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
        """Forget what was said and heard, which may contain the name."""
        self.heard = None
        self._speaking.clear()

    def _hear(self, message: Message) -> None:
        """Somebody else than the behaviour lets the robot say something: nobody says when that has ended."""
        body = message.body
        if isinstance(body, dict) and not _OWN.fullmatch(message.cause) and (text := str(body.get("text") or "")):
            said = UnderWay("say", text, self._now(), speech_duration(text), str(body.get("language") or ""))
            self._begin(self._speaking, f"said {message.id}", said)

    def _words(self, event: Event) -> str:
        """What a visitor said, if that is what the event is."""
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
        """One has ended; where it was the first, the next of its kind begins."""
        was_first = next(iter(all), None) == id
        if all.pop(id, None) is not None and was_first and all:
            first = next(iter(all))
            all[first] = all[first]._replace(since=max(all[first].since, self._now()))


def _keep_few(all: dict[str, Any]) -> None:
    if len(all) > MAX_UNDER_WAY:
        del all[next(iter(all))]
