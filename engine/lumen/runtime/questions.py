"""Visitors' questions: answered from the passages that are known here, else by the module `answers`, else by nobody."""

import logging
from collections import deque
from collections.abc import Callable
from datetime import date
from time import time
from typing import TYPE_CHECKING

from lumen.errors import BusError
from lumen.interpreters.retrieval.ranking import Thresholds
from lumen.language.causes import Cause, MessageOrigin
from lumen.language.commands import Ask
from lumen.language.events import Event
from lumen.language.modules import ANSWERS
from lumen.language.projects import Project
from lumen.ports import Bus, Message

if TYPE_CHECKING:
    from lumen.interpreters.retrieval.retriever import Retriever

ASK_ROUTE, ANSWER_ROUTE = "ask", "answer"
SAFE = {"en": Thresholds(0.622, 0.132), "id": Thresholds(0.415, 0.263)}
"""How like a question a passage has to be, by language: what the tour's own questions set (decision 091)."""
STRICT = Thresholds(0.63, 0.27)
"""The same of languages for which nobody has set it."""
MAX_ANSWERS = 100
"""Answers that wait for a tick; then the oldest are dropped."""
NOBODY = "nobody here knows the answer"

_log = logging.getLogger(__name__)


class Questions:
    """Knows which questions are open; what is found comes as events, at the next tick.

    Passages are looked up here: that takes less than a millisecond, and no module has to be there for it. `today` is
    the day on which they have to be true.
    """

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self.today: Callable[[], date | None] = lambda: None
        self._open: set[str] = set()
        self._came: deque[tuple[Message, float]] = deque(maxlen=MAX_ANSWERS)
        self._key = ""
        self._undo: Callable[[], None] = _nothing
        self._retriever: Retriever | None = None
        self._known: tuple[object, ...] = ()

    def listen(self, project: Project) -> None:
        """Hear what the module `answers` of this project says, where it has one."""
        key = project.key_of(ANSWER_ROUTE) if ANSWERS in project.modules else ""
        if key != self._key:
            undo, self._key = self._undo, key
            self._undo = self._bus.subscribe(key, self._take) if key else _nothing
            undo()

    def ask(self, project: Project, id: str, asked: Ask, now: float, origin: MessageOrigin) -> list[Event]:
        """Begin to find the answer; the events of what is known at once: it, or that nobody knows."""
        retriever = self._passages(project, asked.language)
        if found := retriever.answer(asked.question, SAFE.get(asked.language, STRICT)):
            said = {
                "text": found.text, "language": found.language, "source": "passage", "passage": found.passage.name,
                "confidence": round(found.score, 3),
            }  # fmt: skip
            return [Event(f"answer.command.{id}", said, now)]
        if ANSWERS not in project.modules:
            return [Event(f"error.command.{id}", {"reason": NOBODY}, now)]
        body = {
            "id": id, "question": asked.question, "language": asked.language, "robot": project.robot,
            "within": asked.within, "place": asked.place,
        }  # fmt: skip
        try:
            self._bus.publish(project.key_of(ASK_ROUTE), body, ttl=asked.within, origin=origin)
        except BusError as error:
            return [Event(f"error.command.{id}", {"reason": str(error)}, now)]
        self._open.add(id)
        return []

    def cancel(self, id: str) -> bool:
        """Ignore from now on what is answered under that id; whether it was open."""
        open, self._open = id in self._open, self._open - {id}
        return open

    @property
    def empty(self) -> bool:
        """Whether no answer has come since it was drained."""
        return not self._came

    def drain(self, now: float) -> list[Event]:
        """What was answered to open questions, each caused by its message; others' answers are a line in the log."""
        events = []
        while self._came:
            message, at = self._came.popleft()
            body = message.body if isinstance(message.body, dict) else {}
            id = body.get("id")
            if not isinstance(id, str) or id not in self._open:
                _log.info("an answer on %s is ignored: nobody waits for it", message.key)
                continue
            kind, said = "error", {"reason": NOBODY}
            if body.get("text"):
                kind, said = "answer", {key: value for key, value in body.items() if key != "id"}
            if not (body.get("more") or body.get("filler")):
                self._open.discard(id)
            cause = Cause("message", message.id, message.key, message.sender, at)
            events.append(Event(f"{kind}.command.{id}", said, now, "", cause))
        return events

    def _take(self, message: Message) -> None:
        self._came.append((message, time()))

    def _passages(self, project: Project, language: str) -> "Retriever":
        from lumen.interpreters.retrieval.retriever import Retriever  # with numpy: only who asks waits for it

        today = self.today()
        known = (project.knowledge, project.robot, language, today)
        if self._retriever is None or self._known != known:
            passages = project.knowledge.values()
            self._retriever = Retriever(passages, language, robot=project.robot, today=today)
            self._known = known
        return self._retriever


def _nothing() -> None: ...
