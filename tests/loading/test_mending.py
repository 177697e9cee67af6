"""Slips in a file that is not YAML: searched in the lines before the error, and corrected on trial."""

from random import Random

from lumen.project.bracketed_texts import bracketed
from lumen.project.document import MAX_NODE_DEPTH
from lumen.project.line_marks import marks_of
from lumen.project.mending import failure, mistake
from tests import ROOT
from tests.tables import for_each

TOUR = (ROOT / "behaviors/tour.yaml").read_text()


def test_a_line_says_what_it_leaves_open() -> None:
    assert marks_of('en: ["a, b", c') == (None, None, (("[", 4),), (), 14, ())
    assert marks_of("on: {guard: \"x != '', target: y}").quote == ('"', 12)
    assert marks_of("- it's # a comment with [ and \"") == (None, None, (), (), 6, ())
    assert marks_of("en: 'I'm sorry'").ended == (("'", 4), ("'", 6))
    assert marks_of("x: [1, 2}]").surplus == (("}", 8),)
    assert marks_of("say: {{ context.name }}").braces == (5,)


def test_the_mended_text_is_yaml_and_has_the_same_lines() -> None:
    broken = TOUR.replace("'RearTactil']\", target", "'RearTactil'], target")
    failed = failure(broken)
    assert failed is not None
    found = mistake(broken, failed, failed)
    assert found is not None
    slip, mended = found
    assert broken.split("\n")[slip.line - 1][slip.column - 1] == '"'
    assert failed - slip.line > 5  # it was noticed much later
    assert failure(mended) is None
    assert mended == TOUR


@for_each(
    ("line", "meant"),
    [
        ('say: {en: "Hello, id: "Halo"}', 'say: {en: "Hello", id: "Halo"}'),
        ("say: ['Hello, 'Halo']", "say: ['Hello', 'Halo']"),
    ],
)
def test_a_quote_that_is_missing_at_the_end_of_a_text_stands_before_the_comma(line: str, meant: str) -> None:
    found = mistake(line, 0, 0)
    assert found is not None
    slip, mended = found
    assert mended == meant
    assert slip.column == line.index("Hello")
    assert slip.message == "a quoted text begins here and is not closed"


def test_what_is_nested_too_deep_is_not_read_further() -> None:
    assert failure(f"a: 1\nb: {'[' * (MAX_NODE_DEPTH - 1)}{']' * (MAX_NODE_DEPTH - 1)}\n") is None
    assert failure(f"a: 1\nb: {'[' * MAX_NODE_DEPTH}{']' * MAX_NODE_DEPTH}\n") == 0


@for_each("seed", range(60))
def test_whatever_is_broken_nothing_but_its_lines_is_changed(seed: int) -> None:
    random = Random(seed)
    text = TOUR
    for _ in range(random.randint(1, 3)):
        at = random.randrange(len(text))
        text = (
            text[:at]
            + random.choice(["", '"', "'", "{", "}", "[", "]", ":", "\n", " ", "- ", "#", "\t", "&", "*"])
            + text[at + 1 :]
        )
    failed = failure(text)
    if failed is None or (found := mistake(text, failed, failed)) is None:
        return
    slip, mended = found
    before, after = text.split("\n"), mended.split("\n")
    assert len(before) == len(after)
    assert {i for i, (one, other) in enumerate(zip(before, after, strict=True)) if one != other} <= {*slip.meant}
    further = failure(mended)
    assert further is None or further > failed
    assert 1 <= slip.line <= len(before)
    assert slip.length > 0


@for_each(
    "line, meant",
    [
        ("    en: [my name is {name}]", '    en: ["my name is {name}"]'),
        ("    en: [yes, call me [now], [please] dance]", '    en: [yes, "call me [now]", "[please] dance"]'),
        ("    en: [please] dance  # politely", '    en: "[please] dance"  # politely'),
        ("      - [please] dance", '      - "[please] dance"'),
        ("      - {name} is my name", '      - "{name} is my name"'),
        ("    x: {en: [(a|b, c) [d]], id: [e] f}", '    x: {en: ["(a|b, c) [d]"], id: "[e] f"}'),
        ("      call me {name}, dance [now]]", '      "call me {name}", "dance [now]"]'),
    ],
)
def test_a_text_with_brackets_in_it_gets_quotes(line: str, meant: str) -> None:
    assert meant in [slip.meant[0] for slip in bracketed(line, 0)]


@for_each(
    "line", ["    do: [{wait: 1s} {say: x}]", "    x: [1, 2] [3, 4]", "    on: {face: a} b", "    x: {a: [b], c: {}}"]
)
def test_lists_and_maps_get_none(line: str) -> None:
    assert list(bracketed(line, 0)) == []
