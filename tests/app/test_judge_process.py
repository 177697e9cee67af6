"""A process that answers questions: its answers, its end without an answer, and its restart."""

import sys
import threading
from collections.abc import Iterator

import pytest

from lumen.upkeep.judge_process import OUT_OF_MEMORY, Fault, JudgeProcess, NoAnswerError

pytestmark = pytest.mark.process

COMMAND = [sys.executable, "-m", "tests.app.answers"]


@pytest.fixture
def process() -> Iterator[JudgeProcess]:
    made = JudgeProcess(COMMAND, max_answer=1_000)
    made.start()
    yield made
    made.end()


def test_each_question_has_its_answer_whatever_is_printed(process: JudgeProcess) -> None:
    assert [process.request(question) for question in ("one", "two")] == ["one", "two"]


def test_a_fault_is_an_answer_and_the_next_question_has_one_too(process: JudgeProcess) -> None:
    with pytest.raises(ZeroDivisionError):
        process.request("a fault")
    assert process.request("one") == "one"


@pytest.mark.parametrize(
    ("question", "fault", "code", "signal"),
    [
        ("an end", Fault.ENDED, 3, ""),
        ("the end of the pipe", Fault.ENDED, 3, ""),
        ("a signal", Fault.ENDED, -9, "SIGKILL"),
        ("no memory", Fault.MEMORY, OUT_OF_MEMORY, ""),
        ("much", Fault.SIZE, -9, "SIGKILL"),
    ],
)
def test_the_end_of_the_process_is_explained(
    process: JudgeProcess, question: str, fault: Fault, code: int, signal: str
) -> None:
    with pytest.raises(NoAnswerError) as raised:
        process.request(question)
    assert (raised.value.fault, raised.value.code, raised.value.signal) == (fault, code, signal)


def test_a_late_answer_ends_the_process_and_it_starts_again(process: JudgeProcess) -> None:
    with pytest.raises(NoAnswerError) as raised:
        process.request("silence", timeout=0.01)
    assert raised.value.fault is Fault.LATE
    assert not process.started
    process.start()
    assert process.request("one") == "one"


def test_its_end_is_noticed_by_the_thread_that_waits_for_an_answer(process: JudgeProcess) -> None:
    ended = list[Fault]()

    def ask() -> None:
        with pytest.raises(NoAnswerError) as raised:
            process.request("silence")
        ended.append(raised.value.fault)

    thread = threading.Thread(target=ask)
    thread.start()
    process.end()
    thread.join()
    assert ended == [Fault.ENDED]


def test_a_message_without_an_answer_may_come_too_late(process: JudgeProcess) -> None:
    process.end()
    process.send("one")
    with pytest.raises(NoAnswerError):
        process.request("two")
