"""*Edit this sentence*: from a line on Day or Now to the text in its file, and a new wording that lint has checked."""

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver.common.keys import Keys

from lumen.errors import UsageError
from lumen.features.console.rewording import NewWording, reword
from lumen.features.console.written_sentences import SaidSentence, places
from lumen.lint import check_files
from lumen.project.files import read_files
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.features.console.test_conversation import SETTINGS, violations
from tests.features.console.test_page_types import faults_of_answers
from tests.features.console.viewer import Viewer
from tests.waiting import HANG, until

GUIDE = """\
initial: hall
context: {visitor: '', told: ''}
states:
  hall:   # a comment that stays
    on:
      heard:
        - {guard: "event.data.result == 'again'", target: told}
        - {guard: "event.data.result == 'why'", target: asked}
        - target: greeted
          actions: {assign: {visitor: event.data.result}}
  greeted:
    do:
      - say: {en: "Hello {{ context.visitor }}!", id: 'Halo {{ context.visitor }}!'}   # the greeting
      - say:
          en: [Come in., Please come in.]
          id: [Silakan masuk., Mari masuk.]
      - assign: {told: "lists.stops[0].text"}
    on: {done.do.*: hall, error.do.*: hall}
  told:
    do: {say: "{{ context.told }}"}
    on: {done.do.*: hall, error.do.*: hall}
  asked:
    do: {ask: {question: event.data.result, within: 1h, else: {say: {en: I do not know., id: Saya tidak tahu.}}}}
    on: {done.do.*: hall, error.do.*: hall}
lists:
  stops:
    - text:
        en: >-
          This tower was built in the year 1900 by people who liked the view from above, and it has been
          open to visitors ever since.
        id: Menara ini dibangun tahun 1900.
"""
PASSAGE = """\
questions: {en: [why], id: [mengapa]}
answer:
  en: Because we like it.
  id: Karena kami suka.
"""
TOWER = "This tower was built in the year 1900 by people who liked the view from above, and it has been open to"


def guide(root: Path) -> Path:
    """Write a project whose robot says texts with placeholders, from a list and from a passage."""
    (root / "behaviors").mkdir()
    (root / "knowledge").mkdir()
    (root / "behaviors" / "asked.yaml").write_text(GUIDE)
    (root / "knowledge" / "why.yaml").write_text(PASSAGE)
    (root / "lumen.yaml").write_text(SETTINGS.replace("Asked", "Edited"))
    return root


def place(root: Path, text: str, **more: Any) -> dict[str, Any]:
    """The only place of a sentence."""
    [found] = places(root, "", SaidSentence(text, **more))
    return found


def wording(found: dict[str, Any], **texts: str) -> NewWording:
    return NewWording.read({**found, "texts": {**found["texts"], **texts}})


def test_sentences_are_found_with_what_was_filled_in(tmp_path: Path) -> None:
    root = guide(tmp_path)
    hello = place(root, "Hello Budi from the hall!", language="en")
    assert (hello["file"], hello["line"]) == ("behaviors/asked.yaml", 13)
    assert hello["texts"] == {"en": "Hello {{ context.visitor }}!", "id": "Halo {{ context.visitor }}!"}
    assert place(root, "Please come in.")["texts"] == {"en": "Please come in.", "id": "Mari masuk."}
    assert place(root, f"{TOWER} visitors ever since.")["line"] == 28
    assert place(root, "Karena kami suka.", language="id")["file"] == "knowledge/why.yaml"
    assert place(root, "Karena kami suka.", language="en")["file"] == "knowledge/why.yaml", "it is in no English text"
    assert places(root, "", SaidSentence("Nobody wrote this.")) == []


def test_of_equal_texts_the_one_that_was_said_counts(tmp_path: Path) -> None:
    root = guide(tmp_path)
    file = root / "behaviors" / "asked.yaml"
    file.write_text(file.read_text("utf-8").replace('{say: "{{ context.told }}"}', "{say: {en: Come in., id: Masuk.}}"))
    assert [one["line"] for one in places(root, "", SaidSentence("Come in."))] == [15, 20]
    said = SaidSentence("Come in.", file="behaviors/asked.yaml", line=20)
    assert [one["line"] for one in places(root, "", said)] == [20]


def test_a_new_wording_changes_nothing_else(tmp_path: Path) -> None:
    root = guide(tmp_path)
    file = root / "behaviors" / "asked.yaml"
    hello = place(root, "Hello Budi!")
    checked = reword(root, "", wording(hello, en="Welcome, {{ context.visitor }}!"), write=False)
    assert (checked["written"], checked["findings"]) == (False, [])
    assert file.read_text("utf-8") == GUIDE
    saved = reword(root, "", wording(hello, en="Welcome, {{ context.visitor }}!"), write=True)
    assert saved["written"]
    assert file.read_text("utf-8") == GUIDE.replace('"Hello {{', '"Welcome, {{')
    for said, new in (("Please come in.", "Come in, please."), ("Come in.", "Step in.")):
        assert reword(root, "", wording(place(root, said), en=new), write=True)["written"]
    assert 'en: [Step in., "Come in, please."]' in file.read_text("utf-8")
    tower = place(root, f"{TOWER} visitors ever since.")
    assert reword(root, "", wording(tower, en=f"{TOWER} visitors and their dogs."), write=True)["written"]
    text = file.read_text("utf-8")
    assert "        en: >-\n          This tower" in text
    assert "dogs.\n        id: Menara ini" in text
    assert [str(one) for one in check_files(root, read_files(root))[1]] == []


def test_letters_that_invisible_characters_keep_apart_stay_apart(tmp_path: Path) -> None:
    root = guide(tmp_path)
    persian = "\u0645\u06cc\u200c\u0631\u0648\u0645"  # "I go": its third character is invisible
    said = wording(place(root, "Please come in."), en=f" {persian}\t{persian}\n")
    assert reword(root, "", said, write=True)["written"]
    assert place(root, f"{persian} {persian}")["texts"]["en"] == f"{persian} {persian}"


def test_a_faulty_wording_is_not_written(tmp_path: Path) -> None:
    root = guide(tmp_path)
    hello = place(root, "Hello Budi!")
    faulty = reword(root, "", wording(hello, en="Hello {{ context.visiter }}!"), write=True)
    assert (faulty["written"], faulty["faulty"]) == (False, True)
    [finding] = faulty["findings"]
    assert (finding["line"], finding["severity"]) == (13, "error")
    assert "visiter" in finding["message"]
    for wrong in (wording(hello, en=" "), wording(hello, fr="Bonjour"), wording(hello)._replace(version="0")):
        with pytest.raises(UsageError):
            reword(root, "", wrong, write=True)
    with pytest.raises(UsageError, match="has no such sentence"):
        reword(root, "", wording(hello)._replace(around=("states",)), write=True)
    assert (root / "behaviors" / "asked.yaml").read_text("utf-8") == GUIDE


@pytest.fixture(scope="module")
def edited(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hosted]:
    with closing(Hosted(guide(tmp_path_factory.mktemp("edited")))) as hosted:
        yield hosted


@pytest.fixture(scope="module")
def console(edited: Hosted) -> Iterator[Browser]:
    """A console of it, after a visitor and an operator have spoken."""
    with closing(Served(edited.root)) as served:
        browser = served.browser
        until(lambda: any(robot["connected"] for robot in browser.robots), HANG)
        for text, told in (("Budi", "Hello Budi!"), ("again", "This tower"), ("why", "Because we")):
            edited.send("heard", {"result": text, "language": "en"})
            until(lambda told=told: told in str(entries(browser)), HANG)  # type: ignore[misc]
            until(lambda: "hall" in edited.exhibition.configuration, HANG)
        browser.command("say", text="The toilets are on the left.", language="en")
        until(lambda: "toilets" in str(entries(browser)), HANG)
        yield browser


def entries(browser: Browser) -> list[dict[str, Any]]:
    position = browser.robots[0]["position"] or 0
    return list(browser.get(f"/api/entries?from=0&to={position}").data["entries"])


def where(browser: Browser, text: str) -> dict[str, Any]:
    """Return what the console answers about a sentence that was said."""
    entry = next(one for one in entries(browser) if text in one["text"])
    said = [one["Start"] for one in entry.get("commands", []) if "Say" in one.get("Start", {}).get("command", {})]
    id = next((one["id"] for one in said if text in one["command"]["Say"]["text"]), "")
    return dict(browser.get(f"/api/sentence?position={entry['position']}&id={id}").data)


def test_each_sentence_that_was_said_has_its_place(console: Browser) -> None:
    said = {text: where(console, text) for text in ("Hello Budi!", "This tower", "Because we", "The toilets")}
    found = {text: [(one["file"], one["line"]) for one in told["places"]] for text, told in said.items()}
    assert found == {
        "Hello Budi!": [("behaviors/asked.yaml", 13)],
        "This tower": [("behaviors/asked.yaml", 28)],
        "Because we": [("knowledge/why.yaml", 3)],
        "The toilets": [],
    }
    assert [told["source"] for told in said.values()] == ["file", "file", "file", "operator"]
    assert console.get("/api/sentence?position=0").status == 404
    assert console.get("/api/sentence?position=x").status == 400
    for wrong in (
        {"write": True},
        {"write": 1},
        {"write": True, "file": "../a", "around": [], "version": "", "texts": {}},
    ):
        refused = console.post("/api/sentence", wrong)
        assert (refused.status, list(refused.data)) == (400, ["reason"])


def test_the_types_of_the_pages_describe_the_answers(console: Browser, tmp_path: Path) -> None:
    found = where(console, "Hello Budi!")
    [at] = found["places"]
    texts = {**at["texts"], "en": "Welcome {{ context.visiter }}!"}
    checked = console.post("/api/sentence", {**at, "texts": texts, "write": False}).data
    assert checked["findings"]
    assert checked["changes"]
    assert faults_of_answers({"FoundSentence": found, "Reworded": checked}, tmp_path) == []


@pytest.mark.slow
@pytest.mark.xdist_group("operating")
def test_an_author_edits_a_sentence_from_the_day(viewer: Viewer, edited: Hosted, console: Browser) -> None:
    file, address = edited.root / "behaviors" / "asked.yaml", f"http://{console.host}:{console.port}/"
    viewer.open(address, "robot/NAO/day", ready=".day .entry", mode="operator")
    choose(viewer, "Hello Budi!")
    assert not viewer.all(".edit-sentence")
    viewer.open(address, "robot/NAO/day", ready=".day .entry", mode="author", language="id")
    choose(viewer, "Hello Budi!")
    viewer.click(".chosen .edit-sentence")
    viewer.shows("behaviors/asked.yaml:13", "dialog")
    until(lambda: viewer.run("return document.activeElement.matches('dialog textarea')"), HANG)
    assert violations(viewer) == []
    assert viewer.run(FIELDS) == ["Hello {{ context.visitor }}!", "Halo {{ context.visitor }}!"]
    write(viewer, 0, "Welcome {{ context.visiter }}!")
    viewer.click("dialog .sentence .strong")
    viewer.shows("visiter", "dialog .check")
    assert viewer.run("return document.querySelector('dialog .sentence .strong').disabled")
    write(viewer, 0, "Welcome {{ context.visitor }}!")
    viewer.click("dialog .sentence .strong")
    viewer.shows("Tidak ada temuan", "dialog .check")
    assert "Hello {{ context.visitor }}!" in viewer.text("dialog .check del")
    assert file.read_text("utf-8") == GUIDE  # only checked so far
    viewer.click("dialog .sentence .strong")
    viewer.shows("disimpan sebagai behaviors/asked.yaml:13", "dialog")
    assert "Welcome {{" in file.read_text("utf-8")
    viewer.click("dialog .undo")
    viewer.shows("Teks lama disimpan lagi.", "dialog")
    assert file.read_text("utf-8") == GUIDE
    viewer.type(Keys.ESCAPE)
    choose(viewer, "The toilets")
    viewer.click(".chosen .edit-sentence")
    viewer.shows("diketik operator: tidak ada di berkas mana pun", "dialog")


@pytest.mark.slow
@pytest.mark.xdist_group("operating")
def test_an_author_edits_a_passage_from_the_conversation(viewer: Viewer, edited: Hosted, console: Browser) -> None:
    file, address = edited.root / "knowledge" / "why.yaml", f"http://{console.host}:{console.port}/"
    viewer.open(address, "robot/NAO", ready=".talk-lines li", mode="operator")
    assert not viewer.all(".edit-sentence")
    viewer.open(address, "robot/NAO", ready=".talk-lines .edit-sentence", mode="author")
    viewer.shows("The toilets are on the left.", ".talk-lines")
    viewer.click(".edit-sentence[aria-label*='Because we like it']")
    viewer.shows("This answer is written in the passage knowledge/why.yaml:3", "dialog")
    write(viewer, 0, "Because visitors like it.")
    viewer.click("dialog .sentence .strong")
    viewer.shows("+ Because visitors like it.", "dialog .check")
    viewer.click("dialog .sentence .strong")
    viewer.shows("saved as knowledge/why.yaml:3", "dialog")
    assert file.read_text("utf-8") == PASSAGE.replace("we like it", "visitors like it")
    file.write_text(PASSAGE, "utf-8")  # other tests of this file read it


FIELDS = "return [...document.querySelectorAll('dialog textarea')].map((field) => field.value)"


def choose(viewer: Viewer, text: str) -> None:
    """Search the day for words, and open the entry that has them."""
    viewer.run("document.querySelector('.search input').select()")
    viewer.type(text, Keys.ENTER)
    viewer.shows(text, ".found .entry")
    viewer.click(".found .entry button")
    viewer.shows(text, ".chosen")


def write(viewer: Viewer, field: int, text: str) -> None:
    """Replace the text of one of the dialog's fields."""
    until(lambda: len(viewer.all("dialog textarea")) > field, HANG)
    viewer.run("const field = document.querySelectorAll('dialog textarea')[arguments[0]]; field.select()", field)
    viewer.type(text)
