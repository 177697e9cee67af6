"""Visitors' questions: answered from the known passages, else by the module `answers`, else not at all."""

import logging
from collections import deque
from collections.abc import Callable, Mapping
from datetime import date
from math import inf
from time import time
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import BusError
from lumen.expressions.json_schema import JsonSchema
from lumen.insight.replay.visits import waiting_state
from lumen.language.causes import Cause, MessageOrigin
from lumen.language.commands import Ask
from lumen.language.events import Event
from lumen.language.modules import ANSWERS
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.retrieval.ranking import Weights
from lumen.statechart import Step

if TYPE_CHECKING:
    from lumen.retrieval.retriever import Retriever

ASK_ROUTE, ANSWER_ROUTE = "ask", "answer"
STRICT = Weights((2.5, 15.0, 5.5), none=6.5, least=0.9)
"""The weights for a language without trial questions in the project, similar to those of the shipped examples."""
MAX_ANSWERS = 100
"""The number of answers that may wait for a tick; one more drops the oldest."""
MAX_PASSAGES = 3
"""The number of passages that a language model receives."""
FILLER_AFTER = 1.5
"""The delay of the filler if the project does not set it [s]."""
SAID = ("text", "language", "source", "confidence", "passage", "more")
"""The fields that are copied from an answer."""
NOBODY = "no answer was found"

_log = logging.getLogger(__name__)


class OpenQuestion(NamedTuple):
    """A question that was sent to the module `answers`."""

    offers: Mapping[str, Any]
    """The events that the answer may raise, with the schemas of their data."""
    language: str
    filler_at: float
    """When the filler is due [s]; infinite if none is due."""


class Questions:
    """The open questions; their answers become events at the next tick.

    Passages are searched here: that takes less than a millisecond and needs no module. `visit` counts the visits.
    `today` returns the date on which passages must be valid (None: any), `offers` the events that a language model may
    raise now.
    """

    def __init__(
        self, bus: Bus, today: Callable[[], date | None] = lambda: None, offers: Callable[[], Mapping[str, Any]] = dict
    ) -> None:
        self._bus, self._today, self._offers = bus, today, offers
        self.visit, self._home = 0, ""
        self.silenced = ""
        """The person who silenced the language model; empty if the model may speak.

        While it is silenced, no questions are sent, and answers are ignored.
        """
        self._fillers: Mapping[str, str] = {}
        self._patience = FILLER_AFTER
        self._open: dict[str, OpenQuestion] = {}
        self._received: deque[tuple[Message, float]] = deque(maxlen=MAX_ANSWERS)
        self._key = ""
        self._undo: Callable[[], None] = _nothing
        self._retriever: Retriever | None = None
        self._weights = STRICT
        self._known: tuple[object, ...] = ()

    def listen(self, project: Project) -> None:
        """Subscribe to the answers of the project's module `answers`, and read its filler; without it, unsubscribe."""
        options = project.modules[ANSWERS].options if ANSWERS in project.modules else {}
        filler = options.get("filler") or {}
        self._fillers, self._patience = filler.get("say") or {}, float(filler.get("after", FILLER_AFTER))
        self._home = waiting_state(project.machine) if ANSWERS in project.modules else ""
        key = project.key_of(ANSWER_ROUTE) if ANSWERS in project.modules else ""
        if key != self._key:
            undo, self._key = self._undo, key
            self._undo = self._bus.subscribe(key, self._take) if key else _nothing
            undo()

    def stepped(self, step: Step) -> None:
        """Count the visits: a step that enters the home state ends a visit."""
        self.visit += bool(self._home) and self._home in step.entered

    def ask(self, project: Project, id: str, asked: Ask, now: float, origin: MessageOrigin) -> list[Event]:
        """Search for an answer to the question with an id; return the events that are known at once.

        These are the answer, or an error. Without either, the question is sent to the module, and its answer comes from
        `drain`.
        """
        retriever = self._passages(project, asked.language)
        if found := retriever.answer(asked.question, self._weights):
            said = {
                "text": found.text,
                "language": found.language,
                "source": "passage",
                "passage": found.passage.name,
                "confidence": round(found.probability, 3),
            }
            return [Event(f"answer.command.{id}", said, now)]
        if ANSWERS not in project.modules:
            return [_unanswered(id, now, NOBODY)]
        if self.silenced:
            return [_unanswered(id, now, f"{NOBODY}: {self.silenced} has switched off the language model")]
        offers = {} if "@" in id else self._offers()
        body = {
            "id": id, "question": asked.question, "language": asked.language, "robot": project.robot,
            "within": asked.within, "place": asked.place, "visit": self.visit, "offers": offers,
            "passages": retriever.nearest(asked.question, MAX_PASSAGES, self._weights),
        }  # fmt: skip
        try:
            self._bus.publish(project.key_of(ASK_ROUTE), body, ttl=asked.within, origin=origin)
        except BusError as error:
            return [_unanswered(id, now, str(error))]
        filler_at = now + self._patience if asked.language in self._fillers else inf
        self._open[id] = OpenQuestion(offers, asked.language, filler_at)
        return []

    def cancel(self, id: str) -> bool:
        """Ignore answers to a question from now on; return False if it was not open."""
        return self._open.pop(id, None) is not None

    def silence(self, by: str) -> None:
        """Silence the language model on behalf of `by`, even during an answer; an empty `by` lets it speak."""
        self.silenced = by

    @property
    def empty(self) -> bool:
        """Whether no answer waits, and no filler will become due."""
        return not self._received and not any(one.filler_at < inf for one in self._open.values())

    def drain(self, now: float) -> list[Event]:
        """Return answers and fillers to open questions, each answer caused by its message; drop all other answers.

        While the language model is silenced, every open question ends with an error.
        """
        events = []
        while self._received:
            message, at = self._received.popleft()
            body = message.body if isinstance(message.body, dict) else {}
            id = body.get("id")
            if not isinstance(id, str) or id not in self._open:
                _log.info("an answer on %s is ignored: no open question has its id", message.key)
                continue
            cause = Cause("message", message.id, message.key, message.sender, at)
            events.append(self._heard(id, body, now)._replace(cause=cause))
        for id, one in list(self._open.items()):
            if self.silenced:
                del self._open[id]
                events.append(_unanswered(id, now, f"{self.silenced} has switched off the language model"))
            elif one.filler_at <= now:
                self._open[id] = one._replace(filler_at=inf)
                said = {"text": self._fillers.get(one.language, ""), "language": one.language, "source": "filler"}
                events.append(Event(f"answer.command.{id}", {**said, "filler": True}, now))
        return events

    def _heard(self, id: str, body: Mapping[str, Any], now: float) -> Event:
        one = self._open[id]
        if not self.silenced and body.get("text") and body.get("more"):
            self._open[id] = one._replace(filler_at=inf)
        else:
            del self._open[id]
        if self.silenced:
            return _unanswered(id, now, f"{self.silenced} has switched off the language model")
        if "raise" in body:
            return self._raised(id, one.offers, body["raise"], now)
        if body.get("text"):
            said = {key: value for key, value in body.items() if key in SAID}
            return Event(f"answer.command.{id}", said, now)
        return Event(f"done.command.{id}", None, now)

    def _raised(self, id: str, offers: Mapping[str, Any], raised: Any, now: float) -> Event:
        """Return the event that a language model raises, if it was offered and its data is valid; else an error."""
        match raised:
            case {"event": str(event), "data": dict(data)} if event in offers:
                if JsonSchema({"type": "object", **(offers[event] or {})}).fits(data):
                    return Event(f"answer.command.{id}", {"raise": {"event": event, "data": data}}, now)
        _log.warning("an answer is ignored: its event was not offered, or its data does not match the offer")
        return _unanswered(id, now, "the answer raises an event that was not offered")

    def _take(self, message: Message) -> None:
        self._received.append((message, time()))

    def _passages(self, project: Project, language: str) -> "Retriever":
        from lumen.retrieval.retriever import Retriever  # this imports numpy, which only questions need
        from lumen.retrieval.trials import weights_of

        today = self._today()
        known = (project.knowledge, project.questions, project.robot, language, today)
        if self._retriever is None or self._known != known:
            passages = project.knowledge.values()
            self._retriever = Retriever(passages, language, robot=project.robot, today=today)
            self._weights = weights_of(self._retriever, project.questions.values()) or STRICT
            self._known = known
        return self._retriever


def _nothing() -> None: ...


def _unanswered(id: str, now: float, reason: str) -> Event:
    return Event(f"error.command.{id}", {"reason": reason}, now)
