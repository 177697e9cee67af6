"""Two robots on one bus: each hears its own visitors, and nothing crosses."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count

import pytest

import lumen
from lumen.language.projects import Project
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.setup import set_up
from lumen.statechart import Step
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector

pytestmark = pytest.mark.rest  # expensive

VISITORS = {"Ana": "visitor", "Ben": "indonesian"}


def exhibition(project: Project, story: str, bus: str, speed: str = "max") -> Exhibition:
    told = project.stories[story]
    return Exhibition(Plan(project, set_up("recording", project, speed, told), bus, told))


def play(
    shows: Mapping[str, Exhibition], meanwhile: Callable[[int], None] = lambda tick: None
) -> dict[str, list[tuple[object, ...]]]:
    """Tick all robots until their stories end; return the steps of each behaviour."""
    seen: dict[str, list[tuple[object, ...]]] = {name: [] for name in shows}
    for name, show in shows.items():
        show.observe(lambda step, seen=seen[name]: seen.append(_seen(step)))
        show.start()
    ticks = count(1)
    while any(not show.over for show in shows.values()):
        meanwhile(next(ticks))
        for show in shows.values():
            if not show.over:
                show.tick()
    for show in shows.values():
        show.close()
        assert not show.node.failed
    return seen


def _seen(step: Step) -> tuple[object, ...]:
    event = step.event
    return event and event.name, step.exited, step.entered, dict(step.snapshot.context)


@pytest.fixture
def robots() -> dict[str, Project]:
    shipped = lumen.load()
    return {name: replace(shipped, robot=name, aliases=False) for name in VISITORS}


def test_two_tours_on_one_bus_are_as_each_is_alone(robots: dict[str, Project]) -> None:
    alone = {name: play({name: exhibition(robots[name], story, "memory://")}) for name, story in VISITORS.items()}
    heard = lumen.bus.connect("memory://two")
    everything = Collector()
    heard.subscribe("#", everything)
    together = play({name: exhibition(robots[name], story, "memory://two") for name, story in VISITORS.items()})
    heard.close()
    for name in VISITORS:
        assert together[name] == alone[name][name]
    for message in everything.messages:
        assert set(message.key.split(".")) & set(VISITORS), f"{message.key} is nobody's"


@pytest.mark.broker
def test_two_tours_on_one_broker_hear_their_own_visitors(robots: dict[str, Project], broker: RabbitMQ) -> None:
    shipped = {name: replace(project, aliases=None) for name, project in robots.items()}
    shows = {name: exhibition(shipped[name], story, broker.url) for name, story in VISITORS.items()}
    buses = [show.node.bus for show in shows.values()]
    delivered = [Collector() for _ in buses]
    for bus, marks in zip(buses, delivered, strict=True):
        bus.subscribe(f"lumen.mark.{id(bus)}", marks)

    def wait_for_the_broker(tick: int) -> None:
        """However slow the broker is, a message is at most ten ticks (0.2 s of the stories) on its way."""
        if tick % 10 == 0:
            for bus, marks in zip(buses, delivered, strict=True):
                bus.publish(f"lumen.mark.{id(bus)}", {})
                marks.wait(tick // 10)

    seen = play(shows, wait_for_the_broker)
    names = {name: {step[-1]["visitor"] for step in steps} - {""} for name, steps in seen.items()}  # type: ignore[index]
    assert names == {"Ana": {"Budi"}, "Ben": {"Siti"}}
