"""Answers on a thread of its own: one that fails costs its question."""

from pathlib import Path
from typing import Any

from lumen.bus.memory import MemoryBus
from lumen.journal.journal_folder import JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.ports import Message
from lumen.run.answering import AnsweringThread
from tests.waiting import until


def test_a_fault_costs_the_question(tmp_path: Path) -> None:
    bus, answers = MemoryBus(), list[Any]()
    bus.subscribe("answers", lambda message: answers.append(message.body))
    thread = AnsweringThread(bus, list, JournalWriter(JournalFolder(tmp_path, 1.0, 1.0)))

    def fault() -> dict[str, Any]:
        raise ZeroDivisionError("ours")

    asked = Message("questions", {}, reply_to="answers")
    thread.answer(asked, fault)
    thread.answer(asked, lambda: {"well": True})
    until(lambda: len(answers) == 2)
    thread.close()
    bus.close()
    assert answers[0]["verdict"] == "refused"
    assert "ours" in answers[0]["reason"]
    assert answers[1] == {"well": True}
