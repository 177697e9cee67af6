"""`for`: the states within run once for each entry of a list; a museum's quiz in two languages."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from lumen.insight.migration import MigrationPlan, migrate
from lumen.language.commands import Say, Start
from lumen.statechart import Interpreter, Machine, Step, deserialize, serialize
from tests.statechart.table import read

HERE = Path(__file__).parent / "museum"
WORDS = read(HERE / "questions.yaml")
QUESTIONS = WORDS["lists"]["questions"]


def quiz(words: Mapping[str, Any] = WORDS, **loop: Any) -> Machine:
    """Return the quiz, with these changes of its `for`."""
    data = deepcopy(dict(read(HERE / "quiz.yaml")))
    data["states"]["quiz"]["for"].update(loop)
    return Machine.from_dict(data, "quiz", words={"questions": words})


class Visitor:
    """Plays with the machine and hears its texts; `knows` decides whether an entry is answered correctly."""

    def __init__(self, machine: Machine, language: str, seed: int = 0) -> None:
        self.said: list[str] = []
        self.language, self.pending = language, ""
        self.robot = Interpreter(machine, observe=self.observe, language=language, seed=seed)
        self.robot.start()

    def observe(self, step: Step) -> None:
        for command in step.commands:
            if isinstance(command, Start) and isinstance(command.command, Say):
                self.said.append(command.command.text)
                self.pending = command.id

    def plays(self, knows: Callable[[Mapping[str, Any]], bool]) -> list[int]:
        """Play to the end of the round; return the numbers of the questions."""
        self.robot.send("start")
        asked = []
        while "quiz.ask" in self.robot.configuration:
            asked.append(self.answers(knows))
        return asked

    def answers(self, knows: Callable[[Mapping[str, Any]], bool]) -> int:
        """Answer the present question; return its number."""
        text = self.said[-1]
        number = next(i for i, q in enumerate(QUESTIONS) if q["ask"][self.language] == text)
        right = QUESTIONS[number]["right"][self.language][0]
        self.robot.send("heard", {"text": f"I say {right}!" if knows(QUESTIONS[number]) else "no idea"})
        self.robot.send(f"done.command.{self.pending}")
        return number


@pytest.mark.parametrize("language", ["en", "de"])
def test_three_of_ten_questions_are_asked_in_the_visitor_s_language_and_counted(language: str) -> None:
    visitor = Visitor(quiz(), language, seed=7)
    first = iter([True, False, True])

    asked = visitor.plays(lambda entry: next(first))

    assert len(asked) == len(set(asked)) == 3
    assert (visitor.robot.context["right"], visitor.robot.context["wrong"]) == (2, 1)
    assert visitor.said[-1] == {"en": "2 of 3", "de": "2 von 3"}[language]
    assert visitor.robot.configuration == {"score"}
    wrong = QUESTIONS[asked[1]]["right"][language][0]
    assert visitor.said[3] == {"en": f"It is {wrong}.", "de": f"Es ist {wrong}."}[language]


def test_the_order_is_drawn_from_the_seed_and_another_in_the_next_round() -> None:
    rounds = [
        [v.plays(lambda entry: True), v.robot.clock.wait(99), v.plays(lambda entry: True)]
        for v in (Visitor(quiz(most=10), "en", seed=1), Visitor(quiz(most=10), "en", seed=1))
    ]
    assert rounds[0] == rounds[1]
    assert rounds[0][0] != rounds[0][2]
    assert sorted(rounds[0][0]) == list(range(10))
    assert Visitor(quiz(most=10), "en", seed=2).plays(lambda entry: True) != rounds[0][0]


def test_without_shuffle_entries_come_as_they_stand_all_of_them() -> None:
    machine = quiz(shuffle=False, most=99)
    assert Visitor(machine, "en").plays(lambda entry: False) == list(range(10))


def test_a_round_goes_on_from_a_snapshot_as_it_would_have() -> None:
    machine = quiz()
    visitor, other = Visitor(machine, "de", seed=3), Visitor(machine, "de", seed=3)
    whole = visitor.plays(lambda entry: True)
    other.robot.send("start")
    asked = [other.answers(lambda entry: True)]
    other.robot = Interpreter.restore(machine, other.robot.snapshot(), observe=other.observe)
    while "quiz.ask" in other.robot.configuration:
        asked.append(other.answers(lambda entry: True))
    assert asked == whole
    assert other.said == visitor.said
    assert other.robot.snapshot()["context"] == visitor.robot.snapshot()["context"]


def test_an_empty_list_is_done_at_once() -> None:
    robot = Interpreter(quiz({"lists": {"questions": []}}))
    robot.start()
    step = robot.send("start")
    assert robot.configuration == {"score"}
    assert "quiz.ask" not in step.entered


def reloaded(visitor: Visitor, words: list[Mapping[str, Any]]) -> None:
    """Continue with other questions, as a running exhibition does after they are saved."""
    old, new = visitor.robot.machine, quiz({"lists": {"questions": words}}, shuffle=False, most=10)
    plan = migrate(old, new, deserialize(old, visitor.robot.snapshot()))
    assert isinstance(plan, MigrationPlan)
    visitor.robot = Interpreter.restore(new, serialize(new, plan.snapshot), observe=visitor.observe)


def test_a_round_goes_on_when_its_list_is_edited() -> None:
    visitor = Visitor(quiz(shuffle=False, most=10), "en")
    visitor.robot.send("start")
    for _ in range(2):
        visitor.answers(lambda entry: True)
    first, *rest = QUESTIONS
    fresh = {"ask": {"en": "A new one?", "de": "Eine neue?"}, "right": {"en": ["yes"], "de": ["ja"]}}
    third = {**QUESTIONS[2], "right": {"en": ["bartolomeo"], "de": ["bartolomeo"]}}
    sixth = {**QUESTIONS[5], "ask": {"en": "What beats a drum?", "de": "Womit trommelt man?"}}

    reloaded(visitor, [first, rest[0], third, QUESTIONS[3], QUESTIONS[4], sixth, *QUESTIONS[7:], fresh])

    assert visitor.robot.configuration == {"quiz", "quiz.ask"}
    visitor.robot.send("heard", {"text": "Bartolomeo it was"})
    visitor.robot.send(f"done.command.{visitor.pending}")
    assert visitor.robot.context["right"] == 3
    asked = []
    while "quiz.ask" in visitor.robot.configuration:
        asked.append(visitor.said[-1])
        visitor.robot.send("heard", {"text": "no idea"})
        visitor.robot.send(f"done.command.{visitor.pending}")
    assert asked == [q["ask"]["en"] for q in (QUESTIONS[3], QUESTIONS[4], sixth, *QUESTIONS[7:])]


def test_the_question_asked_ends_as_it_began_where_it_is_deleted() -> None:
    visitor = Visitor(quiz(shuffle=False, most=10), "en")
    visitor.robot.send("start")
    reloaded(visitor, [])
    assert visitor.robot.configuration == {"quiz", "quiz.ask"}
    visitor.robot.send("heard", {"text": "an organ"})
    visitor.robot.send(f"done.command.{visitor.pending}")
    assert visitor.robot.configuration == {"score"}
    assert visitor.robot.context["right"] == 1
