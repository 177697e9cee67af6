"""An idle exhibition sleeps, and any input wakes it: even naps of an hour cause no delay."""

import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

import lumen
from lumen.clock import bell
from lumen.clock.real import RealClock
from lumen.language.events import Event
from lumen.run import node as naps
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.loop import TICK_PERIOD
from lumen.run.node import Node
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.setup import Setup, set_up, set_up_house
from tests.saving import save
from tests.waiting import until

NAMES = ("ana", "ben")
MAIN = """
name: Asleep
behavior: sleeper
languages: [en]
ROBOT
routes:
  heard: {key: "lumen.{robot}.audio.speech.recognition", direction: in, schema: speech.recognition, event: heard}
"""
BEHAVIOR = """
initial: asleep
on: {heard: {target: .awake}}
states:
  asleep: {after: {300ms: dreaming}}
  dreaming: {}
  awake: {}
"""


class StoppedTime:
    """A stand-in for the module `time`, whose time passes only in `sleep`."""

    def __init__(self) -> None:
        self.now, self.slept = 100.0, list[float]()

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += seconds


def test_who_rings_all_the_time_is_heard_fifty_times_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    time, rung = StoppedTime(), bell.Bell()
    monkeypatch.setattr(bell, "time", time)
    for _ in range(3):
        rung.ring()
        rung.sleep(1.0)
    assert time.slept == pytest.approx([0.02, 0.02])


def project(root: Path, robot: str = "robot: {name: NAO, model: nao}") -> Path:
    (root / "behaviors").mkdir()
    (root / "lumen.yaml").write_text(MAIN.replace("ROBOT", robot), "utf-8")
    (root / "behaviors/sleeper.yaml").write_text(BEHAVIOR, "utf-8")
    return root


@pytest.fixture
def long(monkeypatch: pytest.MonkeyPatch) -> None:
    """Naps that last an hour unless the exhibition is woken."""
    monkeypatch.setattr(naps, "NAP", 3600.0)


@pytest.fixture(params=["simulated", "real"])
def sleeper(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Exhibition]:
    """An exhibition that waits for a visitor's words, in real time."""
    loaded = lumen.load(project(tmp_path))
    setup = set_up("recording", loaded, "1")
    if request.param == "real":
        setup = Setup(setup.robot, RealClock(), setup.hall)
    show = Exhibition(Plan(loaded, setup, f"memory://{tmp_path}", options={"reload": "auto"}))
    show.start()
    yield show
    show.close()


class Ticks(Part):
    """Counts the ticks that an exhibition lives through."""

    patient = True

    def __init__(self) -> None:
        self.times: list[float] = []

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self.times.append(now)


def ticks_of(show: Exhibition) -> Sequence[float]:
    ticks = Ticks()
    show.node.parts.append(ticks)
    return ticks.times


def lived_until(show: Exhibition, state: str) -> None:
    """Nap and tick until the exhibition is in that state."""
    until(lambda: state in show.configuration, meanwhile=lambda: lived(show.node))


def lived(one: Node | House) -> None:
    """Nap and tick once."""
    one.nap()
    one.tick()


def test_while_nothing_is_due_it_ticks_seldom(sleeper: Exhibition) -> None:
    lived_until(sleeper, "dreaming")
    began, ticks = sleeper.now, ticks_of(sleeper)
    until(lambda: len(ticks) >= 5, meanwhile=lambda: lived(sleeper.node))
    assert sleeper.now - began > 5 * 2 * TICK_PERIOD
    assert "dreaming" in sleeper.configuration


def test_a_timer_is_on_time(sleeper: Exhibition, long: None) -> None:
    began, ticks = sleeper.now, ticks_of(sleeper)
    lived_until(sleeper, "dreaming")
    assert len(ticks) < 5
    assert sleeper.now - began >= 0.3 - TICK_PERIOD


def test_a_message_wakes_it(sleeper: Exhibition, long: None) -> None:
    lived_until(sleeper, "dreaming")
    hear = threading.Timer(0.1, lambda: sleeper.send("heard", {"result": "hello"}))
    hear.start()
    lived_until(sleeper, "awake")
    hear.join()


@pytest.mark.process
def test_a_saved_file_wakes_it(sleeper: Exhibition, long: None) -> None:
    lived_until(sleeper, "dreaming")
    behavior = Path(sleeper.project.root) / "behaviors/sleeper.yaml"
    save(behavior, BEHAVIOR.replace("dreaming: {}", "dreaming: {always: [{target: awake}]}"))
    lived_until(sleeper, "awake")


def test_what_one_robot_of_a_house_hears_wakes_all(tmp_path: Path, long: None) -> None:
    root = project(tmp_path, "robots: {ana: {model: nao}, ben: {model: nao}}")
    projects = {name: lumen.load(root, robot=name) for name in NAMES}
    setups = set_up_house("recording", projects, "1", dict.fromkeys(NAMES))
    shows = {name: Exhibition(Plan(projects[name], setups[name], f"memory://{tmp_path}")) for name in NAMES}
    house = House({name: show.services for name, show in shows.items()})
    house.start()
    until(lambda: all("dreaming" in show.configuration for show in shows.values()), meanwhile=lambda: lived(house))
    hear = threading.Timer(0.1, lambda: shows["ben"].send("heard", {"result": "hello"}))
    hear.start()
    until(lambda: "awake" in shows["ben"].configuration, meanwhile=lambda: lived(house))
    hear.join()
    assert "awake" not in shows["ana"].configuration
    assert shows["ana"].now == pytest.approx(shows["ben"].now, abs=TICK_PERIOD)
    house.close()
