"""Twelve jobs of an operator or author at the console: clicks, keys, and the time until the page shows the result.

    python benchmarks/console_jobs.py

Prints the table of docs/console.md, with which tests/features/console/test_twelve_jobs.py compares the clicks and keys.
Chromium shows the pages. Two robots are on one broker: NAO performs the shipped tour, in which a dance needs a GO. Each
job begins on the page Now, signed in; it does what a person does, and nothing else. The time is from the first click
until the page shows the result; the time to type is not in it.
"""

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from time import monotonic
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.viewer import Viewer
from tests.guarded import temporary_folder
from tests.rabbitmq import LentBroker
from tests.servers import PORT, Servers, given
from tests.tour.conftest import copied
from tests.waiting import HANG, until

from lumen.features.console.people import Role

PIN = "author-3333"
OTHER = "Ani"
HEARD, FACE = "heard", "face"
DANCE = 'dance: "#dance"'
WITH_GO = 'dance: {target: "#dance", approve: operator}'
PATIENCE, MORE = '30s: "#goodbye"', '1h: "#goodbye"'
SORRY = "I cannot wave right now. Goodbye!"
LATER = "I cannot wave right now. See you tomorrow!"
LEFT, WRONG = "visitor.left: goodbye", "visitor.left: godbye"
QUESTION = "what is the meaning of life"
FIND = """
const [selector, text, done] = arguments;
const find = () => [...document.querySelectorAll(selector)].filter((one) => one.checkVisibility())
  .find((one) => (one.innerText || one.textContent).includes(text)) ?? null; // no innerText outside of the window
const before = find(), top = before?.getBoundingClientRect().top;
requestAnimationFrame(() => requestAnimationFrame(() => {
  done(before && find() === before && before.getBoundingClientRect().top === top ? before : null);
}));
"""
"""Finds an element with a text that does not move, as a person waits for a page that still loads."""


class Done(NamedTuple):
    """The clicks, keys and time [s] of a job."""

    clicks: int
    keys: int
    seconds: float


class Person:
    """A person at a page, whose clicks and keys are counted from `begin` on."""

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self.begin()

    def begin(self) -> None:
        self._clicks = self._keys = 0
        self._began = 0.0

    def end(self) -> Done:
        return Done(self._clicks, self._keys, monotonic() - self._began)

    def click(self, selector: str, text: str = "", *, held: bool = False) -> None:
        """Click the first visible match with this text as soon as there is one; hold it until the page reports it."""

        found: list[WebElement] = []

        def there() -> bool:
            with suppress(WebDriverException):
                found[:] = filter(None, [self._viewer.driver.execute_async_script(FIND, selector, text)])
            return bool(found)

        def clicked() -> bool:
            if not there():
                return False
            self._began = self._began or monotonic()
            with suppress(WebDriverException):
                return self._viewer.lands(found[0], selector)
            return False

        if held:
            self._viewer.until(there)
            self._began = self._began or monotonic()
            self._viewer.hold(lambda: found[0] if there() else None, text)
        else:
            self._viewer.until(clicked)
        self._clicks += 1

    def type(self, *keys: str) -> None:
        """Type into what has the focus."""
        self._viewer.type(*keys)
        self._keys += sum(map(len, keys))

    def focused(self, selector: str) -> None:
        """Wait until such an element has the focus."""
        self._viewer.until(lambda: self._viewer.run("return document.activeElement?.matches(arguments[0])", selector))

    def sees(self, text: str, selector: str = "body") -> None:
        """Wait until the page shows the text in visible elements that match."""
        self._viewer.shows(text, selector)

    def sees_no(self, selector: str) -> None:
        self._viewer.until(lambda: not self._viewer.text(selector))


class Desk:
    """Two exhibitions on a broker, their console, and a person who is signed in."""

    def __init__(self, stack: ExitStack, folder: Path, broker: str) -> None:
        for name in ("NAO", OTHER):
            (folder / name).mkdir()
            copied(folder / name)
        settings = folder / OTHER / "lumen.yaml"
        settings.write_text(settings.read_text("utf-8").replace("{name: NAO,", f"{{name: {OTHER},"), "utf-8")
        self.root = folder / "NAO"
        self.tour = self.root / "behaviors/tour.yaml"
        self.change(DANCE, WITH_GO)
        self.change(PATIENCE, MORE)  # on a slow machine the visitor takes longer
        self._hosted = [Hosted(folder / name, broker) for name in ("NAO", OTHER)]
        for one in self._hosted:
            stack.callback(one.close)
        self.served = Served(self.root, bus=broker, pins={Role.AUTHOR: PIN})
        stack.callback(self.served.close)
        self.viewer = Viewer()
        stack.callback(self.viewer.close)
        self.person = Person(self.viewer)
        self.time = ""

    @property
    def address(self) -> str:
        return self.served.console.address

    def change(self, old: str, new: str) -> None:
        """Save the tour with another text."""
        text = self.tour.read_text("utf-8")
        assert old in text, old
        self.tour.write_text(text.replace(old, new), "utf-8")

    def sign_in(self) -> None:
        """Sign in as an author, who sees all."""
        self.viewer.open(self.address, "robot/NAO", ready=".notice .strong", mode="author")
        self.viewer.click(".notice .strong")
        self.person.focused("#pin input")
        self.viewer.type(PIN, "\t", "Aisyah", "\n")
        self.viewer.until(lambda: self.viewer.all(".leaf"))

    def look(self) -> None:
        """Open the page Now, where each job begins."""
        self.viewer.driver.get(f"{self.address}robot/NAO")
        self.viewer.until(lambda: self.viewer.all(".leaf"))
        self.viewer.until(
            lambda: self.viewer.run("return document.querySelector('.connection')?.dataset.state") == "live"
        )

    def says(self, words: str) -> None:
        """A visitor says something to NAO."""
        self._hosted[0].send(HEARD, {"result": words, "language": "en"})

    def until(self, state: str) -> None:
        """Wait until NAO's behaviour is in a state."""
        until(lambda: state in self._hosted[0].exhibition.configuration, HANG)

    def visit(self) -> None:
        """Budi visits NAO, feels fine, and asks a question without an answer."""
        self._hosted[0].send(FACE, {"x": 160, "y": 120})
        self.until("ask_name")
        self.says("my name is Budi")
        self.until("how_are_you")
        self.says("I am fine")
        self.until("offer")
        self.says(QUESTION)
        self.until("answer")
        self.until("any_question")

    def asks_to_dance(self) -> None:
        self.says("dance")
        self.person.sees("Waits for your GO", ".approvals")

    def waits_for_day(self, what: Callable[[dict[str, Any]], object]) -> None:
        """Wait until the day's data has something."""
        until(lambda: what(self.fetched("/api/day?robot=NAO")), HANG)

    def fetched(self, path: str) -> dict[str, Any]:
        """Return what the console answers to the signed-in page."""
        script = "fetch(arguments[0]).then((one) => one.json()).then(arguments[1])"
        return dict(self.viewer.driver.execute_async_script(script, path))

    def applied(self) -> None:
        """Another text is saved and applied."""
        self.change(SORRY, LATER)
        applied = "lumen.post({ robot: 'NAO', command: 'apply' }, (state) => { globalThis.became = state; })"
        until(lambda: self.fetched("/api/files?robot=NAO").get("staged"), HANG)
        self.viewer.run(applied)
        self.viewer.until(lambda: self.viewer.run("return globalThis.became") == "finished")
        self.look()

    def saved_with_an_error(self) -> None:
        self.change(LEFT, WRONG)
        self.person.sees("refused", "main")

    def danced_at(self) -> None:
        """Note when NAO began to dance, as the clock on the page shows it."""
        self.waits_for_day(lambda day: day["visits"])
        day = self.fetched("/api/day?robot=NAO")
        ends = f"from={day['visits'][0]['from']}&to={day['visits'][-1]['to']}"
        [one, *_] = self.fetched(f"/api/search?robot=NAO&{ends}&text=With%20pleasure")["entries"]
        local = "return new Date(arguments[0]).toLocaleTimeString('en-GB').slice(0, 5)"
        self.time = str(self.viewer.run(local, one["at_time"]))


def rest(person: Person, desk: Desk) -> None:
    person.click("rest-button[main] .rest")
    person.sees("Rests", ".rest-said")


def resume(person: Person, desk: Desk) -> None:
    person.click(".resume")
    person.click("dialog .strong")
    person.sees_no(".stopped")


def say(person: Person, desk: Desk) -> None:
    person.click(".say input")
    person.type("Welcome!", Keys.ENTER)
    person.sees("Welcome!", ".lines-of-talk")


def button(person: Person, desk: Desk) -> None:
    person.click(".declared", "End the visit", held=True)
    person.sees("End the visit: done", ".told")


def go(person: Person, desk: Desk) -> None:
    person.sees("“dance”", ".approval .visitor-said")
    person.click(".approval .go")
    person.sees("dance", ".leaf")


def why(person: Person, desk: Desk) -> None:
    person.click("nav a", "The day")
    person.click(".go-to input")
    person.type(desk.time, Keys.ENTER)
    person.click(".day .entry button", "With pleasure!")
    person.click(".chosen button", "Why")
    person.sees("heard", "dialog .chain")


def story(person: Person, desk: Desk) -> None:
    person.click("nav a", "The day")
    person.click(".keep-story button")
    person.focused("#keep-story input")
    person.type("Ani", Keys.ENTER)
    person.sees("behaviors/stories/visit_", ".keep-story")


def bad_file(person: Person, desk: Desk) -> None:
    person.click("nav a", "Files")
    person.sees("did you mean `goodbye`?", ".findings")


def roll_back(person: Person, desk: Desk) -> None:
    person.click("nav a", "Files")
    person.click(".saved [data-verb=rollback]")
    person.click("dialog .strong")
    person.sees("behaviors/tour.yaml is as it was before", ".saved")


def unanswered(person: Person, desk: Desk) -> None:
    person.click("nav a", "The day")
    person.click(".unanswered li button")
    person.focused(".unanswered form input")
    person.type("42.", Keys.TAB, "apa arti hidup", Keys.TAB, "42.", Keys.ENTER)
    person.sees("knowledge/what-is-the-meaning-of-life.yaml", ".unanswered")


def other_robot(person: Person, desk: Desk) -> None:
    person.click("nav a", "All robots")
    person.click(f"rest-button[robot={OTHER}] .rest")
    person.sees("Rests", f"rest-button[robot={OTHER}] .rest-said")


def sign_out(person: Person, desk: Desk) -> None:
    person.click(".settings > button")
    person.click("#settings button", "Sign out")
    person.sees("Sign in to use this console", "main")


class Job(NamedTuple):
    """A job as docs/console.md calls it, what must be so before, and what a person does."""

    name: str
    do: Callable[[Person, Desk], None]
    before: Callable[[Desk], object] = lambda _desk: None
    after: Callable[[Desk], object] = lambda _desk: None


JOBS = (
    Job("Rest", rest),
    Job("Resume", resume),
    Job("Say a sentence of 8 characters", say),
    Job("Press a button of the tour, held for a second", button),
    Job("Read the visitor's words and give GO", go, Desk.asks_to_dance),
    Job("Ask why at 14:03", why, Desk.danced_at),
    Job("Make a story of a visit, with another name", story),
    Job("Find the error in a saved file", bad_file, Desk.saved_with_an_error, lambda desk: desk.change(WRONG, LEFT)),
    Job("Roll back", roll_back, Desk.applied),
    Job("Answer an unanswered question in two languages", unanswered),
    Job("Rest another robot on the wall", other_robot),
    Job("Sign out", sign_out),
)
"""The jobs in the order of the table."""
ORDER = (say, go, button, rest, resume, why, story, bad_file, roll_back, unanswered, other_robot, sign_out)
"""The jobs in the order of a visit."""


def done_jobs(folder: Path, broker: str) -> dict[str, Done]:
    """Do all jobs, and return what each took."""
    found = {}
    with ExitStack() as stack:
        desk = Desk(stack, folder, broker)
        desk.sign_in()
        desk.visit()
        for job in sorted(JOBS, key=lambda one: ORDER.index(one.do)):
            desk.look()
            job.before(desk)
            desk.person.begin()
            job.do(desk.person, desk)
            found[job.name] = desk.person.end()
            job.after(desk)
    return found


def table(found: dict[str, Done]) -> str:
    """Return the table of docs/console.md."""
    rows = [f"| {job.name} | {found[job.name].clicks} | {found[job.name].keys} |" for job in JOBS]
    rows = [f"{row} {found[job.name].seconds:.1f} s |" for row, job in zip(rows, JOBS, strict=True)]
    return "\n".join(("| job | clicks | keys | time |", "| --- | --- | --- | --- |", *rows))


@contextmanager
def servers() -> Iterator[None]:
    """Start Chromium and the broker when they are needed, as a run of the tests does."""
    started = Servers()
    os.environ[PORT] = str(started.port)
    try:
        yield
    finally:
        started.close()


def main() -> None:
    folder = temporary_folder("lumen-jobs-")
    try:
        with servers():
            print(table(done_jobs(folder, LentBroker(**given("broker")).url)))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
