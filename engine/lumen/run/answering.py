"""Answers to `why` and `why-not` from a running exhibition, made on a separate thread so that no tick is late."""

import logging
import math
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
"""The number of questions that may wait for an answer; further ones are dropped."""
DAY = 86_400.0
"""The length of a day [s]."""
MILLISECOND = 0.001
"""The precision of the times of entries [s]: they are cut, and a question about an entry includes its own step."""
MAX_QUESTION = 500
"""The greatest length of the text to explain [characters]; the rest is cut off."""
AnswerMaker = Callable[[], dict[str, Any]]
"""A function that returns an answer as JSON data."""

_log = logging.getLogger(__name__)


def answer(steps: Sequence[RecordedStep], question: str, what: str, at: str | None = None) -> dict[str, Any]:
    """Return the answer to `why` or `why-not` as JSON data.

    A `question` other than the `ask` of `why` is answered as `why-not`. `at` is an ISO 8601 time: later steps are
    ignored. Raises UsageError if there is no answer, for example if `at` is before the first step in memory.
    """
    from lumen.insight.explaining.answers import why, why_not  # thirty modules that only a question needs

    until = _until(steps, at) if at else None
    if question == WHY.ask:
        return why(steps, what, until).to_json()
    if not what:
        raise UsageError("name a state, a motion or a text, as in `lumen why-not dance`")
    return why_not(steps, what, until).to_json()


def moment_of(text: str) -> float:
    """Return an ISO 8601 text as a time [s since 1970]. Raises UsageError for any other text."""
    try:
        return time_of(text)
    except ValueError:
        raise UsageError(f"`{text[:40]}` is not a time: write it as in 2026-11-22T14:03:00Z") from None


def _until(steps: Sequence[RecordedStep], at: str) -> float:
    """Return an ISO 8601 time on the exhibition's clock [s].

    Raises TooLongAgoError if it is before the first step in memory.
    """
    if not steps:
        raise TooLongAgoError("no steps from that time are in memory")
    # The time of day may have been set between two steps, as in a simulation that is slower than real time.
    dates = [one.step.snapshot.epoch + one.at for one in steps]
    moment = _on_its_day(moment_of(at) + MILLISECOND, dates[0], dates[-1])
    known = [number for number, date in enumerate(dates) if date <= moment]
    if not known:
        raise TooLongAgoError(
            f"the steps in memory begin at {datetime.fromtimestamp(dates[0]):%H:%M:%S}: ask about a later time"
        )
    if dates[-1] < moment < max(dates):  # a time before the clock was set back, and not reached again
        known = [max(known, key=dates.__getitem__)]
    chosen = steps[next((n for n in reversed(known) if dates[n] > moment - 2 * MILLISECOND), known[-1])]
    later = min((one.at for one in steps if one.at > chosen.at), default=math.inf)
    return min(moment - chosen.step.snapshot.epoch, math.nextafter(later, 0.0))


def _on_its_day(moment: float, first: float, last: float) -> float:
    """Return a time later than the steps by a day or more moved to their date, with the same time of day.

    Stories run on a date of their own.
    """
    if moment - last < DAY:
        return moment
    moment -= (moment - last) // DAY * DAY
    return moment - DAY if moment - DAY >= first else moment


class TooLongAgoError(UsageError):
    """The error for a time before the first step in memory; the journal may still cover it."""


class AnsweringThread:
    """A thread that answers questions one after another.

    `steps` returns the steps so far, and is called on the thread of the caller. `journal` is the writer whose pages
    answer requests for the journal.
    """

    def __init__(self, bus: Bus, steps: Callable[[], list[RecordedStep]], journal: JournalWriter) -> None:
        self._bus, self._steps, self._journal = bus, steps, journal
        self._waiting: queue.Queue[tuple[Message, AnswerMaker] | None] = queue.Queue(MAX_WAITING_QUESTIONS)
        self._drops = DropLog(_log, "questions")
        self._thread = WatchedThread("lumen-answering", self._run)

    def request(self, message: Message) -> None:
        """Queue a question about past steps, with the steps as they are now."""
        self.answer(message, partial(reply, self._steps(), message.body, self._journal))

    def answer(self, message: Message, make: AnswerMaker) -> None:
        """Reply to a message with what `make` returns on the answering thread; drop the message if too many wait."""
        if not self._thread.started:
            self._thread.start()
        try:
            self._waiting.put_nowait((message, make))
        except queue.Full:
            self._drops.add(message.key, f"{MAX_WAITING_QUESTIONS} questions are already waiting for an answer")

    def close(self) -> None:
        """Answer the questions that wait, and end the thread; wait at most 10 s in total."""
        if self._thread.started:
            with suppress(queue.Full):
                self._waiting.put(None, timeout=5.0)
            self._thread.join(5.0)
        self._drops.tell(all=True)

    def _run(self) -> None:
        while (asked := self._waiting.get()) is not None:
            message, make = asked
            with suppress(BusError):  # the bus is closed, so no reply can be sent
                self._drops.tell()
                self._bus.reply(message, _made(make))


def _made(make: AnswerMaker) -> Any:
    """Return the result of `make`; if it fails, log the error, and return a refusal of this question."""
    try:
        return make()
    except Exception as error:
        _log.exception("a question could not be answered")
        return {"verdict": "refused", "reason": f"an error in Lumen prevented an answer: {error}"}


def reply(steps: Sequence[RecordedStep], body: Mapping[str, Any], journal: JournalWriter) -> dict[str, Any]:
    """Return the response to a request: an explanation, a page of the journal, or a refusal with its reason."""
    if body["ask"] == JOURNAL.ask:
        return journal_page(journal, int(body.get("from", 0)))
    try:
        return answer(steps, body["ask"], body.get("what", "")[:MAX_QUESTION], body.get("at"))
    except TooLongAgoError as error:
        return {"verdict": "refused", "reason": str(error), "kept": "later"}
    except LumenError as error:
        return {"verdict": "refused", "reason": str(error)}
