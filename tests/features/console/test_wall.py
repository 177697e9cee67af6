"""The wall of three robots on one broker, each with its own Rest."""

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from lumen.language.events import Event
from tests.features.console.conftest import Hosted
from tests.features.console.languages import english_on
from tests.features.console.pages import Served
from tests.features.console.test_alarms import ICON
from tests.features.console.viewer import Viewer
from tests.fetched import fetched
from tests.rabbitmq import GivenBroker, RabbitMQ
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow]
NAMES = ("NAO", "Ani", "Budi")
SETTINGS = "name: Mine\nbehavior: mine\nlanguages: [en]\nrobot: {{name: {}, model: nao}}\nhall: hall.xml\n"
MINE = """
events: {shown: {}, wait: {}}
states:
  hall: {do: {say: Good morning}, on: {stop: rests, shown: {target: rests, approve: operator}, wait: rests}}
  rests: {on: {resume: hall}}
"""


@pytest.fixture
def robots(tmp_path: Path, broker: RabbitMQ | GivenBroker) -> Iterator[dict[str, Hosted]]:
    with ExitStack() as stack:
        found = {}
        for name in NAMES:
            root = tmp_path / name
            (root / "behaviors").mkdir(parents=True)
            (root / "behaviors" / "mine.yaml").write_text(MINE)
            (root / "lumen.yaml").write_text(SETTINGS.format(name))
            found[name] = Hosted(root, broker.url)
            stack.callback(found[name].close)
        yield found


@pytest.fixture
def wall(robots: dict[str, Hosted], broker: RabbitMQ | GivenBroker) -> Iterator[str]:
    served = Served(robots["NAO"].root, bus=broker.url)
    until(lambda: {one["robot"] for one in served.browser.robots if one["connected"]} == set(NAMES), HANG)
    yield served.console.address
    served.close()


def resting(robots: dict[str, Hosted]) -> list[str]:
    return sorted(name for name, one in robots.items() if one.exhibition.robot.server.hold.stopped)


def test_each_tile_rests_its_robot_and_escape_twice_all(viewer: Viewer, wall: str, robots: dict[str, Hosted]) -> None:
    viewer.open(wall, ready=".tile:nth-child(3)")
    assert [one.text for one in viewer.all(".tile h2")] == sorted(NAMES)
    assert viewer.text("rest-button[main] .whom") == "all robots"
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    assert viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))") == []
    viewer.click("rest-button[robot=Budi] .rest")
    viewer.shows("Rests", "rest-button[robot=Budi] .rest-said")
    viewer.shows("rests, stopped by", ".tile[aria-label=Budi]")
    assert resting(robots) == ["Budi"]
    viewer.until(lambda: badges(viewer)["Ani"] == badges(viewer)["NAO"] == ["runs"])

    viewer.click(".tile[aria-label=Ani] h2 a")
    viewer.shows("Ani", ".who .name")
    viewer.shows("hall", ".leaf")
    assert not viewer.all(".stopped")
    viewer.click("nav li:first-child a")
    until(lambda: len(viewer.all(".tile")) == len(NAMES), HANG)

    viewer.escape_twice()
    viewer.shows("Rests", "rest-button[main] .rest-said")
    assert resting(robots) == sorted(NAMES)


@pytest.mark.parametrize("width", [1400, 360])
def test_the_wall_in_indonesian_shows_no_english(viewer: Viewer, wall: str, width: int) -> None:
    viewer.open(wall, ready=".tile:nth-child(3)", language="id", width=width)
    viewer.click("rest-button[robot=Budi] .rest")
    viewer.shows("istirahat, dihentikan oleh", ".tile[aria-label=Budi]")
    assert english_on(viewer) == []


def badges(viewer: Viewer) -> dict[str, list[str]]:
    return {name: viewer.text(f".tile[aria-label={name}] > .badge").splitlines() for name in sorted(NAMES)}


def test_a_robot_that_needs_a_person_is_never_green(viewer: Viewer, wall: str, robots: dict[str, Hosted]) -> None:
    """The tile, the title and the icon show a fall, a hot motor, and a robot that waits for Resume or for GO."""
    viewer.open(wall, ready=".tile:nth-child(3)")
    viewer.until(lambda: badges(viewer) == {name: ["runs"] for name in NAMES})  # a slow one does not answer at first
    assert "⚠" not in viewer.driver.title
    for event in ("fallen", "shown"):
        robots["Ani"].exhibition.loop.happen(Event(event))
    robots["Budi"].exhibition.loop.happen(Event("wait"))
    wanted = {"Ani": ["has fallen", "waits for your GO"], "Budi": ["waits for Resume"], "NAO": ["runs"]}
    until(lambda: badges(viewer) == wanted, HANG)
    assert viewer.run("return document.querySelector('.tile[aria-label=Ani]').dataset.state") == "bad"
    until(lambda: viewer.driver.title == "⚠ Ani: has fallen · Lumen", HANG)  # it is written after the tiles
    until(lambda: "icon-alarm.svg" in viewer.run(ICON), HANG)
    until(lambda: viewer.text(".connection") == "look at the robot", HANG)
    viewer.click(".tile[aria-label=Budi] .resume")
    viewer.click("dialog .strong")
    until(lambda: badges(viewer)["Budi"] == ["runs"], HANG)
    body = {"name": ["HeadYaw", "LKneePitch"], "position": [0.0, 0.0], "temperature": [40, 84]}
    robots["NAO"].exhibition.loop.bus.publish("avatar.NAO.data.joint", body)
    until(lambda: badges(viewer)["NAO"] == ["motor is hot"], HANG)
