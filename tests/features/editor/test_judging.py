"""The process that judges for an editor: a newer text ends the judgement of an older one, a crash costs one answer."""

import asyncio
import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.features.editor.analysis import Analysis, Judgement
from lumen.features.editor.judging import Judge, JudgingQuestions
from tests.waiting import HANG


class Outdatable:
    """A process that answers a question only after the message that the question is outdated."""

    def __init__(self) -> None:
        self.asked, self.outdated = list[int](), list[int]()
        self._sent = threading.Event()
        self.began = asyncio.Event()
        self._loop = asyncio.get_running_loop()

    def start(self) -> None: ...

    def request(self, question: tuple[int, Any]) -> None:
        self.asked.append(question[0])
        self._loop.call_soon_threadsafe(self.began.set)
        assert self._sent.wait(HANG)

    def send(self, message: tuple[int, None]) -> None:
        self.outdated.append(message[0])
        self._sent.set()


def judge(act: Callable[[Judge], Any]) -> Outdatable:
    """Ask a question, act while it waits, and return the process after the question was answered."""

    async def asked() -> Outdatable:
        judge = Judge()
        process = Outdatable()
        judge._process = process  # type: ignore[assignment]
        waiting = asyncio.ensure_future(judge.judge(Analysis(Path(), {})))
        async with asyncio.timeout(HANG):
            await process.began.wait()
            await act(judge)
            assert await waiting is None
        return process

    return asyncio.run(asked())


def test_a_process_hears_once_that_its_question_is_outdated() -> None:
    async def typed(judge: Judge) -> None:
        judge.outdated()
        judge.outdated()

    process = judge(typed)
    assert len(process.outdated) == 1
    assert process.outdated > process.asked


def test_a_second_question_makes_the_first_outdated() -> None:
    async def asked(judge: Judge) -> None:
        await judge.judge(Analysis(Path(), {}))

    process = judge(asked)
    assert process.asked == [1, 2]
    assert process.outdated == [2]


def test_a_judgement_ends_when_a_newer_number_has_come() -> None:
    questions = JudgingQuestions(SimpleNamespace())  # type: ignore[arg-type]
    done = Judgement((), {})

    def judged(between: Callable[[], None], newest: int) -> Judgement:
        questions._newest = newest
        between()
        return done

    for newest, found in ((1, done), (2, None)):
        questions._newest = 1
        analysis: Any = SimpleNamespace(judged=lambda between, newest=newest: judged(between, newest))
        assert questions._judged(1, analysis) is found


@pytest.mark.process
def test_the_judgement_of_another_process_is_the_same_and_a_crash_costs_one() -> None:
    analysis = Analysis(Path("/project"), {"lumen.yaml": b"nonsense: 1"})

    async def asked() -> list[Judgement | None]:
        judge = Judge()
        found = [await judge.judge(analysis)]
        assert judge._process._child
        os.kill(judge._process._child.pid, signal.SIGSTOP)  # it answers no more
        waiting = asyncio.ensure_future(judge.judge(analysis))
        await asyncio.sleep(0)
        os.kill(judge._process._child.pid, signal.SIGKILL)
        found += [await waiting, await judge.judge(analysis)]
        judge.close()
        return found

    first, crashed, again = asyncio.run(asked())
    assert first
    assert analysis.diagnostics
    assert first.diagnostics == analysis.diagnostics
    assert (crashed, again) == (None, first)
