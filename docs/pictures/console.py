"""Make the pictures of docs/console.md: a tour, a why, a fall, a refused reload, a day, a phone, and other pages.

    python -m docs.pictures.console [wall]

The program runs `lumen run` and `lumen console` in a copy of the project, with a visitor's words, and takes pictures in
Chromium. With `wall` it takes only the picture of the wall.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request
import uuid
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from tests.rabbitmq import RabbitMQ

ROOT = Path(__file__).parents[2]
PARTS = ("behaviors", "functions", "knowledge", "fuzzy", "motions", "schemas", "models", "lumen.yaml")
PORT = 8765
PAGE = f"http://127.0.0.1:{PORT}/"
WAIT = 300.0
WIDE, PHONE = (1400, 900), (360, 740)
"""The size of a window [px]."""
LUMEN = [sys.executable, "-m", "lumen"]


def ask(path: str, data: Any = None) -> Any:
    """Return the answer of the console."""
    body = None if data is None else json.dumps(data).encode()
    with urllib.request.urlopen(urllib.request.Request(PAGE + path, body, {"Content-Type": "application/json"})) as got:
        return json.loads(got.read())


def command(name: str, **fields: Any) -> Any:
    return ask("api/commands", {"id": uuid.uuid4().hex, "robot": "NAO", "command": name, **fields})


def hear(words: str) -> None:
    """Send the words of a visitor."""
    command("event", event="heard", data={"result": words})


def until(state: str) -> None:
    """Wait until that state is active."""
    wait(lambda: state in robot().get("configuration", ()), state)


def wait(come: Callable[[], bool], what: str) -> None:
    deadline = time.monotonic() + WAIT
    while not come():
        assert time.monotonic() < deadline, f"never {what}: {robot().get('configuration')}"
        time.sleep(0.2)


def robots() -> list[dict[str, Any]]:
    """Return the robots that the console shows; none until it answers."""
    try:
        return list(ask("api/now")["robots"])
    except OSError:
        return []


def robot() -> dict[str, Any]:
    """Return the first robot, empty if there is none yet."""
    return next(iter(robots()), {})


def waiting() -> set[str]:
    """Return the names of the robots that wait for a visitor's name."""
    return {robot["robot"] for robot in robots() if "ask_name" in robot.get("configuration", ())}


def visit(name: str, mood: str) -> None:
    """Play a visitor up to the state in which the robot offers its subjects."""
    until("ask_name")
    hear(f"my name is {name}")
    until("how_are_you")
    hear(mood)
    if mood != "fine":
        until("not_understood")
        until("how_are_you")
        hear("I am fine")
    until("offer")


class Camera:
    """A Chromium that takes pictures."""

    def __init__(self) -> None:
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--lang=en-GB", "--disable-gpu"):
            options.add_argument(argument)
        options.page_load_strategy = "none"  # each picture waits for its own text
        self.driver = webdriver.Chrome(options, Service(shutil.which("chromedriver")))

    def look(self, path: str, size: tuple[int, int] = WIDE, *, dark: bool = False, shows: str = "Rest") -> None:
        """Open a page, and wait until it is loaded and shows a text."""
        metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": scheme})
        self.driver.get(PAGE + path)
        time.sleep(3)
        wait(lambda: shows in self.shown() and "Loading" not in self.shown(), "a loaded page")

    def shown(self) -> str:
        """Return the text of the page."""
        return str(self.driver.execute_script("return document.body?.innerText ?? ''"))

    def sees(self, text: str) -> None:
        """Wait until the page shows a text."""
        wait(lambda: text in self.shown(), f"“{text}” on the page")

    def press(self, selector: str, text: str = "") -> None:
        """Press the first element that matches and has this text."""
        next(one for one in self.driver.find_elements(By.CSS_SELECTOR, selector) if text in one.text).click()
        time.sleep(3)

    def take(self, name: str) -> None:
        self.driver.save_screenshot(str(ROOT / f"docs/pictures/console_{name}.png"))


@contextmanager
def running(folder: Path, *words: str) -> Iterator[None]:
    process = subprocess.Popen([*LUMEN, *words], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        process.wait()


def project(stack: ExitStack, name: str = "NAO") -> Path:
    """Copy the shipped exhibition for a robot of that name."""
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    for part in PARTS:
        (shutil.copytree if (ROOT / part).is_dir() else shutil.copy)(ROOT / part, folder / part)
    settings = folder / "lumen.yaml"
    settings.write_text(settings.read_text("utf-8").replace("{name: NAO,", f"{{name: {name},"), "utf-8")
    return folder


def main() -> None:
    with ExitStack() as stack:
        camera = Camera()
        stack.callback(camera.driver.quit)
        if "wall" not in sys.argv[1:]:
            with ExitStack() as tour:
                take_tour(tour, camera)
            with ExitStack() as seen:
                take_see(seen, camera)
        take_wall(stack, camera)


def take_wall(stack: ExitStack, camera: Camera) -> None:
    """Three robots on one broker; one of them rests."""
    broker = RabbitMQ()
    broker.start()
    stack.callback(broker.stop)
    folders = [project(stack, name) for name in ("NAO", "Ani", "Budi")]
    for folder in folders:
        stack.enter_context(running(folder, "run", "--robot", "recording", "--speed", "1", "--bus", broker.url))
    stack.enter_context(running(folders[0], "console", "--port", str(PORT), "--bus", broker.url))
    wait(lambda: waiting() == {"NAO", "Ani", "Budi"}, "three robots that wait for a name")
    command("rest", robot="Budi")
    camera.look("")
    camera.sees("Resume")
    camera.take("wall")


def take_tour(stack: ExitStack, camera: Camera) -> None:
    folder = project(stack)
    stack.enter_context(running(folder, "run", "--robot", "recording", "--speed", "1"))
    stack.enter_context(running(folder, "console", "--port", str(PORT)))
    visit("Budi", "fine")
    hear("dance")
    until("dance")
    camera.look("")
    camera.sees("Plays dance for Budi")
    camera.take("now")
    camera.press(".entry button", "With pleasure!")
    wait(lambda: "Loading" not in camera.shown(), "a why")
    camera.take("why")
    tour = folder / "behaviors/tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace('stop: "#any_question"', 'stop: "#any_qestion"'), "utf-8")
    wait(lambda: (robot().get("files", {}).get("last") or {}).get("verdict") == "refused", "files that are refused")
    camera.look("robot/NAO/files")
    camera.sees("did you mean `#any_question`?")
    camera.take("files")
    camera.look("robot/NAO/day", (1400, 1250), dark=True)
    camera.take("day")
    camera.look("", PHONE, dark=True)
    camera.press(".rest")
    wait(lambda: "Rests, after" in camera.shown(), "an answer to Rest")
    camera.take("phone")
    command("resume")
    until("watching")
    command("event", event="fallen", data=None)
    camera.look("")
    camera.sees("The robot fell.")
    camera.take("fall")


def take_see(stack: ExitStack, camera: Camera) -> None:
    """A simulated robot in its hall, and the words that it says."""
    folder = project(stack)
    stack.enter_context(running(folder, "run", "--robot", "simulation", "--speed", "1"))
    stack.enter_context(running(folder, "console", "--port", str(PORT)))
    until("ask_name")
    camera.look("robot/NAO/see")
    wait(lambda: bool(camera.driver.find_elements(By.CSS_SELECTOR, ".picture img:not(.unseen)")), "the camera's image")
    camera.take("see")
    hear("my name is Budi")
    camera.look("robot/NAO/subtitles", shows="How are you, Budi?")
    camera.take("subtitles")


if __name__ == "__main__":
    main()
