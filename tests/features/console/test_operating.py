"""Work on the pages: sign in, press buttons that the states declare, say GO, and ask why."""

from collections.abc import Iterator
from contextlib import suppress

import pytest
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.keys import Keys

from lumen.features.console.people import Role
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.viewer import PRESSES, Viewer
from tests.fetched import fetched
from tests.saving import save
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("operating")]
PINS = {Role.SHOW: "show-1111", Role.OPERATOR: "operator-2222", Role.AUTHOR: "author-3333"}
SEEN = {"buttons": ".declared", "say": ".say", "autonomy": ".body .choice", "cues": ".cues"}
"""Controls that need a role, and their selectors on the page."""
MAY = {Role.SHOW: {"buttons"}, Role.OPERATOR: {"buttons", "say", "autonomy"}, Role.AUTHOR: set(SEEN)}
CHOOSE = """
const found = [...document.querySelectorAll(".entry button")].find((one) => one.textContent.includes(arguments[0]));
found?.click();
return Boolean(found);
"""
SETTINGS = """
lumen: 1
name: Mine
behavior: mine
languages: [en]
robot: {name: NAO, model: nao}
hall: hall.xml
routes:
  heard: {key: "lumen.{robot}.heard", direction: in, schema: speech.recognition, event: heard, ttl: 5s}
"""
MINE = """
context: {n: 0}
states:
  hall:
    buttons:
      - {label: Quick, event: quick, key: q}
      - {label: Held, event: held, confirm: hold, key: h}
      - {label: Asked, event: asked, confirm: ask}
      - {label: Not now, event: never}
    on:
      quick: {actions: {assign: {n: context.n + 1}}}
      held: {actions: {assign: {n: context.n + 10}}}
      asked: {actions: {assign: {n: context.n + 100}}}
      never: {guard: context.n < 0, target: stage}
      heard:
        - {guard: "event.data.result == 'dance'", target: stage, approve: operator}
        - {guard: "event.data.result == 'sing'", target: stage, approve: {by: operator, within: 5s, else: go}}
        - {guard: "event.data.result == 'rest'", target: stage, approve: {by: operator, within: 5s}}
  stage:
    do: {say: Here I am.}
    buttons: [{label: Back, event: back, key: b}, {label: Bow, event: bow}]
    on: {back: hall, bow: {target: hall, approve: operator}}
"""


@pytest.fixture(scope="module")
def mine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hosted]:
    root = tmp_path_factory.mktemp("mine")
    (root / "behaviors").mkdir()
    (root / "behaviors" / "mine.yaml").write_text(MINE)
    (root / "lumen.yaml").write_text(SETTINGS)
    one = Hosted(root)
    yield one
    one.close()


@pytest.fixture(scope="module")
def console(mine: Hosted) -> Iterator[str]:
    """The address of a console that requires PINs."""
    served = Served(mine.root, pins=PINS)
    yield served.console.address
    served.close()


@pytest.fixture
def hall(mine: Hosted, console: str, viewer: Viewer) -> Hosted:
    """The exhibition in its state `hall`, with its page, on which an author shows as an operator; nothing waits."""
    sign_in(viewer, console, Role.AUTHOR)

    def decided() -> bool:
        with suppress(WebDriverException, IndexError):  # it is decided meanwhile, or the page is drawn anew
            viewer.all(".approval .actions button:last-child")[0].click()
        return not (mine.exhibition.loop.runtime.approvals.waiting or viewer.all(".approval"))

    def back() -> bool:
        if viewer.text(".leaf .state-name") == "stage":
            viewer.type("b")  # the page ignores it while it is away
        return "hall" in viewer.text(".leaf")

    until(decided, HANG)
    until(back, HANG)
    return mine


FLAT = """
for (const canvas of [HTMLCanvasElement, OffscreenCanvas]) {
  const before = canvas.prototype.getContext;
  canvas.prototype.getContext = function (kind, ...more) {
    return /webgl/.test(kind) ? null : before.call(this, kind, ...more);
  };
}
"""
"""A browser that draws nothing in three dimensions."""


def sign_in(viewer: Viewer, address: str, role: Role, **kept: str) -> None:
    viewer.open(address, "robot/NAO", ready=".notice .strong", **kept)
    viewer.click(".notice .strong")
    enter(viewer, PINS[role])
    until(lambda: viewer.all(".leaf"), HANG)


def enter(viewer: Viewer, pin: str) -> None:
    until(lambda: viewer.run("return Boolean(document.activeElement?.closest('#pin'))"), HANG)
    viewer.type(pin, "\t", "Aisyah", "\n")


def says(mine: Hosted, words: str) -> None:
    mine.send("heard", {"result": words, "language": "en"})


def says_until_seen(viewer: Viewer, mine: Hosted, words: str, text: str) -> None:
    """Send these words again and again until the page shows this text beside a transition that waits."""
    approvals = mine.exhibition.loop.runtime.approvals

    def seen() -> bool:
        if mine.exhibition.configuration == {"stage"}:
            viewer.type("b")  # the page ignores it until it shows this state
        elif not approvals.waiting:
            says(mine, words)
        return text in viewer.text(".countdown")

    until(seen, HANG)


def counts(mine: Hosted, number: int) -> None:
    until(lambda: mine.exhibition.context["n"] == number, HANG)


@pytest.mark.parametrize("role", PINS, ids=lambda role: role.word)
def test_who_signs_in_sees_what_the_role_may_use(viewer: Viewer, console: str, role: Role) -> None:
    sign_in(viewer, console, role, mode="author")
    until(lambda: viewer.all(".declared"), HANG)
    assert {name for name, selector in SEEN.items() if viewer.all(selector)} == MAY[role]
    viewer.click(".settings > button")
    viewer.click("#settings > button:last-child")
    viewer.shows("Sign in to use this console", "main")
    assert not viewer.all(", ".join(SEEN.values()))
    assert viewer.all("rest-button[main] .rest")


def test_operators_see_that_files_are_refused_and_neither_findings_nor_paths(
    viewer: Viewer, mine: Hosted, console: str
) -> None:
    sign_in(viewer, console, Role.OPERATOR)
    behavior = mine.root / "behaviors" / "mine.yaml"
    try:
        save(behavior, MINE.replace("target: stage", "target: stagge"))
        viewer.driver.get(console + "robot/NAO/files")
        viewer.shows("refused", ".saved")
        viewer.shows("is shown to authors", ".saved")
        assert [sign for sign in (".yaml", "stagge") if sign in viewer.text("main")] == []
    finally:
        save(behavior, MINE)


@pytest.mark.once
def test_a_wrong_pin_is_told_and_lets_nobody_in(viewer: Viewer, console: str) -> None:
    viewer.open(console, "robot/NAO", ready=".notice .strong")
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    viewer.click(".notice .strong")
    enter(viewer, "wrong-0000")
    until(lambda: viewer.text("#pin-wrong"), HANG)
    assert viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))") == []
    assert not viewer.all(".leaf")
    viewer.click("rest-button[main] .rest")
    viewer.shows("Rests", ".rest-said")


def test_a_button_is_pressed_held_or_asked_about_with_the_mouse_and_by_its_key(viewer: Viewer, hall: Hosted) -> None:
    before = hall.exhibition.context["n"]
    quick, held, asked, never = (f".declared-list li:nth-child({n}) .declared" for n in range(1, 5))
    viewer.press("q", quick)
    counts(hall, before + 1)
    viewer.click(quick)
    counts(hall, before + 2)
    viewer.click(held)
    viewer.press("h", held)
    viewer.click(asked)
    viewer.shows("Asked: really?", "dialog")
    assert hall.exhibition.context["n"] == before + 2
    viewer.click("dialog .strong")
    counts(hall, before + 102)
    until(lambda: not viewer.all("dialog"), HANG)
    viewer.press("h", held, holding=lambda: counts(hall, before + 112))
    assert viewer.all(never)[0].get_attribute("aria-disabled") == "true"
    assert "context.n < 0" in str(viewer.all(never)[0].get_attribute("aria-description"))
    told = "return [...document.querySelectorAll('.entry-text')].map((one) => one.textContent).join()"
    until(lambda: "by Aisyah" in viewer.run(told))


def test_what_waits_for_go_is_asked_about_and_goes_or_stays(viewer: Viewer, hall: Hosted) -> None:
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    says(hall, "dance")
    viewer.shows("Waits for your GO", ".approvals")
    viewer.shows("hall → stage", ".approvals")
    viewer.shows("“dance”", ".approval .visitor-said")
    viewer.shows("says “Here I am.”", ".approval .would")
    viewer.shows("The robot waits until a person decides.", ".approval .countdown")
    viewer.shows("dance", ".talk .visitor-said")
    assert viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))") == []
    assert viewer.text(".leaf .state-name") == "hall"
    viewer.click(".approval .actions button:last-child")
    until(lambda: not viewer.all(".approval"), HANG)
    assert hall.exhibition.configuration == {"hall"}
    says(hall, "dance")
    viewer.click(".approval .go")
    viewer.shows("stage", ".leaf")
    until(lambda: not viewer.all(".approval"), HANG)


def test_a_button_that_waits_for_go_is_not_told_as_a_failure(viewer: Viewer, hall: Hosted) -> None:
    says(hall, "dance")
    viewer.click(".approval .go")
    viewer.shows("stage", ".leaf")
    viewer.click(".declared-list li:nth-child(2) .declared")
    viewer.tells("Bow: waits for a GO")
    viewer.shows("Waits for your GO", ".approvals")
    viewer.click(".approval .go")
    viewer.shows("hall", ".leaf")


OPENED = pytest.mark.parametrize(
    ("press", "opened"), [(".declared-list li:nth-child(3) .declared", "dialog"), (".settings > button", "#settings")]
)
ESCAPE_AT_ONCE = """
const [press, opened, done] = arguments;
const watch = new MutationObserver(() => {
  if (!document.querySelector(opened)?.checkVisibility()) return;
  watch.disconnect();
  dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
  done();
});
watch.observe(document, { subtree: true, childList: true, attributes: true });
document.querySelector(press).click();
"""


@OPENED
def test_escape_closes_what_has_just_opened(viewer: Viewer, hall: Hosted, press: str, opened: str) -> None:
    viewer.until(lambda: viewer.all(press))
    viewer.driver.execute_async_script(ESCAPE_AT_ONCE, press, opened)
    viewer.until(lambda: not viewer.text(opened))


@OPENED
def test_escape_that_closes_something_is_no_half_of_rest(viewer: Viewer, hall: Hosted, press: str, opened: str) -> None:
    viewer.click(press)
    until(lambda: viewer.text(opened), HANG)
    presses = viewer.run(PRESSES)
    viewer.type(Keys.ESCAPE, Keys.ESCAPE)
    until(lambda: not viewer.text(opened), HANG)
    assert viewer.run(PRESSES) == presses
    viewer.escape_twice()
    viewer.shows("Rests", ".rest-said")
    viewer.click(".resume")
    viewer.click("dialog .strong")
    until(lambda: not viewer.all(".stopped"), HANG)


def test_a_text_that_was_not_sent_is_still_there_to_send(viewer: Viewer, hall: Hosted) -> None:
    viewer.click(".say input")
    viewer.type("Welcome")
    viewer.run("globalThis.post = lumen.post; lumen.post = async (fields, tell) => tell('unsent', {});")
    viewer.type("\n")
    viewer.shows("NOT SENT", ".told")
    assert viewer.run("return document.querySelector('.say input').value") == "Welcome"
    viewer.run("lumen.post = post")
    viewer.click(".say button")
    until(lambda: viewer.run("return document.querySelector('.say input').value") == "", HANG)


def test_a_time_that_runs_out_decides_and_is_seen_coming(viewer: Viewer, hall: Hosted) -> None:
    says_until_seen(viewer, hall, "rest", "Without a GO, expires in")
    until(lambda: not viewer.all(".approval"), HANG)
    assert hall.exhibition.configuration == {"hall"}
    says_until_seen(viewer, hall, "sing", "Continues by itself in")
    viewer.shows("stage", ".leaf")
    until(lambda: viewer.run(CHOOSE, "says “Here I am.”"), HANG)
    viewer.shows("says “Here I am.”", ".chain .link:first-child")
    viewer.shows("heard", ".chain")


def test_who_lets_it_go_alone_is_asked_no_more(viewer: Viewer, hall: Hosted) -> None:
    viewer.click(".choice label:last-child")
    until(lambda: viewer.all(".choice input[value=alone]:checked"), HANG)
    viewer.tells("go alone: done")
    says(hall, "dance")
    viewer.shows("stage", ".leaf")
    viewer.click(".choice label:nth-of-type(1)")
    viewer.tells("ask me: done")


def test_refused_files_are_not_said_to_be_the_ones_that_run(viewer: Viewer, hall: Hosted, console: str) -> None:
    """The changes are listed if they are known, as those with a story that fails."""
    story, behavior = hall.root / "behaviors" / "stories" / "fails.yaml", hall.root / "behaviors" / "mine.yaml"
    viewer.driver.get(console + "robot/NAO/files")
    viewer.shows("The saved files are the ones that run.", ".changes")
    try:
        story.parent.mkdir()
        save(story, "title: Fails\nsteps: [{wait: 1s}, {expect: {state: stage}}]\n")
        viewer.shows("story `fails` added", ".changes")
        viewer.shows("refused", ".saved")
        story.unlink()
        save(behavior, MINE.replace("target: stage", "target: stagge"))
        viewer.shows("Not known: the saved files were not compared with those that run.", ".changes")
    finally:
        story.unlink(missing_ok=True)
        save(behavior, MINE)
    viewer.shows("The saved files are the ones that run.", ".changes")


@pytest.mark.parametrize("page", ["", "/day", "/files", "/see"])
def test_every_button_of_a_page_is_reached_by_the_keyboard(
    viewer: Viewer, hall: Hosted, console: str, page: str
) -> None:
    says(hall, "dance")
    viewer.shows("Waits for your GO", ".approvals")
    if page:
        viewer.driver.get(f"{console}robot/NAO{page}")
        until(lambda: viewer.all("main h1"), HANG)
    seen = "[...document.querySelectorAll('button, select, input, a[href]')].filter((one) => one.checkVisibility())"
    wanted = f"{seen}.filter((one) => !one.disabled && one.type !== 'radio')"
    viewer.run(f"document.body.focus(); window.missing = new Set({wanted})")
    assert viewer.run("return missing.size") > 5
    for _ in range(150):
        viewer.type("\t")
        viewer.run("missing.delete(document.activeElement)")
        viewer.run("missing.forEach((one) => one.isConnected || missing.delete(one))")
        if not (left := viewer.run("return [...missing].map((one) => one.outerHTML)")):
            break
    assert left == []


def test_radio_buttons_are_chosen_by_arrows_and_the_hall_without_webgl_gives_way_to_the_camera(
    console: str,
) -> None:
    flat = Viewer(first=FLAT)
    try:
        sign_in(flat, console, Role.OPERATOR)
        flat.driver.get(f"{console}robot/NAO/see")
        until(lambda: flat.all("input[name=view]:checked"), HANG)
        flat.run("document.querySelector('input[name=view]:checked').focus()")
        flat.type(Keys.ARROW_RIGHT)
        until(lambda: flat.all("input[name=view][value=hall]:checked"), HANG)
        flat.shows("cannot draw the 3-D view", "main .notice")
        until(lambda: flat.all(".part.camera img"), HANG)
        assert not flat.all("canvas")
    finally:
        flat.close()
