"""The ears open for a near face that looks at the robot or for a touch, and publish their state."""

import random
from collections.abc import Callable, Sequence
from typing import Any

import pytest

import lumen
from lumen import statechart
from lumen.features.ears.addressing import AFTER_FACE, AFTER_TOUCH, LEAD, NO_DISTANCE, Addressing
from lumen.features.ears.module import Ears
from lumen.language.commands import Leds, Start
from lumen.language.events import Event
from tests.features.conftest import Stand, with_options
from tests.features.ears.test_own_voice import SAY, Ear
from tests.tables import for_each

Make = Callable[..., Stand]
FACE, TACTILE, LISTENING = "lumen.visual.face.detection", "avatar.NAO.data.tactile", "lumen.NAO.audio.listening"
LISTENS: dict[str, Any] = {"face": {"within": 1.5}, "touch": {"sensors": ["FrontTactil"]}}
NEAR: dict[str, Any] = {"x": 160, "y": 120, "distance": 1.2}


@pytest.fixture
def ear(stand: Make) -> Ear:
    plain = stand()
    return Ear(stand(with_options(plain.project, "ears", listens=LISTENS)))


def touched(*sensors: str) -> dict[str, Any]:
    names = ["FrontTactil", "RearTactil"]
    return {"name": names, "value": [int(name in sensors) for name in names]}


def test_hears_who_is_near_and_looks_and_a_little_longer(ear: Ear) -> None:
    assert ear.record(100.0, 4) == []
    ear.send(101.0, FACE, NEAR)
    assert ear.record(101.5, 4) == ["can you dance"]
    assert ear.record(101.0 + AFTER_FACE, 4) == ["can you dance"]
    assert ear.record(102.0 + AFTER_FACE, 4) == []


@pytest.mark.parametrize("body", [{**NEAR, "distance": 1.6}, {**NEAR, "looks": False}, {"x": 160, "y": 120}])
def test_does_not_hear_who_is_far_or_looks_away(ear: Ear, body: dict[str, Any]) -> None:
    ear.send(101.0, FACE, body)
    assert ear.record(101.5, 4) == []
    assert ear.stand.told == ([] if "distance" in body else [NO_DISTANCE])


def test_hears_after_a_touch_of_the_sensors_that_count(ear: Ear) -> None:
    ear.send(101.0, TACTILE, touched("RearTactil"))
    assert ear.record(101.5, 4) == []
    ear.send(103.0, TACTILE, touched("RearTactil", "FrontTactil"))
    assert ear.record(103.0 + AFTER_TOUCH, 4) == ["can you dance"]


def test_what_is_said_as_somebody_begins_to_look_counts(ear: Ear) -> None:
    ear.now = 100.0
    ear.stand.bus.publish(FACE, NEAR)
    assert ear.record(100.5, 3, 4) == ["stop can you dance"]
    assert ear.record(99.8 + LEAD, 3, 4) == ["stop can you dance"]


def test_is_told_to_stop_by_anybody(ear: Ear) -> None:
    assert ear.record(101.0, 3) == ["stop"]


def test_says_whether_it_listens_and_why(ear: Ear) -> None:
    shown = ear.stand.listen(LISTENING)
    ear.send(101.0, FACE, NEAR)
    ear.send(102.0, TACTILE, touched("FrontTactil"))
    ear.state(103.0, command=SAY)
    ear.state(104.0, answer={"id": "d1", "kind": "done"})
    ear.send(105.0, FACE, NEAR)
    ear.send(120.0, FACE, {**NEAR, "distance": 3.0})
    assert [(body["listening"], body["because"]) for body in shown.bodies] == [
        (True, "face"),
        (True, "touch"),
        (False, "speaks"),
        (True, "touch"),
        (False, "nobody"),
    ]


def test_closes_by_itself(stand: Make) -> None:
    here = stand()
    here = stand(with_options(here.project, "ears", listens={"face": {"after": 0.1}}))
    shown = here.listen(LISTENING)
    here.add(Ears(here.project, here.bus, here.told.append, Silent()))
    here.bus.publish(FACE, NEAR)
    assert [body["because"] for body in shown.wait(3)] == ["nobody", "face", "nobody"]


class Silent:
    """A recogniser that is never asked."""

    languages = ("en",)

    def expect(self, sentences: Sequence[Sequence[str]]) -> None: ...

    def recognise(self, sound: Any) -> str:
        raise AssertionError


def test_without_the_setting_it_listens_always_and_looks_at_no_face(stand: Make) -> None:
    ear = Ear(stand())
    assert not {"face", "tactile"} & set(ear.stand.modules[0].hears())
    assert ear.record(101.0, 4) == ["can you dance"]


def test_a_saved_setting_counts_at_once(ear: Ear) -> None:
    ears = ear.stand.modules[0]
    ears.use(with_options(ear.stand.project, "ears", listens={"touch": {}}))
    ear.send(101.0, FACE, NEAR)
    assert ear.record(101.5, 4) == []
    ears.use(with_options(ear.stand.project, "ears"))
    assert ear.record(102.5, 4) == ["can you dance"]


@for_each("seed", range(20))
def test_is_open_where_a_face_or_a_touch_is_near_in_time(seed: int) -> None:
    """The state agrees with a search of all events for each moment."""
    chance = random.Random(seed)
    addressing = Addressing({"face": {"after": 2.0}, "touch": {"after": 5.0}}, lambda _: None)
    seen: list[tuple[float, float]] = []
    now = 0.0
    for _ in range(30):
        now = round(now + chance.choice((0.1, 0.1, 2.0, 7.0)), 3)
        if chance.random() < 0.7:
            addressing.face({"x": 1, "y": 1}, now)
            seen.append((now, 2.0))
        else:
            addressing.touch(touched("RearTactil"), now)
            seen.append((now, 5.0))
    closed = addressing.closed(10.0, 40.0)
    for moment in (10.05 + i / 10 for i in range(299)):
        is_open = any(at - LEAD <= moment <= at + after for at, after in seen)
        assert is_open != any(begin < moment < end for begin, end in closed)


def test_the_tours_robot_shows_it_by_its_ears() -> None:
    machine = lumen.load(".").machine
    snapshot = statechart.initial(machine).snapshot
    shown = []
    for listening in (True, False):
        step = statechart.step(machine, snapshot, Event("listening", {"listening": listening, "because": "face"}, 1.0))
        shown += [c.command.colours for c in step.commands if isinstance(c, Start) and isinstance(c.command, Leds)]
    assert shown == [{"ears": "blue"}, {"ears": "black"}]
