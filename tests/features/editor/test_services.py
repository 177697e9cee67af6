"""The language services at a position: files and positions in, values out, without an editor."""

import asyncio
from contextlib import nullcontext, suppress
from functools import partial
from random import Random
from unittest.mock import AsyncMock, Mock, patch

import pytest
from pygls.exceptions import JsonRpcContentModified

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis, Judgement
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions, uses
from lumen.features.editor.hover import hover
from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.locating import NameInText, in_expression
from lumen.features.editor.names import NameKind
from lumen.features.editor.renaming import applied, refuse_harm, renamable, rename
from lumen.features.editor.requests import changes
from lumen.features.editor.symbols import symbols
from lumen.project.files import read_files
from tests import ROOT
from tests.mutation.mutants import Nursery
from tests.tables import for_each

FAQ = "behaviors/words/faq.yaml"
VISITORS = "behaviors/words/visitors.yaml"
HOST = "behaviors/host.yaml"
TOUR, VISITOR = "behaviors/tour.yaml", "behaviors/stories/visitor.yaml"
GUARDS = """\
  heard:
    - {guard: "heard(event.data.result, 'dance')", actions: {log: dance}}
    - {guard: "lookup(event.data.result, 'faq') != null", actions: {log: faq}}
"""
FILES = read_files(ROOT)
SHIPPED = Analysis(ROOT, {**FILES, TOUR: FILES[TOUR].replace(b"\non:\n", f"\non:\n{GUARDS}".encode())})
"""The shipped project, with guards in its tour that ask what was heard."""


def place(analysis: Analysis, file: str, text: str, offset: int | None = None) -> tuple[str, int, int]:
    """Return the place of the `|` in a piece of the file's text, the first one or that at an offset."""
    whole = analysis.text(file)
    at = whole.index(text.replace("|", "", 1)) if offset is None else offset
    at += text.index("|")
    return file, whole.count("\n", 0, at) + 1, at - whole.rfind("\n", 0, at)


def written(file: str, old: str, new: str) -> tuple[Analysis, tuple[str, int, int]]:
    """Return the shipped project with `new` in place of `old`, and the place of the `|` in it."""
    text = SHIPPED.text(file)
    analysis = SHIPPED.changed(file, text.replace(old, new.replace("|", "", 1), 1))
    return analysis, place(analysis, file, new, text.index(old))


@for_each(
    ("file", "old", "new", "some", "none"),
    [
        (TOUR, "target: how_are_you", "target: |", ["ask_name", '"#goodbye"'], ["Stand", "greet", ".ask_name"]),
        (TOUR, "onDone: watching", "onDone: #|", ['"#goodbye"', '"#idle"'], []),
        (TOUR, "onDone: watching", 'onDone: "#|"', ["#goodbye"], ['"#goodbye"']),
        (TOUR, "  guide:\n", "  guide:\n    initial: |\n", ["idle", "paused"], ["greet"]),
        (TOUR, "{posture: Stand}", "{posture: S|", ["Stand", "Sit"], ["dance", "Crouch"]),
        (TOUR, "{posture: Stand}", "{play: |}", ["dance", "sing"], ["Stand"]),
        (TOUR, "{posture: Stand}", "{publish: {route: |", ["command", "journal"], ["tour"]),
        (TOUR, "{posture: Stand}", "{publish: {route: command, body: {|", ["method: ", "parameter: "], ["x: "]),
        (TOUR, "{posture: Stand}", "{leds: {|}}", ["eyes: ", "left_foot: ", "duration: "], ["leds: "]),
        (TOUR, "{posture: Stand}", "{leds: {eyes: |}}", ["turquoise", "rebeccapurple", "off"], ["Stand"]),
        (TOUR, "{posture: Stand}", "{language: |}", ["en", "id"], ["any"]),
        (TOUR, "{posture: Stand}", "{say: {|}}", ["en: ", "any: "], ["say: "]),
        (TOUR, "{posture: Stand}", "{assign: {|", ["visitor: ", "reply: "], ["english: "]),
        (TOUR, ": interrupted\n", ": interrupted\n          |\n", ["heard: ", "fallen: "], ["on: "]),
        (TOUR, "context.name_tries < 2", "context.|", ["visitor", "battery"], ["name"]),
        (TOUR, "event.data.gender == 'male'\"", "event.data.|", ["gender"], ["result", "visitor"]),
        (TOUR, "heard(event.data.result, 'dance')\"", "heard(event.data.result, '|", ["dance", "photo"], ["faq"]),
        (TOUR, "lookup(event.data.result, 'faq')", "lookup(event.data.result, '|", ["faq", "explanations"], ["dance"]),
        (TOUR, "words: [common, visitors, faq]", "words: [|", ["faq", "visitors"], ["tour"]),
        (FAQ, "answers:\n", "|\nanswers:\n", ["phrases: "], ["states: "]),
        (FAQ, "- phrases:", "- |", ["phrases: "], ["say: "]),
        (TOUR, "How are you, {{ context.visitor }}?", "How are you, {{ context.|", ["title_en"], ["heard("]),
        (TOUR, "        onDone: watching\n", "        onDone: watching\n        |\n", ["always: "], ["onDone: "]),
        (VISITOR, "expect: {state: greet", "expect: {state: |", ["greet", "offer"], ["#greet"]),
        (VISITOR, "  - wait: 2s", "  - |", ["says: ", "expect: "], ["say: "]),
        (VISITOR, "  - wait: 2s", "  - touch: |", ["ChestButton"], ["Stand"]),
        (VISITOR, "  - wait: 2s", "  - message: {route: face, body: {|", ["x: ", "time: "], ["method: "]),
        ("lumen.yaml", "schema: image", "schema: |", ["image", "joint"], ["Stand"]),
        ("lumen.yaml", "hall: hall.xml", "h|", ["hall: "], ["story: "]),
        ("motions/goodbye.yaml", "pose: hand_out", "pose: |", ["hand_in", "lean"], ["Stand"]),
        ("motions/goodbye.yaml", "joints: {LShoulderPitch: 78", "joints: {L|", ["LElbowYaw: "], ["lean"]),
        ("fuzzy/head.yaml", "FaceXLoc: face.x", "FaceXLoc: face.|", ["x", "y"], ["face"]),
        ("fuzzy/head.yaml", "joint: head.yaw", "joint: |", ["HeadPitch"], ["face"]),
        ("fuzzy/head.yaml", "implication: minimum", "implication: |", ["algebraic-product"], ["HeadYaw"]),
    ],
)
def test_completion(file: str, old: str, new: str, some: list[str], none: list[str]) -> None:
    """A file that is not YAML while it is being written is completed, too."""
    analysis, here = written(file, old, new)
    proposed = [item.text for item in complete(analysis, *here)]
    assert set(some) <= set(proposed), proposed
    assert not set(none) & set(proposed), proposed


@for_each(
    ("file", "text", "where"),
    [
        (TOUR, "target: how_are|_you", f"{TOUR}: how_are_you:"),
        (TOUR, "safety.alarm: pau|sed", f"{TOUR}: paused:"),
        (VISITOR, "{state: gr|eet", f"{TOUR}: greet:"),
        (VISITOR, "played: dan|ce", "motions/dance.yaml"),
        (TOUR, "context.name_|tries <", f"{TOUR}: name_tries:"),
        (TOUR, '  pho|to: "#photo"', f"{VISITORS}: photo:"),
        (TOUR, "heard(event.data.result, 'dan|ce')", f"{VISITORS}: dance:"),
        (TOUR, "lookup(event.data.result, 'f|aq')", f"{FAQ}: faq:"),
        (TOUR, "words: [common, visitors, f|aq", FAQ),
        ("motions/goodbye.yaml", "pose: hand_|out", "motions/goodbye.yaml: hand_out:"),
        ("lumen.yaml", "schema: ima|ge", "schemas/messages/image.schema.json"),
        ("fuzzy/head.yaml", "FaceXLoc: fa|ce.x", "lumen.yaml: face:"),
        ("models/nao.yaml", "    on: Head|Yaw", "models/nao.yaml: HeadYaw:"),
        ("models/pepper.yaml", "{Head|Yaw: ", "models/pepper.yaml: HeadYaw:"),
    ],
)
def test_definition(file: str, text: str, where: str) -> None:
    found = definitions(SHIPPED, *place(SHIPPED, file, text))
    assert len(found) == 1
    name, _, key = where.partition(": ")
    assert found[0].file == name
    assert SHIPPED.text(name).split("\n")[found[0].line - 1][found[0].column - 1 :].startswith(key)


@for_each(
    ("file", "text", "said"),
    [
        (TOUR, "target: how_are|_you", "atomic state at `guide.talking.waiting.how_are_you`"),
        (VISITOR, "played: dan|ce", "s, moves 2"),
        ("motions/goodbye.yaml", "RShoulder|Pitch", "-119.5 to 119.5 deg"),
        (TOUR, "context.name_|tries <", "begins with `0`"),
        (TOUR, "le|ds: {eyes: turquoise", "Give lights their colours"),
        (TOUR, "leds: {ey|es: turquoise", "a name of CSS"),
        (TOUR, "    on|Done: watching", "Taken when `do` has finished"),
        (TOUR, "engl|ish|indonesian", "“inggris”"),
        (TOUR, "heard(event.data.result, 'dan|ce')", "menari"),
        ("lumen.yaml", "  fa|ce: {key", "becomes the event `face`"),
        ("lumen.yaml", "schema: ima|ge", "message schema"),
    ],
)
def test_hover(file: str, text: str, said: str) -> None:
    assert said in hover(SHIPPED, *place(SHIPPED, file, text))


def first(behavior: str, rows: str = "") -> tuple[Analysis, tuple[str, int, int]]:
    """Return a project without routes but for these rows, and the place of the `|` in its behaviour."""
    main = f"behavior: host\nlanguages: [en]\nrobot: {{model: nao}}\nhall: hall.xml\n{rows}"
    texts = {"lumen.yaml": main, HOST: behavior.replace("|", "", 1)}
    analysis = Analysis(ROOT, {file: text.encode() for file, text in texts.items()})
    return analysis, place(analysis, HOST, behavior)


@for_each(
    ("behavior", "rows", "some", "none"),
    [
        ("states: {idle: {on: {f|", "", ["face: ", "fallen: "], ["idle: "]),
        ("states: {idle: {on: {|", "routes:\n  face: null\n", ["heard: "], ["face: "]),
        ("states: {idle: {entry: {publish: {route: |", "", ["text_stream", "social_expression"], ["ask"]),
        ("states: {idle: {entry: {publish: {route: |", "routes:\n  fact: null\n", ["text_stream"], ["fact"]),
        ("states: {idle: {entry: {publish: {route: text_stream, body: {|", "", ["text: "], ["x: "]),
        ("states: {idle: {on: {face: {guard: event.data.|", "", ["x", "y"], ["result"]),
    ],
)
def test_a_route_that_comes_with_lumen_is_proposed(behavior: str, rows: str, some: list[str], none: list[str]) -> None:
    analysis, here = first(behavior, rows)
    found = [item.text for item in complete(analysis, *here)]
    assert set(some) <= set(found)
    assert not set(none) & set(found)
    assert len(found) == len(set(found))


def test_hover_over_a_route_that_comes_with_lumen() -> None:
    analysis, here = first("states: {idle: {on: {face: {actions: {publish: {route: text_st|ream}}}}}}\n")
    assert "`lumen.{robot}.audio.text.stream` (out), comes with Lumen" in hover(analysis, *here)
    analysis, here = first("states: {idle: {on: {fa|ce: idle}}}\n")
    assert "from the route `face` (`lumen.{robot}.visual.face.detection`)" in hover(analysis, *here)
    assert renamable(analysis, *here) is None


def test_hover_over_a_finding_shows_its_rule() -> None:
    analysis, here = written(TOUR, "onDone: watching", "onDone: watch|in")
    assert "unknown-state" in hover(analysis, *here)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "text", "name", "edits", "moved"),
    [
        (TOUR, "target: how_are|_you", "mood", 46, None),
        (TOUR, "whenever: In('fall|en')", "lying", 9, None),
        (TOUR, "context.name_|tries <", "tries", 18, None),
        (TOUR, "heard(event.data.result, 'dan|ce')", "tarian", 7, None),
        (TOUR, "lookup(event.data.result, 'f|aq')", "queries", 7, None),
        (TOUR, "words: [common, visitors, f|aq", "said", 1, (FAQ, "behaviors/words/said.yaml")),
        (VISITOR, "played: dan|ce", "horse", 4, ("motions/dance.yaml", "motions/horse.yaml")),
        ("lumen.yaml", "  jour|nal: {key", "diary", 1, None),
        ("motions/goodbye.yaml", "pose: hand_|out", "out", 3, None),
    ],
)
def test_rename(file: str, text: str, name: str, edits: int, moved: tuple[str, str] | None) -> None:
    word = renamable(SHIPPED, *place(SHIPPED, file, text))
    assert word
    found = rename(SHIPPED, word, name)
    assert (len(found.edits), found.moved) == (edits, moved)
    after = applied(SHIPPED, found)
    assert not after.diagnostics
    assert name in after.index.names(word.kind, word.scope) or word.kind is NameKind.STATE


def test_the_key_in_a_way_that_assign_goes() -> None:
    """Its definition is the context's, and a rename leaves the rest of the path as it is."""
    analysis, here = written(TOUR, "{posture: Stand}", "{assign: {visi|tor.name: 1}}")
    (found,) = definitions(analysis, *here)
    assert analysis.text(TOUR).split("\n")[found.line - 1][found.column - 1 :].startswith("visitor:")
    word = renamable(analysis, *here)
    assert word
    assert "{assign: {guest.name: 1}}" in applied(analysis, rename(analysis, word, "guest")).text(TOUR)


@for_each(
    "text",
    [
        r'"context.visitor != \"\" && size(context.visi|tor) < 9"',
        "'context.visitor != '''' && size(context.visi|tor) < 9'",
        "context.visitor != '' &&\n            size(context.visi|tor) < 9",
        "\"context.visitor != '' && \\\n            size(context.visi|tor) < 9\"",
    ],
)
def test_a_name_is_renamed_in_a_text_that_is_folded_or_escaped(text: str) -> None:
    analysis, here = written(TOUR, "{posture: Stand}", f"{{if: {text}, then: [{{posture: Stand}}]}}")
    word = renamable(analysis, *here)
    assert word
    assert word.text == "visitor"
    after = applied(analysis, rename(analysis, word, "guest")).text(TOUR)
    assert text.replace("|", "").replace("visitor", "guest") in after


@for_each(
    ("file", "text", "name", "reason"),
    [
        (TOUR, "target: how_are|_you", "greet", "already"),
        (TOUR, "target: how_are|_you", "two words", "without spaces"),
        (TOUR, "context.name_|tries <", "visitor", "already"),
        (TOUR, "lookup(event.data.result, 'f|aq')", "explanations", "already"),
        (TOUR, "context.name_|tries <", "1st", "letters"),
        (TOUR, "context.name_|tries <", "null", "can't be"),
        ("lumen.yaml", "  fa|ce: {key", "gesicht", "has a fixed meaning in Lumen"),
        (VISITOR, "played: dan|ce", "sing", "already"),
    ],
)
def test_names_that_can_not_be_given(file: str, text: str, name: str, reason: str) -> None:
    word = renamable(SHIPPED, *place(SHIPPED, file, text))
    assert word
    with pytest.raises(UsageError, match=reason):
        rename(SHIPPED, word, name)


def test_the_key_that_says_how_long_is_renamed_with_what_it_reads() -> None:
    text = SHIPPED.text(TOUR).replace("after: {12s: ", 'after: {"{{ context.battery }}s": ')
    analysis = Analysis(SHIPPED.root, {**SHIPPED.files, TOUR: text.encode()})
    word = renamable(analysis, *place(analysis, TOUR, "{{ context.bat|tery }}s"))
    assert word
    after = applied(analysis, rename(analysis, word, "charge"))
    assert not after.diagnostics
    assert 'after: {"{{ context.charge }}s": ' in after.text(TOUR)


@pytest.mark.slow
def test_every_state_key_phrase_and_route_can_be_renamed() -> None:
    """After each renaming, in a random sample of the names, the project still has no findings."""
    uses = [w for w in SHIPPED.index.uses if w.defines and w.text and w.place.file in (TOUR, VISITORS, "lumen.yaml")]
    chosen = Random(1).sample([w for w in uses if w.kind in (NameKind.STATE, NameKind.CONTEXT, NameKind.PHRASE)], 5)
    for word in chosen:
        assert not applied(SHIPPED, rename(SHIPPED, word, "renamed_thing")).diagnostics


def test_uses_and_symbols() -> None:
    assert len(uses(SHIPPED, *place(SHIPPED, VISITOR, "played: dan|ce"))) == 4
    tree = {symbol.name: symbol for symbol in symbols(SHIPPED, TOUR)}
    assert {"visitor", "battery", "guide", "safety"} <= tree.keys()
    assert {symbol.name for symbol in symbols(SHIPPED, FAQ)} == {"faq", "explanations"}
    assert {child.name for child in tree["guide"].children} == {"idle", "talking", "paused", "interrupted"}
    assert tree["guide"].whole.end_line > tree["guide"].place.line + 100


def test_words_stand_where_they_say() -> None:
    lines = {file: SHIPPED.text(file).split("\n") for file in SHIPPED.files}
    named = [word for word in SHIPPED.index.uses if word.text]
    assert len(named) > 1_500
    for word in named:
        assert lines[word.place.file][word.place.line - 1][word.place.column - 1 :].startswith(word.text)


def test_a_call_with_a_computed_name_has_no_place_of_the_name() -> None:
    found = in_expression("heard(event.data.result, context.topic) && heard(event.data.result, 'dance') && In()")
    assert list(found) == [
        NameInText(NameKind.CONTEXT, "topic", 33),
        NameInText(NameKind.PHRASE, "dance", 69),
    ]


@pytest.mark.slow
def test_nothing_raises_whatever_the_files_hold() -> None:
    nursery, random = Nursery(), Random(4)
    for number in range(12):
        mutant = nursery.mutant(number)
        analysis = Analysis(ROOT, mutant.files)
        line, column = max(1, mutant.line + random.randrange(-1, 2)), random.randrange(1, 40)
        complete(analysis, mutant.file, line, column)
        hover(analysis, mutant.file, line, column)
        definitions(analysis, mutant.file, line, column)
        symbols(analysis, mutant.file)
        if word := renamable(analysis, mutant.file, line, column):
            with suppress(UsageError):
                rename(analysis, word, "other")


def test_a_route_that_goes_to_a_device_is_one_of_the_route_table() -> None:
    devices = "modules:\n  show: {mqtt: {host: h, routes: {st|ate: lamp/state}}}"
    analysis, where = written("lumen.yaml", "modules:", devices)
    (known,) = definitions(analysis, *where)
    assert analysis.text("lumen.yaml").splitlines()[known.line - 1].startswith("  state: {key: ")
    renamed, (_, line, column) = written("lumen.yaml", "modules:", devices.replace("st|ate", "|"))
    assert "state" in {item.text.removesuffix(": ") for item in complete(renamed, "lumen.yaml", line, column)}


def test_a_renaming_that_would_break_the_project_is_refused() -> None:
    before, after = SHIPPED.diagnostics, SHIPPED.changed(TOUR, SHIPPED.text(TOUR) + "\nnonsense: 1\n").diagnostics
    refuse_harm(before, before)
    with pytest.raises(UsageError, match="nonsense"):
        refuse_harm(before, after)


@for_each("outdated", [True, False])
def test_a_renaming_while_files_change_is_asked_for_again(outdated: bool) -> None:
    """The editor is told that the content was modified, or else gets the edits."""
    judgement = None if outdated else Judgement(SHIPPED.diagnostics, {})
    server = Mock(settled=AsyncMock(), at=Mock(return_value=(SHIPPED, *place(SHIPPED, TOUR, "target: how_are|_you"))))
    server.judge.return_value.judge = AsyncMock(return_value=judgement)
    asked = changes.rename(server, Mock(new_name="how_is_it"))
    with pytest.raises(JsonRpcContentModified) if outdated else nullcontext():
        assert asyncio.run(asked) is server.encoder.return_value.renaming.return_value


def test_a_check_that_begins_while_a_request_is_prepared_is_not_made_outdated_by_it() -> None:
    """The request would end it: the findings of the new text would never be shown."""

    server = LanguageServer()
    begin = partial(server._checking.__setitem__, ROOT, Mock(done=lambda: False))
    settled = partial(server.settled, (ROOT / TOUR).as_uri())
    with (
        patch.multiple(server, file=lambda _: (Mock(prepare=begin), TOUR), _version=lambda _: 1),
        pytest.raises(JsonRpcContentModified),
    ):
        asyncio.run(settled())


def test_an_error_is_harm_although_warnings_are_no_longer_reported() -> None:
    """Unused names are reported only for files without errors."""
    used = "initial: a\ncontext: {b: 1, c: 2, d: 3}\nstates: {a: {on: {heard: a}}}\n"
    before, _ = first(f"|{used}")
    after = before.changed(HOST, before.text(HOST).replace("heard: a", "heard: z"))
    assert len(after.diagnostics) < len(before.diagnostics)
    with pytest.raises(UsageError, match="`z`"):
        refuse_harm(before.diagnostics, after.diagnostics)
