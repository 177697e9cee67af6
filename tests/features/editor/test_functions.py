"""A project's functions in an editor: completion, hover, signatures, definitions and renaming."""

import pytest

from lumen.errors import UsageError
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.completion import complete
from lumen.features.editor.definitions import definitions, uses
from lumen.features.editor.hover import hover
from lumen.features.editor.renaming import applied, renamable, rename
from lumen.features.editor.signatures import signature
from lumen.project.files import read_files
from tests import ROOT

HELLO, BEHAVIOR = "functions/hello.yaml", "behaviors/hello.yaml"
FILES = {
    **read_files(ROOT / "examples/minimal"),
    HELLO: b"description: {en: How to greet., id: Salam.}\nargs: {name: text, hour: number}\n"
    b"expression: \"early(hour) ? 'Good morning, ' + name : 'Hello, ' + name\"\n",
    "functions/early.yaml": b"args: {hour: number}\nexpression: hour < 12\n",
}
TEXT = "{{ hello('Budi', hour()) }}"


def edited(text: str) -> Analysis:
    """Return the project whose greeting is this text."""
    before = FILES[BEHAVIOR].decode()
    line = next(line for line in before.splitlines() if line.lstrip().startswith("do: {say:"))
    indent = line[: len(line) - len(line.lstrip())]
    after = before.replace(line, f'{indent}do: {{say: {{en: "{text}"}}}}')
    return Analysis(ROOT / "examples/minimal", {**FILES, BEHAVIOR: after.encode()})


def at(analysis: Analysis, file: str, text: str) -> tuple[str, int, int]:
    """Return the place behind a piece of a file's text."""
    whole = analysis.text(file)
    offset = whole.index(text) + len(text)
    return file, whole.count("\n", 0, offset) + 1, offset - whole.rfind("\n", 0, offset)


def test_a_call_is_completed() -> None:
    analysis = edited("{{ hel }}")
    found = {item.text: item.detail for item in complete(analysis, *at(analysis, BEHAVIOR, "{{ hel"))}
    assert found["hello("] == "the project's function"


def test_an_expression_of_a_function_begins_with_its_arguments() -> None:
    analysis = edited(TEXT).changed(HELLO, FILES[HELLO].decode().replace("early(hour)", "ho"))
    found = {item.text for item in complete(analysis, *at(analysis, HELLO, 'expression: "ho'))}
    assert "hour" in found
    assert not {"hour(", "context", "hello("} & found


def test_hover_shows_the_description_and_the_expression() -> None:
    analysis = edited(TEXT)
    said = hover(analysis, *at(analysis, BEHAVIOR, "{{ hel"))
    assert "**function `hello`**" in said
    assert "How to greet." in said
    assert "hello(name: text, hour: number)" in said


def test_the_signature_shows_the_argument_that_is_written() -> None:
    analysis = edited(TEXT)
    found = signature(analysis, *at(analysis, BEHAVIOR, "hello('Budi', "))
    assert found
    assert (found.label, found.active) == ("hello(name: text, hour: number)", 1)
    assert found.documentation == "How to greet. Returns text."


def test_the_definition_and_all_uses() -> None:
    analysis = edited(TEXT)
    assert [place.file for place in definitions(analysis, *at(analysis, BEHAVIOR, "{{ hel"))] == [HELLO]
    assert [place.file for place in uses(analysis, *at(analysis, HELLO, 'expression: "ear'))] == [HELLO]
    assert [p.file for p in definitions(analysis, *at(analysis, HELLO, 'expression: "ear'))] == ["functions/early.yaml"]


def test_a_function_is_renamed_with_its_file_and_its_calls() -> None:
    analysis = edited(TEXT)
    use = renamable(analysis, *at(analysis, BEHAVIOR, "{{ hel"))
    assert use
    after = applied(analysis, rename(analysis, use, "greeting"))
    assert "functions/greeting.yaml" in after.files
    assert HELLO not in after.files
    assert "{{ greeting('Budi', hour()) }}" in after.text(BEHAVIOR)
    assert after.diagnostics == analysis.diagnostics


def test_a_function_can_not_have_any_name() -> None:
    analysis = edited(TEXT)
    use = renamable(analysis, *at(analysis, BEHAVIOR, "{{ hel"))
    assert use
    for name, reason in (("early", "there is already"), ("one-two", "letters, digits"), ("size", "comes with Lumen")):
        with pytest.raises(UsageError, match=reason):
            rename(analysis, use, name)
