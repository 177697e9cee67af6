"""An operator's half hour: broken visitors, a bad edit, a fall, a robot and a broker that are gone.

The operator sees and mends each problem on the pages, and uses nothing else. The test waits for each page as a person
would. `pytest -m soak` plays as many scenes as fill half an hour, and also measures how soon a page in turn shows a
fall, a lost process and a lost broker.
"""

import sys
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from itertools import cycle
from random import Random
from statistics import median, quantiles
from time import time

import pytest
from selenium.common.exceptions import WebDriverException

from lumen.run.presence import LOST_AFTER
from tests.features.console.chromium import Chromium
from tests.features.console.house import ROBOT, House
from tests.saving import save
from tests.waiting import HANG, until

HEARD, FACE = "lumen.NAO.audio.speech.recognition", "lumen.NAO.visual.face.detection"
LOOK = 0.25
"""Seconds between two looks at a page."""
HALF_HOUR = 1800.0
"""Seconds after which no further round of all scenes begins."""
SOON = 1.0
"""Seconds after which 9 of 10 alarms must be on a page."""
PAGES = ("", "/day", "/files", "/see")
ALARMS = """
globalThis.alarmed = 0;
(function look() {
  const state = document.querySelector(".connection")?.dataset.state;
  if (["alarm", "robot-lost", "robot-away"].includes(state)) globalThis.alarmed = Date.now() / 1000;
  else requestAnimationFrame(look);
})();
"""
"""Notes when the page's header shows an alarm [s since 1970]."""
LEFT = "visitor.left: goodbye"
NONSENSE = ("blub <b>blab</b>", "\u202e\u0000", "?" * 200, "{{ visitor }}", "'; drop table visits; --")
BROKEN = (None, 7, [], {"result": 12}, {"x": "left"}, {"result": "a" * 100_000})
ALL = """
const entries = [...document.querySelectorAll(".entry")].map((one) => one.textContent);
return [document.body?.innerText ?? "", ...entries].join("\\n");
"""
"""All text of the page, with the entries that are visible only after scrolling."""
STATES = "return [...document.querySelectorAll('.leaf .state-name')].map((one) => one.textContent)"


class Operator:
    """An operator who has only the pages."""

    def __init__(self, house: House, chromium: Chromium, *, timed: bool = False) -> None:
        self._house, self._chromium, self._timed, self._pages = house, chromium, timed, cycle(PAGES)
        self.times = defaultdict[str, list[float]](list)
        """The delays of the alarms on pages, by kind of trouble [s]."""

    def is_alarmed(self, kind: str, trouble: Callable[[], object], after: float = 0.0) -> None:
        """Cause a trouble; if `timed`, on the next page, and note the delay until it shows an alarm, less `after`."""
        if not self._timed:
            trouble()
            return
        self.looks_at(next(self._pages))
        until(lambda: self.shown() and "live" in self._chromium.find(".connection").text, HANG, every=LOOK)
        self._chromium.run(ALARMS)
        began = time()
        trouble()
        until(lambda: self._chromium.run("return globalThis.alarmed"), HANG, every=LOOK)
        self.times[kind].append(float(self._chromium.run("return alarmed")) - began - after)
        self.looks_at()

    def looks_at(self, page: str = "") -> None:
        self._chromium.open(f"{self._house.address}robot/NAO{page}")

    def sees(self, *texts: str) -> None:
        shown = ""

        def seen() -> bool:
            nonlocal shown
            shown = self.shown()
            return all(text in shown for text in texts)

        try:
            until(seen, HANG, every=LOOK)
        except AssertionError:
            missing = [text for text in texts if text not in shown]
            raise AssertionError(f"{missing} is not seen on\n{shown[:3000]}") from None

    def shown(self) -> str:
        return str(self._chromium.run(ALL))

    def sees_no(self, selector: str) -> None:
        until(lambda: not self._chromium.all(selector), HANG, every=LOOK)

    def sees_now(self, selector: str) -> bool:
        return bool(self._chromium.all(selector))

    def sees_it_in(self, state: str) -> None:
        """Wait until the page shows that innermost state as active."""
        until(lambda: self.sees_it_now_in(state), HANG, every=LOOK)

    def sees_it_now_in(self, state: str) -> bool:
        return state in self._chromium.run(STATES)

    def presses(self, selector: str) -> None:
        def pressed() -> bool:
            with suppress(WebDriverException):  # it was drawn anew meanwhile
                found = self._chromium.find(selector)
                if found.is_enabled():  # the page is not away for a moment
                    found.click()
                    return True
            return False

        until(pressed, HANG, every=LOOK)

    def reads_notices(self) -> None:
        """Press `read` until no notice is left."""

        def none_left() -> bool:
            with suppress(WebDriverException, IndexError):  # it was drawn anew meanwhile
                self._chromium.all(".notice button")[0].click()
            return not self.sees_now(".notice button")

        until(lambda: self.sees_now(".notice button"), HANG, every=LOOK)
        until(none_left, HANG, every=LOOK)

    def rests(self, *outcomes: str) -> None:
        self._chromium.quiet()
        self._chromium.rest()
        until(lambda: any(outcome in self._chromium.said() for outcome in outcomes), HANG, every=LOOK)

    def lets_go_on(self) -> None:
        self.presses("button.resume")
        self.presses("dialog button.strong")
        self.sees_no(".stopped")
        self.sees_it_in("watching")

    def raises(self, event: str) -> None:
        """Raise an event over the console, as a cue does; again if a busy machine was too late to send it."""
        raised = partial(self._house.browser.command, "event", event=event, robot="NAO")
        until(lambda: raised().data["state"] == "finished", HANG)


def broken_visitors(house: House, operator: Operator) -> None:
    for body in BROKEN:
        house.send(HEARD, body)
        house.send(FACE, body)
    for words in NONSENSE:
        house.send(HEARD, {"result": words, "language": "en"})
    operator.sees(NONSENSE[-1])


def a_bad_edit(house: House, operator: Operator) -> None:
    tour = house.folder / "behaviors" / "tour.yaml"
    good = tour.read_text("utf-8")
    assert LEFT in good
    save(tour, good.replace(LEFT, LEFT.replace("goodbye", "godbye")))
    line = good[: good.index(LEFT)].count("\n") + 1
    operator.sees("refused", f"behaviors/tour.yaml:{line}", "The robot continues with the previous files")
    operator.looks_at("/files")
    operator.sees(
        "there is no state `godbye`", "did you mean `goodbye`?", "The robot continues with the previous files"
    )
    save(tour, good)
    operator.sees("No findings.", "The saved files are the ones that run")
    operator.looks_at()


def a_fall(house: House, operator: Operator) -> None:
    operator.sees_it_in("watching")
    operator.is_alarmed("a fall", lambda: operator.raises("fallen"))
    operator.sees("The robot fell.", "Keep visitors away", "I fell")
    operator.reads_notices()
    operator.looks_at()  # a notice that was read does not come again with the next page
    operator.sees("I am on my feet again")
    operator.sees_it_in("watching")
    assert not operator.sees_now(".notice button")


def a_robot_that_is_gone(house: House, operator: Operator) -> None:
    operator.sees_it_in("watching")
    operator.is_alarmed("a lost process", lambda: house.kill(ROBOT), LOST_AFTER)
    operator.sees("the robot is not connected", "The process of NAO has ended", "lumen run --only robot")
    operator.sees_it_in("robot_lost")
    operator.rests("NOT SENT", "The robot does not rest")
    house.begin(ROBOT)
    house.await_robot()
    operator.sees("live")
    operator.rests("Rests")
    operator.lets_go_on()


def a_broker_that_is_gone(house: House, operator: Operator) -> None:
    assert house.broker
    operator.is_alarmed("a lost broker", house.broker.kill)
    operator.sees("NAO does not answer", "the broker")
    operator.rests("NOT SENT")
    house.broker.start()
    house.await_robot()
    operator.sees("live")
    operator.rests("Rests")
    operator.lets_go_on()


SCENES: tuple[Callable[[House, Operator], None], ...] = (
    broken_visitors,
    a_bad_edit,
    a_fall,
    a_robot_that_is_gone,
    a_broker_that_is_gone,
)


def begin(house: House, operator: Operator) -> None:
    """Let a visitor come, stay, and give a name at each request, since a busy machine may miss the first one."""
    operator.looks_at()

    def introduced() -> bool:
        house.send(FACE, {"x": 160, "y": 120})
        if operator.sees_it_now_in("ask_name"):
            house.send(HEARD, {"result": "my name is Budi", "language": "en"})
        return "Visitor: Budi" in operator.shown()

    until(introduced, HANG, every=LOOK)
    operator.sees("my name is Budi")


@pytest.mark.slow
def test_whatever_happens_is_seen_on_the_pages_and_mended_from_them(
    house_on_its_broker: House, chromium: Chromium
) -> None:
    operator = Operator(house_on_its_broker, chromium)
    begin(house_on_its_broker, operator)
    for scene in SCENES[:-1]:  # a second start of the broker costs as much as all else
        scene(house_on_its_broker, operator)
    operator.looks_at("/day")
    operator.sees("Visit 1", "Budi")


@pytest.mark.soak
@pytest.mark.xdist_group("rest on a broker")
def test_half_an_hour_of_it(house_on_its_broker: House, chromium: Chromium) -> None:
    operator, draw = Operator(house_on_its_broker, chromium, timed=True), Random(18)
    begin(house_on_its_broker, operator)
    end = time() + HALF_HOUR
    while time() < end:
        for scene in draw.sample(SCENES, len(SCENES)):
            scene(house_on_its_broker, operator)
    operator.looks_at("/day")
    operator.sees("Visit 1", "Budi")
    late = {}
    for kind, times in operator.times.items():
        most = quantiles(times, n=10, method="inclusive")[-1]
        sys.stdout.write(
            f"{kind}, {len(times)} times: on a page after {median(times):.2f} s, "
            f"9 of 10 within {most:.2f} s, all within {max(times):.2f} s\n"
        )
        if most > SOON:
            late[kind] = most
    assert not late
