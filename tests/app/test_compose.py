"""The composition of an exhibition: rows in order, conditions, claimed parts, and cleanup after a failed maker."""

from collections.abc import Sequence

import pytest

import lumen
from lumen.clock.real import RealClock
from lumen.errors import UsageError
from lumen.feature import Feature, PartRow, Phase, wrong_rows
from lumen.feature.checking import ordered
from lumen.language.events import Event
from lumen.run import compose as composing
from lumen.run.compose import begin, claim, compose, part_rows, start
from lumen.run.live_behavior import LiveBehavior
from lumen.run.parts.brain import BrainPart
from lumen.run.parts.part import Part
from lumen.run.parts.robot import RobotPart
from lumen.run.plan import Plan
from lumen.run.services import Services
from lumen.run.setup import set_up
from tests import ROOT
from tests.exhibits import project
from tests.tables import for_each

HERE = "tests.app.test_compose"


class Greeter(Part):
    """A part of another package, which finds the behaviour by its type."""

    def __init__(self, services: Services) -> None:
        self.behavior, self.ticks, self.closed = services[LiveBehavior], 0, False

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self.ticks += 1

    def close(self) -> None:
        self.closed = True


class Lights(Part):
    """The role of a process of its own, in another package."""

    name = "lights"

    def __init__(self, services: Services) -> None:
        self.project = services.project


def broken(services: Services) -> Part:
    raise UsageError("it does not fit")


def plan(**options: object) -> Plan:
    exhibit = project()
    return Plan(exhibit, set_up("recording", exhibit, "max"), options=options)


def with_rows(monkeypatch: pytest.MonkeyPatch, *more: PartRow) -> None:
    found = tuple(ordered([*part_rows(), *more]))
    monkeypatch.setattr(composing, "part_rows", lambda: found)


def names(*found: PartRow) -> list[str]:
    return [row.name for row in ordered(found)]


def test_rows_come_by_phase_then_after_others_then_by_name() -> None:
    late, early = PartRow("late", Phase.KEEP, ""), PartRow("early", Phase.WORLD, "")
    a, b, c = PartRow("a", Phase.SERVE, "", after="c"), PartRow("b", Phase.SERVE, ""), PartRow("c", Phase.SERVE, "")
    assert names(late, a, c, early, b) == ["early", "b", "c", "a", "late"]


def test_a_row_after_one_of_an_earlier_phase_or_after_none_that_there_is_comes_by_name() -> None:
    world = PartRow("world", Phase.WORLD, "")
    assert names(PartRow("b", Phase.SERVE, "", after="world"), world, PartRow("a", Phase.SERVE, "", after="gone")) == [
        "world",
        "a",
        "b",
    ]


def test_rows_that_wait_for_each_other_are_named() -> None:
    a, b = PartRow("a", Phase.SERVE, "", after="b"), PartRow("b", Phase.SERVE, "", after="a")
    with pytest.raises(ValueError, match="parts wait for each other: a, b"):
        ordered([a, b])


def test_an_unknown_condition_is_named() -> None:
    with pytest.raises(ValueError, match="there is no condition `hole`"):
        plan().meets("hole")


@for_each(
    ("when", "wrong"), [("brian", "brian"), ("brain:NAO", "brain:NAO"), ("role", "role"), ("whole role:", "role:")]
)
def test_a_row_with_an_unknown_condition_is_refused(when: str, wrong: str) -> None:
    [fault] = wrong_rows(Feature("a", parts=(PartRow("a", Phase.SERVE, "a:make", when),)))
    assert f"the part `a` has the unknown condition `{wrong}`: use whole" in fault


def test_a_row_after_itself_is_refused() -> None:
    [fault] = wrong_rows(Feature("a", parts=(PartRow("a", Phase.SERVE, "a:make", after="a"),)))
    assert "the part `a` comes after itself" in fault


def test_a_part_that_watches_must_be_an_observer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Greeter, "watches", True)
    services = compose(plan())
    with pytest.raises(TypeError, match="the part Greeter watches the behaviour: derive it from Observer, too"):
        services.add(0, Greeter(services))
    services.node.close()


def test_the_part_of_another_package_is_ticked_before_the_brain(monkeypatch: pytest.MonkeyPatch) -> None:
    with_rows(monkeypatch, PartRow("greeter", Phase.SERVE, f"{HERE}:Greeter"))
    services = compose(plan())
    start([services])
    services.node.tick()
    greeter, parts = services[Greeter], services.node.parts
    assert greeter.behavior is services.behavior
    assert greeter.ticks == 1
    assert parts.index(services[RobotPart]) < parts.index(greeter) < parts.index(services[BrainPart])
    services.node.close()
    assert greeter.closed


def test_a_part_is_made_only_if_its_conditions_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    with_rows(monkeypatch, PartRow("greeter", Phase.SERVE, f"{HERE}:Greeter", "whole option:greeter"))
    for options, there in (({}, False), ({"greeter": True}, True)):
        services = compose(plan(**options))
        assert (services.get(Greeter) is not None) == there
        services.node.close()


def test_a_process_of_several_has_the_parts_of_its_role(monkeypatch: pytest.MonkeyPatch) -> None:
    with_rows(monkeypatch, PartRow("lights", Phase.WORLD, f"{HERE}:Lights", "role:lights"))
    services = compose(Plan(project(), roles=("lights",), clock=RealClock()))
    assert services[Lights].name == "lights"
    assert services.presence
    assert services.presence.parts == ("lights",)
    assert services.get(LiveBehavior) is None
    services.node.close()


def test_others_have_the_whole_time_to_answer_however_long_the_parts_took(monkeypatch: pytest.MonkeyPatch) -> None:
    services = compose(Plan(project(), roles=("lights",), clock=RealClock()))
    services.node._asked -= 60.0
    assert services.presence
    asked = []
    monkeypatch.setattr(composing.time, "sleep", asked.append)
    claim([services])
    assert asked
    services.node.close()


def test_a_claimed_part_is_made_at_the_beginning_and_in_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    with_rows(monkeypatch, PartRow("greeter", Phase.SERVE, f"{HERE}:Greeter", claimed=True))
    services = compose(plan())
    assert services.get(Greeter) is None
    begin([services])
    assert services.node.parts.index(services[Greeter]) < services.node.parts.index(services[BrainPart])
    services.node.close()


def test_if_a_maker_fails_the_parts_that_were_made_are_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    closed: list[Part] = []
    monkeypatch.setattr(Greeter, "close", lambda greeter: closed.append(greeter))
    rows = PartRow("greeter", Phase.SERVE, f"{HERE}:Greeter"), PartRow("zz", Phase.SERVE, f"{HERE}:broken")
    with_rows(monkeypatch, *rows)
    with pytest.raises(UsageError, match="it does not fit"):
        compose(plan())
    assert len(closed) == 1


def test_a_kind_that_is_not_there_is_named() -> None:
    services = compose(plan())
    with pytest.raises(LookupError, match="this process has no Greeter"):
        services[Greeter]
    services.node.close()


def test_an_exhibition_runs_the_behaviour_of_its_story() -> None:
    exhibit = lumen.load(ROOT / "examples/duet", robot="ben")
    story = exhibit.stories["visitor"]
    assert story.behavior != exhibit.behavior
    services = compose(Plan(exhibit, set_up("recording", exhibit, "max", story), story=story))
    assert services.project.behavior == story.behavior
    assert services.behavior.project.behavior == story.behavior
    services.node.close()
