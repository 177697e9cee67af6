"""Behaviours that walk to places, with the recording robot: in order, in time, and with reports of failures."""

from collections.abc import Mapping
from typing import Any

import pytest

from lumen.bus.memory import MemoryBus
from lumen.clock.virtual import VirtualClock
from lumen.insight.migration import MigrationPlan
from lumen.language.commands import Walk
from lumen.language.events import Event
from lumen.language.hall_places import HallPlace, HallPlaces
from lumen.robot.recording import RecordingRobot
from lumen.run.loop import BehaviorLoop, Observer
from lumen.statechart import Machine, Step, deserialize, serialize
from tests.exhibits import BODY, project

PLACES = {"organ": HallPlace(1.0, 0.0, 1.5), "clock": HallPlace(1.0, 1.0), "door": HallPlace(0.0, 0.0)}


class Guide(Observer):
    """A behaviour on a recording robot; `events` are those of places and of ends, `raised` its own errors."""

    def __init__(
        self,
        states: Mapping[str, Any],
        places: Mapping[str, HallPlace] = PLACES,
        behaves: Mapping[str, Any] | None = None,
    ) -> None:
        data = {"id": "tour", "context": {"next": "", "was": ""}, "initial": next(iter(states)), "states": states}
        self.machine = Machine.from_dict(data, "tour")
        self.robot = RecordingRobot(BODY, behaves)
        self.clock = VirtualClock()
        self.project = project(behaviors={"tour": self.machine}, sections={"places": HallPlaces(places)})
        self.loop = BehaviorLoop(self.project, self.robot, MemoryBus(), self.clock)
        self.loop.observers.append(self)
        self.events: list[str] = []
        self.answers: list[Event] = []
        self.loop.start()

    def stepped(self, step: Step) -> None:
        if step.event and (step.event.name in ("arrived", "left", "doubtful") or ".command." in step.event.name):
            place = step.event.data.get("place") if isinstance(step.event.data, dict) else None
            self.events.append(f"{step.event.name} {place}" if place else step.event.name)

    def answered(self, event: Event) -> None:
        self.answers.append(event)

    def live(self, seconds: float) -> None:
        end = self.clock.now() + seconds
        while self.clock.now() < end:
            self.robot.advance(0.02)
            self.loop.tick()

    @property
    def states(self) -> frozenset[str]:
        return self.loop.runtime.snapshot.configuration

    @property
    def place(self) -> str:
        return self.loop.runtime.snapshot.place

    @property
    def walks(self) -> list[Walk]:
        return [command for _, command in self.robot.performed if isinstance(command, Walk)]


def test_it_walks_to_places_one_after_another_and_says_when_it_is_there() -> None:
    guide = Guide({"a": {"do": [{"walk": {"to": "organ"}}, {"walk": {"to": "clock"}}], "onDone": "b"}, "b": {}})
    guide.live(40.0)
    assert guide.events == ["arrived organ", "done.command.d1", "left organ", "arrived clock", "done.command.d2"]
    assert guide.place == "clock"
    assert "b" in guide.states
    assert guide.robot.time > 20.0


def test_where_it_goes_may_be_computed_and_where_it_is_be_asked() -> None:
    guide = Guide(
        {
            "a": {
                "entry": {"assign": {"next": "'or' + 'gan'"}},
                "do": {"walk": {"to": "{{ context.next }}"}},
                "on": {"arrived": {"guard": "state.place == 'organ'", "target": "b"}},
            },
            "b": {"entry": {"assign": {"was": "state.place"}}},
        }
    )
    guide.live(20.0)
    assert guide.states == {"b"}
    assert guide.loop.runtime.snapshot.context["was"] == "organ"


def test_a_place_that_is_not_there_is_an_error_that_says_which_there_are() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "orgn"}}, "onError": "b"}, "b": {}})
    guide.live(1.0)
    assert guide.states == {"b"}
    [answer] = [event for event in guide.answers if event.name.startswith("error")]
    assert answer.data["reason"].startswith("there is no place `orgn`: did you mean `organ`?")


def test_without_places_nothing_is_raised_and_a_walk_to_one_fails() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onError": "b"}, "b": {}}, places={})
    guide.live(1.0)
    assert guide.states == {"b"}
    assert guide.events == ["error.command.d1"]


@pytest.mark.parametrize("after", [0.01, 3.0, 6.0])
def test_a_walk_that_is_left_ends_wherever_it_is(after: float) -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "on": {"stop": "b"}}, "b": {}})
    guide.live(after)
    guide.loop.happen(Event("stop"))
    guide.live(30.0)
    walked = len(guide.walks)
    guide.live(5.0)
    assert len(guide.walks) == walked
    assert guide.place != "organ"


def test_stop_ends_the_whole_way_and_not_one_walk_of_it() -> None:
    go = {"do": {"walk": {"to": "organ"}}, "onError": "b", "on": {"resume": {"actions": {"stop": "walk"}}}}
    guide = Guide({"a": go, "b": {}})
    guide.live(4.0)
    guide.loop.happen(Event("resume"))
    guide.live(20.0)
    assert "cancelled.command.d1" in guide.events
    assert guide.place == ""


def test_two_ways_at_once_are_walked_one_after_another() -> None:
    guide = Guide({"a": {"do": {"parallel": [{"walk": {"to": "organ"}}, {"walk": {"to": "clock"}}]}}})
    guide.live(60.0)
    assert [event for event in guide.events if "arrived" in event] == ["arrived organ", "arrived clock"]


def test_a_robot_that_can_not_walk_says_so() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onError": "b"}, "b": {}}, behaves={"walk": "fails"})
    guide.live(5.0)
    assert guide.states == {"b"}


def test_a_place_that_is_moved_meanwhile_is_walked_to_where_it_is_now() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onDone": "b"}, "b": {}})
    guide.live(3.0)
    moved = guide.project.with_section("places", HallPlaces({"organ": HallPlace(0.0, 1.0)}))
    guide.loop.runtime.project = moved
    guide.live(40.0)
    assert guide.states == {"b"}
    here = guide.robot._reckoning.whereabouts
    assert abs(complex(here.x, here.y - 1.0)) < 0.06


def test_a_place_that_is_taken_away_meanwhile_fails_and_one_the_robot_stood_at_is_left() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onError": "b"}, "b": {}})
    guide.live(3.0)
    guide.loop.runtime.project = guide.project.with_section("places", HallPlaces({}))
    guide.live(2.0)
    assert guide.states == {"b"}
    still = Guide({"a": {}})
    still.live(1.0)
    assert still.place == "door"
    still.loop.runtime.project = still.project.with_section("places", HallPlaces({}))
    still.live(1.0)
    assert (still.place, still.events) == ("", ["arrived door", "left door"])


def test_a_doubt_that_is_greater_than_the_place_is_told_once() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}}})
    guide.live(20.0)
    assert "doubtful organ" not in guide.events
    guide.robot._reckoning.slid = 0.6
    guide.live(3.0)
    assert guide.events[-1] == "doubtful organ"
    assert guide.events.count("doubtful organ") == 1
    assert guide.place == "organ"


def test_where_the_robot_is_outlives_a_restart_of_the_engine() -> None:
    guide = Guide({"a": {}})
    guide.live(1.0)
    data = serialize(guide.machine, guide.loop.runtime.snapshot)
    assert deserialize(guide.machine, data).place == "door"
    del data["place"]
    assert deserialize(guide.machine, data).place == ""


def test_a_reload_in_mid_walk_is_walked_on_with_and_where_the_robot_is_is_kept() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onDone": "b"}, "b": {}})
    guide.live(3.0)
    for places in ({"organ": HallPlace(0.0, 1.0)}, {"organ": HallPlace(0.0, 1.0), "clock": HallPlace(2.0, 2.0)}):
        later = guide.project.with_section("places", HallPlaces(places))
        planned = guide.loop.plan(later)
        assert isinstance(planned, MigrationPlan)
        guide.loop.apply(later, planned)
        guide.live(40.0)
        assert (guide.states, guide.place) == ({"b"}, "organ")
    assert guide.events == ["arrived organ", "done.command.d1"]


def test_a_robot_that_is_lost_on_the_way_ends_it() -> None:
    guide = Guide({"a": {"do": {"walk": {"to": "organ"}}, "onError": "b"}, "b": {}})
    guide.live(2.0)
    guide.robot._executor.fail("the robot fell")
    guide.live(1.0)
    assert guide.states == {"b"}
    assert guide.events == ["arrived door", "error.command.d1"]
