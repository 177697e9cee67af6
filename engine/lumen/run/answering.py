"""`why` and `why-not` asked of a running exhibition: answered on a thread of its own, so that no tick is late."""

import logging
import queue
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from datetime import datetime
from functools import partial
from typing import Any

from lumen.errors import BusError, LumenError, UsageError
from lumen.insight.explaining import RecordedStep
from lumen.journal.journal_writer import JournalWriter
from lumen.language.iso_time import time_of
from lumen.language.operator_requests import JOURNAL, WHY
from lumen.ports import Bus, Message
from lumen.run.journal_pages import journal_page
from lumen.upkeep.drops import DropLog
from lumen.upkeep.threads import WatchedThread

MAX_WAITING_QUESTIONS = 20
DAY = 86_400.0
MAX_QUESTION = 500
"""Characters of what somebody asks about."""
AnswerMaker = Callable[[], dict[str, Any]]
"""Makes an answer."""

_log = logging.getLogger(__name__)


def answer(steps: Sequence[RecordedStep], question: str, what: str, at: str | None = None) -> dict[str, Any]:
    """The answer as JSON data; `at` is an ISO 8601 time. Raises UsageError, saying what to do, where there is none."""
    from lumen.insight.explaining.answers import why, why_not  # thirty modules that only a question needs

    until = _until(steps, at) if at else None
    if question == WHY.ask:
        return why(steps, what, until).to_json()
    if not what:
        raise UsageError("name a state, a motion or a text, as in `lumen why-not dance`")
    return why_not(steps, what, until).to_json()


def moment_of(text: str) -> float:
    """Return the time of an ISO 8601 text [s since 1970]. Raises UsageError."""
    try:
        return time_of(text)
    except ValueError:
        raise UsageError(f"`{text[:40]}` is not a time: write it as in 2026-11-22T14:03:00Z") from None


def _until(steps: Sequence[RecordedStep], at: str) -> float:
    """That time on the exhibition's clock [s]; raises UsageError where nothing of it is kept."""
    moment = moment_of(at)
    if not steps:
        raise TooLongAgoError("no steps from that time are in memory")
    until = _on_its_day(moment - steps[-1].step.snapshot.epoch, steps[0].at, steps[-1].at)
    if until < steps[0].at:
        first = datetime.fromtimestamp(steps[0].step.snapshot.epoch + steps[0].at)
        raise TooLongAgoError(f"the steps in memory begin at {first:%H:%M:%S}: ask about a later time")
    return until


def _on_its_day(until: float, first: float, last: float) -> float:
    """The same time of day at the date that the exhibition believes in: stories live at one of their own."""
    if until - last < DAY:
        return until
    until -= (until - last) // DAY * DAY
    return until - DAY if until - DAY >= first else until


class TooLongAgoError(UsageError):
    """What is asked about is not in memory any more; the journal may know it."""


class AnsweringThread:
    """Answers questions one after another; `steps` is asked for what has happened, on the thread that asks.

    The journal that is asked for is what `journal` writes.
    """

    def __init__(self, bus: Bus, steps: Callable[[], list[RecordedStep]], journal: JournalWriter) -> None:
        self._bus, self._steps, self._journal = bus, steps, journal
        self._waiting: queue.Queue[tuple[Message, AnswerMaker] | None] = queue.Queue(MAX_WAITING_QUESTIONS)
        self._drops = DropLog(_log, "questions")
        self._thread = WatchedThread("lumen-answering", self._run)

    def ask(self, message: Message) -> None:
        """Have a question about what has happened answered, as soon as those before it are."""
        self.answer(message, partial(reply, self._steps(), message.body, self._journal))

    def answer(self, message: Message, make: AnswerMaker) -> None:
        """Have a message answered by what `make` returns on the other thread; one too many gets no answer."""
        if not self._thread.started:
            self._thread.start()
        try:
            self._waiting.put_nowait((message, make))
        except queue.Full:
            self._drops.add(message.key, f"{MAX_WAITING_QUESTIONS} questions are already waiting for an answer")

    def close(self) -> None:
        """End the thread."""
        if self._thread.started:
            with suppress(queue.Full):
                self._waiting.put(None, timeout=5.0)
            self._thread.join(5.0)
        self._drops.tell(all=True)

    def _run(self) -> None:
        while (asked := self._waiting.get()) is not None:
            message, make = asked
            try:
                self._drops.tell()
                self._bus.reply(message, _made(make))
            except BusError:
                continue  # who asked is gone


def _made(make: AnswerMaker) -> Any:
    """What it makes; a fault of ours costs this question, and no other."""
    try:
        return make()
    except Exception as error:
        _log.exception("a question could not be answered")
        return {"verdict": "refused", "reason": f"an error in Lumen prevented an answer: {error}"}


def reply(steps: Sequence[RecordedStep], body: Mapping[str, Any], journal: JournalWriter) -> dict[str, Any]:
    """What is sent back: the answer, or a verdict that says why there is none."""
    if body["ask"] == JOURNAL.ask:
        return journal_page(journal, int(body.get("from", 0)))
    try:
        return answer(steps, body["ask"], body.get("what", "")[:MAX_QUESTION], body.get("at"))
    except TooLongAgoError as error:
        return {"verdict": "refused", "reason": str(error), "kept": "later"}
    except LumenError as error:
        return {"verdict": "refused", "reason": str(error)}
