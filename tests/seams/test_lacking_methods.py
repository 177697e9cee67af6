"""A custom robot, hall, bus or clock works without its optional methods, and is refused without a needed one."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from threading import Event as Signal
from typing import Any

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.language.commands import Do
from lumen.language.events import Event
from lumen.language.routes import Route
from lumen.language.stories import Visitor
from lumen.ports import (
    Aim,
    Bus,
    Clock,
    Hall,
    Live,
    Message,
    MessageHandler,
    OtherReading,
    Outgoing,
    Reading,
    Robot,
    RobotCommand,
    Sense,
)
from lumen.robot.remote import RemoteHall, RobotHost
from lumen.statechart import VirtualClock
from tests import ROOT
from tests.copying import copied_project
from tests.tables import for_each

BEHAVIOR = """\
words: common
entry: {wake: true}
states:
  waiting: {on: {face: greeting}}
  greeting:
    do: {say: {en: Hello}}
    hears: {bye: goodbye}
  goodbye:
    do: [{play: wave}, {say: {en: Goodbye!}}]
    onDone: waiting
"""
STORY = """\
title: A visitor says hello and goodbye
steps:
  - visitor: arrives
  - expect: {state: greeting}
  - says: Goodbye!
  - expect: {state: waiting, played: wave}
"""
TOUCHING = f"{STORY}  - touch: FrontTactil\n"


class GiftedRobot:
    """A robot with every method: it performs each command at once, and sees who is in its hall."""

    idle = False
    verbs = ("blink",)

    def __init__(self) -> None:
        self.answers: list[Event] = []
        self.visitor: Visitor | None = None
        self.calls: list[str] = []

    def start(self, id: str, command: RobotCommand) -> None:
        if not isinstance(command, Aim | Live | Do):
            self.answers.append(Event(f"done.command.{id}", None, 0.0))

    def cancel(self, id: str) -> None:
        self.answers.append(Event(f"cancelled.command.{id}", None, 0.0))

    def poll(self) -> Sequence[Event]:
        answers, self.answers = self.answers, []
        return answers

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        return None

    def read_other(self, sense: str) -> OtherReading | None:
        return None

    def close(self) -> None:
        self.calls.append("close")

    def advance(self, dt: float) -> None:
        """Do nothing: everything is over at once."""

    def place(self, visitor: Visitor | None) -> None:
        self.visitor = visitor

    def face(self) -> tuple[float, float] | None:
        return (160.0, 120.0) if self.visitor else None

    def touch(self, sensor: str, pressed: bool) -> None:
        self.calls.append("touch")

    def sound(self) -> None:
        self.calls.append("sound")

    def plug(self, plugged: bool) -> None:
        self.calls.append("plug")


class GiftedClock:
    """A clock with every method; time passes when it waits."""

    speed, realtime = None, 1.0

    def __init__(self) -> None:
        self.time = 0.0

    def now(self) -> float:
        return self.time

    def wait(self, until: float) -> None:
        self.time = max(self.time, until)

    def doze(self, until: float) -> float:
        return self.time

    def hurry(self) -> None:
        """Do nothing: this clock never sleeps."""


class GiftedBus(Bus):
    """A bus with every method, in this process."""

    blocked, sender, host, away, gone = "", "me", "hall", False, Signal()
    dropped: Mapping[str, int] = {}

    def __init__(self) -> None:
        self.within = MemoryBus()

    def carry(self, routes: Mapping[str, Route]) -> None:
        self.within.carry(routes)

    def prepare(self, routes: Mapping[str, Route]) -> None:
        self.within.prepare(routes)

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        return self.within.subscribe(pattern, handler)

    def send(self, message: Outgoing) -> None:
        self.within.send(message)

    def reply(self, message: Message, body: Any) -> None:
        self.within.reply(message, body)

    def close(self) -> None:
        self.within.close()

    def heard(self, key: str) -> bool:
        return True

    def returns(self, handler: Callable[[str], None]) -> None:
        """Do nothing: every message has a receiver."""


def methods_of(kind: type) -> set[str]:
    return {name for name in vars(kind) if not name.startswith("_")}


NEEDED = {Robot: methods_of(Robot), Clock: methods_of(Clock), Hall: methods_of(Hall)}
OF_ROBOT = sorted(methods_of(GiftedRobot) - NEEDED[Robot])
OF_CLOCK = sorted(methods_of(GiftedClock) - NEEDED[Clock])
OF_BUS = sorted(methods_of(GiftedBus) - methods_of(Bus))


def lacking(gifted: type, *names: str, base: type = object) -> Any:
    """Make an object of a class without these methods."""
    kept = {name: value for name, value in vars(gifted).items() if name not in ("__dict__", "__weakref__", *names)}
    return type(f"Lacking{gifted.__name__}", (base,), kept)()


def each_and_all(names: list[str]) -> list[tuple[str, ...]]:
    return [(), *((name,) for name in names), tuple(names)]


REFUSED = [
    *(("robot", GiftedRobot, name) for name in sorted(NEEDED[Robot])),
    *(("clock", GiftedClock, name) for name in sorted(NEEDED[Clock])),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = copied_project(ROOT / "examples/minimal", tmp_path_factory.mktemp("lacking") / "hall")
    (root / "behaviors/hello.yaml").write_text(BEHAVIOR)
    (root / "behaviors/stories/visitor.yaml").write_text(STORY)
    (root / "behaviors/stories/touching.yaml").write_text(TOUCHING)
    return root


def told(folder: Path, story: str | None = "visitor", **given: Any) -> str:
    """Run a story, or a second without one; return what is wrong with the story."""
    given = {"robot": GiftedRobot(), "clock": VirtualClock(), **given}
    with lumen.open(folder, story=story, **given) as exhibition:
        exhibition.run(None if story else 1.0)
        return exhibition.player.failure if exhibition.player else ""


@pytest.mark.parametrize("names", each_and_all(OF_ROBOT), ids=" ".join)
def test_a_robot_lacks_optional_methods(folder: Path, names: tuple[str, ...]) -> None:
    robot = lacking(GiftedRobot, *names)
    is_hall, feels = NEEDED[Hall].isdisjoint(names), "touch" not in names
    story = "touching" if is_hall and feels else "visitor" if is_hall else None
    assert told(folder, story, robot=robot) == ""
    assert {"touch", "sound"}.intersection(robot.calls) == ({"touch", "sound"}.difference(names) if is_hall else set())


@for_each("names, story", [(("place",), "visitor"), (("face",), "visitor"), (("touch",), "touching")])
def test_a_story_that_a_robot_cannot_play_is_refused(folder: Path, names: tuple[str, ...], story: str) -> None:
    with pytest.raises(lumen.UsageError, match=rf"the story `{story}` .*needs? .*the methods? .*`{names[0]}`"):
        told(folder, story, robot=lacking(GiftedRobot, *names))


@for_each("kind, gifted, name", REFUSED)
def test_a_missing_method_is_named_at_the_start(folder: Path, kind: str, gifted: type, name: str) -> None:
    with pytest.raises(lumen.UsageError, match=f"a {kind} needs the method `{name}`"):
        told(folder, story=None, **{kind: lacking(gifted, name)})


@pytest.mark.parametrize("name", sorted(methods_of(GiftedBus) & methods_of(Bus)))
def test_a_bus_of_ones_own_is_not_made_without_a_needed_method(name: str) -> None:
    with pytest.raises(TypeError, match=f"abstract method {name}"):
        lacking(GiftedBus, name, base=Bus)


@pytest.mark.parametrize("given", [{"robot": 7}, {"bus": 7}, {"clock": 7}], ids=str)
def test_what_is_no_robot_bus_or_clock_is_refused(folder: Path, given: dict[str, Any]) -> None:
    with pytest.raises(lumen.UsageError, match=f"a {next(iter(given))} needs the methods .*, which 7 does not have"):
        told(folder, story=None, **given)


def test_a_hall_elsewhere_lacks_methods(caplog: pytest.LogCaptureFixture) -> None:
    project, bus, robot = lumen.load(ROOT), MemoryBus(), lacking(GiftedRobot, "touch", "sound", "plug")
    host, hall = RobotHost(project, robot, bus, robot), RemoteHall(project, bus)
    hall.place(Visitor())
    hall.sound()
    hall.touch("FrontTactil", True)
    hall.plug(True)
    host.tick(0.0)
    assert robot.visitor == Visitor()
    refused = [record.message for record in caplog.records]
    assert [text.split(" {")[0] for text in refused] == [
        "an action of the visitor was refused: this hall has no action"
    ] * 2
    hall.close()
    host.close()


@pytest.mark.parametrize("names", each_and_all(OF_CLOCK), ids=" ".join)
def test_a_clock_lacks_optional_methods(folder: Path, names: tuple[str, ...]) -> None:
    assert told(folder, clock=lacking(GiftedClock, *names)) == ""


@pytest.mark.parametrize("names", each_and_all(OF_BUS), ids=" ".join)
def test_a_bus_lacks_optional_methods(folder: Path, names: tuple[str, ...]) -> None:
    assert told(folder, bus=lacking(GiftedBus, *names, base=Bus)) == ""
