"""Files as editors, word processors and other tools save them: each error is found at its place, and nothing crashes.

Each input is reduced from a public report about another system.
"""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.language.diagnostics import Diagnostic
from lumen.language.text_lines import LineIndex, lines_of
from lumen.lint import check_files
from lumen.lint.repairs import repaired
from lumen.project.yaml_reader import parse
from tests.reports.small_project import STATES, TOUR, changed, project
from tests.tables import for_each

HERE = Path(__file__).parent
INPUTS = HERE / "inputs" / "files"


def found(name: str, content: bytes) -> list[Diagnostic]:
    return list(check_files(HERE, project(name, content))[1])


def told(diagnostic: Diagnostic) -> str:
    return f"{diagnostic.place.line}:{diagnostic.place.column} {diagnostic.code} | {diagnostic.hint}"


def assert_told(diagnostics: list[Diagnostic], expected: list[str]) -> None:
    said = [told(d) for d in diagnostics if d.code not in ("unreachable-state", "unused-file")]
    assert len(said) == len(expected), said
    for one, beginning in zip(said, expected, strict=True):
        assert one.startswith(beginning), one


@for_each(
    ("name", "expected"),
    [
        ("cr-only-crash.yaml", []),
        ("line-separator-crash.yaml", ["6:13 unknown-state | did you mean `idle`?"]),
        ("line-separator-place.yaml", ["7:14 unknown-state | did you mean `idle`?"]),
        ("control-character.yaml", ["11:18 yaml-syntax | replace it with `’`, or delete it"]),
        ("bom-inside.yaml", ["8:1 yaml-syntax | delete it"]),
        ("anchor-twice.yaml", []),
        ("alias-slip.yaml", ["11:9 yaml-syntax | did you mean `*steps`?"]),
        ("phrases-as-text.yaml", ["4:13 foreign-pattern | write separate phrases: [dance, dance for me]"]),
        ("phrases-with-commas.yaml", ["3:15 foreign-pattern | write separate phrases: [dance, dance for me]"]),
        ("braces-of-others.yaml", ["6:15 not-filled-in | write `{{ context.visitor }}`"]),
        ("filter.yaml", ["6:42 expression-syntax | there are no filters: delete `| title`"]),
        (
            "homoglyph.yaml",
            ["6:5 unknown-key | did you mean `onDone`? `о` is a different letter from `o`: U+043E"],
        ),
        ("other-minus.motion.yaml", ["2:32 wrong-type | write `-0.5`: `−` is not the minus sign `-`"]),
        ("at-iso.yaml", ["4:10 bad-time | write `2026-12-24 18:00`"]),
    ],
)
def test_the_error_is_reported_at_its_place_with_a_correction(name: str, expected: list[str]) -> None:
    assert_told(found(name, (INPUTS / name).read_bytes()), expected)


@for_each(
    ("phrases", "message"),
    [
        ("|\n      - dance\n      - dance for me", "this is one phrase: a line break does not separate phrases"),
        ('"dance; dance for me"', "this is one phrase: `;` does not separate phrases"),
        ('"dance, dance for me"', "this is one phrase: `,` does not separate phrases"),
    ],
)
def test_the_sign_between_the_phrases_of_one_text_is_named(phrases: str, message: str) -> None:
    content = f"phrases:\n  dance:\n    en: {phrases}\n{STATES}".encode()
    assert [d.message for d in found("tour.yaml", content) if d.code == "foreign-pattern"] == [message]


BREAKS = {"lf": "\n", "crlf": "\r\n", "cr": "\r"}
NO_BREAKS = {"next line": "\x85", "line separator": "\u2028", "paragraph separator": "\u2029"}


@for_each("end", BREAKS.values(), ids=BREAKS)
@for_each("sign", ["", *NO_BREAKS.values()])
def test_lines_are_counted_alike_with_any_ending_and_content(end: str, sign: str) -> None:
    text = changed("say: Hello", f'say: "Hel{sign}{sign}lo"').decode().replace("onError: idle", "onError: idel")
    content = text.replace("\n", end).encode()
    assert_told(found("tour.yaml", content), ["8:14 unknown-state | did you mean `idle`?"])
    after, done = repaired(
        project("tour.yaml", content), lambda files: check_files(HERE, files)[1], lambda diagnostic: True
    )
    assert after[TOUR] == text.replace("idel", "idle").replace("\n", end).encode()
    assert [fix.title for _, fix in done] == ["write idle"]


@for_each("sign", NO_BREAKS.values(), ids=NO_BREAKS)
def test_a_line_break_of_yaml_1_1_alone_is_part_of_a_text(sign: str) -> None:
    document, diagnostics = parse("a.yaml", f"# note{sign}not: read\na: [x{sign}y, '{sign}', \"\\L\"]\n".encode())
    assert not diagnostics
    assert document is not None
    assert document.data == {"a": [f"x{sign}y", sign, "\u2028"]}
    assert document.place(("a", 0)).line == 2


def test_the_placeholders_for_those_breaks_are_kept_in_a_text() -> None:
    text = "a: \ue000\u2028\ue001\x85"
    document, _ = parse("a.yaml", text.encode())
    assert document is not None
    assert document.data == {"a": "\ue000\u2028\ue001\x85"}


@for_each("text", ["", "a", "a\n", "a\rb\r\nc\n\rd", "\u2028a\x0bb\x0c\x1c\x85\n", "\r\r\n\n"])
def test_offsets_and_places_belong_together(text: str) -> None:
    lines, index = lines_of(text), LineIndex(text)
    assert index.line(len(text)) == len(lines)
    for offset in range(len(text) + 1):
        assert index.offset(index.line(offset), index.column(offset)) == offset


def test_the_excerpt_beside_a_finding_is_the_line_that_it_is_about(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for file, content in project("tour.yaml", (INPUTS / "line-separator-place.yaml").read_bytes()).items():
        path = tmp_path / file
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    assert main(["lint", str(tmp_path)]) == 1
    assert " 7 |     onError: idel\n   |              ^^^^" in capsys.readouterr().out


@for_each(
    ("content", "expected"),
    [
        (STATES.encode("utf-16-le"), "1:1 not-utf8 | save it as UTF-8"),
        (STATES.encode("utf-16-be"), "1:1 not-utf8 | save it as UTF-8"),
        (STATES.encode("utf-16"), "1:1 not-utf8 | save it as UTF-8"),
        (changed("Hello", "It’s").decode().encode("cp1252"), "6:17 not-utf8 | save it as UTF-8"),
        (changed("Hello", "a\x07b"), "6:16 yaml-syntax | delete it"),
        (changed("Hello", "Hé \x93Hello\x94"), "6:18 yaml-syntax | replace it with `“`, or delete it"),
        (
            changed("  greet:", "\u200b  greet:"),
            "5:1 unknown-key | write `greet`: it contains an invisible",
        ),
        (
            changed("  greet:", "  \ufeffgreet:"),
            "5:3 wrong-key | write `greet`: it contains an invisible",
        ),
        (changed("onDone: idle", "onDone: *idle"), '7:13 yaml-syntax | put quotes around it if it is a text: "*idle"'),
        (changed("{say: Hello}", "{say: *Hello*}"), "6:15 yaml-syntax | put quotes around it"),
    ],
)
def test_a_character_that_yaml_does_not_allow_is_named_at_its_place(content: bytes, expected: str) -> None:
    assert_told(found("tour.yaml", content), [expected])


def test_an_alias_refers_to_the_nearest_anchor_above() -> None:
    document, diagnostics = parse("a.yaml", b"a: &x 1\nb: *x\nc: &x [2]\nd: *x\n")
    assert not diagnostics
    assert document is not None
    assert document.data == {"a": 1, "b": 1, "c": [2], "d": [2]}


@for_each(
    ("content", "expected"),
    [
        (changed("{say: Hello}", "{sаy: Hello}"), "6:10 unknown-key | did you mean `say`? `а` is a different letter"),
        (
            changed("onDone: idle", "onDone: іdle"),
            "7:13 unknown-state | did you mean `idle`? `і` is a different letter",
        ),
        (
            changed("onDone: idle", "onDone: idle\u200b"),
            "7:13 unknown-state | did you mean `idle`? it contains an invis",
        ),
        (
            changed("onDone: idle", "ｏｎＤｏｎｅ: idle"),
            "7:5 unknown-key | did you mean `onDone`? `ｏ` is a different",
        ),
        (
            changed("say: Hello", 'say: "{{ context.n − 1 }}"', "context: {n: 1}\n"),
            "6:29 expression-syntax | write `-`: `−` is not the minus sign",
        ),
        (
            changed("say: Hello", 'say: "{{ context.n + １ }}"', "context: {n: 1}\n"),
            "6:31 expression-syntax | write `1`: `１` is a different digit",
        ),
    ],
)
def test_the_difference_between_look_alike_words_is_reported(content: bytes, expected: str) -> None:
    assert_told(found("tour.yaml", content), [expected])


@for_each(
    ("value", "expected"),
    [
        ("０．５", "write `0.5`: `０` is a different digit from `0`: U+FF10"),
        ("–0.5", "write `-0.5`: `–` is not the minus sign"),
        ("−0,5", "write a point: -0.5"),
        ("٣", "write `3`: `٣` is a different digit from `3`"),
    ],
)
def test_a_number_with_look_alike_characters_is_corrected(value: str, expected: str) -> None:
    content = f"keyframes:\n  - {{at: 1s, joints: {{HeadYaw: {value}}}}}\n".encode()
    assert [d.hint[: len(expected)] for d in found("a.motion.yaml", content)] == [expected]


HEARD = """
  heard:
    hears: {dance: idle}
    after: {5s: idle}
"""


@for_each(
    ("phrases", "hints"),
    [
        ('"hello, good morning"', ["write separate phrases: [hello, good morning]"]),
        ('"halt; stop"', ["write separate phrases: [halt, stop]"]),
        ("halt / stop", ["write `(halt|stop)`, or a phrase for each"]),
        ('"halt\\nstop now"', ["write separate phrases: [halt, stop now]"]),
        ('["sit, please", "oh robot, (sit|rest)"]', []),
        ('"(run|walk), please"', []),
        (">\n      jump\n      now", []),
    ],
)
def test_a_text_of_several_phrases_is_reported(phrases: str, hints: list[str]) -> None:
    content = f"phrases:\n  dance:\n    en: {phrases}{STATES.replace('greet}', 'heard}', 1)}{HEARD}"
    said = [d.hint for d in found("tour.yaml", content.encode()) if d.code == "foreign-pattern"]
    assert said == hints


@for_each(
    ("text", "expected"),
    [
        ("Hello, ${visitor}!", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, #{visitor}!", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, %visitor%", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, %(visitor)s", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, <visitor>", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, { visitor }", "not-filled-in | write `{{ context.visitor }}`"),
        ("Hello, {name}", "not-filled-in | write `{{ context.NAME }}`; `context` has no `name`"),
        ("{% if context.visitor %}Hi{% endif %}", "not-filled-in | texts have no `{% … %}`"),
        ("{# a note #} Hi", "not-filled-in | texts have no `{# … #}`"),
        (
            "Hello, {{{ context.visitor }}}!",
            "expression-syntax | write two braces on each side: `{{ context.visitor }}`",
        ),
        ("{{ context.visitor | length }}", "expression-syntax | there are no filters: write `size(context.visitor)`"),
        (
            "{{ context.visitor | default('you') }}",
            "expression-syntax | there are no filters: write `has(context.visitor) ? context.visitor : 'you'`",
        ),
        ("{{ context.a | context.c }}", "expression-syntax | write `||`"),
        ("5 % of [them] cost $5, <b>really</b>, {{ {'a': 1}.a }}", ""),
    ],
)
def test_a_placeholder_of_another_tool_is_corrected(text: str, expected: str) -> None:
    content = changed("say: Hello", f'say: "{text}"', "context: {visitor: my friend, a: true, c: true}\n")
    said = [f"{d.code} | {d.hint}" for d in found("tour.yaml", content) if d.code != "unused-context-key"]
    assert [each[: len(expected)] for each in said] == [expected] * bool(expected)


@for_each(
    ("time", "hint"),
    [
        ("2026-12-24T18:00:00", "write `2026-12-24 18:00`"),
        ("2026-12-24T18:00:00Z", "write `2026-12-24 18:00`; convert it to the project's time zone"),
        ("2026-12-24t8:00+01:00", "write `2026-12-24 08:00`; convert it to the project's time zone"),
        ("0 18 * * 1-5", "this is cron syntax: write `mon-fri 18:00`"),
        ("0 18 * * 0-7", "this is cron syntax: write `18:00`"),
        ("2026-99-99T99:99Z", "write `2026-12-24 18:00`"),
        ("30 9,14 * * *", "this is cron syntax: write `09:30, 14:30`"),
        ("0 0 18 ? * MON-FRI", "this is cron syntax: write `mon-fri 18:00`"),
        ("*/5 * * * *", "this is cron syntax: write days before times"),
        ("75 25 * * *", "this is cron syntax: write days before times"),
        ("18:00-19:00", "`at` is one moment, not a period"),
    ],
)
def test_a_time_of_another_tool_is_corrected_for_at(time: str, hint: str) -> None:
    content = changed("    on: {touched: greet}", f'    on: {{touched: greet}}\n    at: {{"{time}": greet}}')
    assert_told(found("tour.yaml", content), [f"5:10 bad-time | {hint}"])
