"""Findings of lint in expressions, before they run."""

from lumen.expressions import check_expression, check_template, names, parse_expression, schema_of
from tests.tables import for_each

CONTEXT = {
    "n": {"type": "integer"},
    "name": {"type": "string"},
    "visitor": {"type": ["string", "null"]},
    "on": {"type": "boolean"},
    "list": {"type": "array", "items": {"type": "string"}},
    "any": {},
    "nothing": {"type": "null"},
    "map": {"type": "object", "properties": {"a": {"type": "number"}}},
    "kind": {"enum": ["a", 1]},
    "one": {"const": "x"},
    "odd": {"$ref": "#/x"},
    "open": {"type": "object"},
    "untyped": {"properties": {"a": {"type": "number"}}},
    "dict": {"type": "object", "properties": {}, "additionalProperties": {"type": "number"}},
}
HEARD = {
    "type": "object",
    "properties": {"result": {"type": "string"}, "date": {"type": "string"}},
    "required": ["result"],
}
FACE = {"type": "object", "properties": {"x": {"type": "number"}, "y": {"type": "number"}}}
EVENTS = {"heard": HEARD, "face": FACE}


def check(source: str, events: object = "heard", **more: object) -> list[tuple[str, str]]:
    """Return the codes, each with the part of the source that it points at."""
    arriving = {"heard": HEARD} if events == "heard" else events
    names = {"phrases": ["dance"], "answers": ["faq"], "states": ["talk", "talk.ask"]}
    findings = check_expression(source, context=CONTEXT, events=arriving, **(names | more))  # type: ignore[arg-type]
    return [(f.code, source[f.offset : f.offset + f.length]) for f in findings]


@for_each(
    "source",
    [
        "context.n < 3 && context.on",
        "context.visitor != null && size(context.visitor) > 2",
        "context.visitor == 'Ada'",
        "context.any.deep[3] + 1 > 2",
        "context.n == null",
        "context.n == 1.5",
        "context.map.a + 1",
        "context.open.x == 1",
        "event.data.result == 'x'",
        "heard(event.data.result, 'dance')",
        "lookup(event.data.result, 'faq')",
        "In('talk.ask')",
        "has(event.data.date) && event.data.date != ''",
        "!has(event.data.date) || event.data.date != ''",
        "context.odd.x.y",
        "has(event.data.date) ? event.data.date : ''",
        "has(event.data.other) ? event.data.other == 1 : false",
        "context.list[0] + 'a'",
        "'a' in context.list",
        "'a' in context.map",
        "context.kind == 1",
        "event.name == 'heard'",
        "state.language == 'en' && state.path == 'talk'",
        "lookup('x', 'faq') + 1",
        "(context.on ? 1 : 'a') == 'a'",
        "hour() < 11",
        "heard(context.name, context.name)",
        "context.one + 'a'",
        "has(context.dict.a) && context.dict.a > 1",
        "context.n > 1.5 == true",
    ],
)
def test_nothing_wrong(source: str) -> None:
    assert check(source) == []


@for_each(
    ("source", "code", "part"),
    [
        ("1 +", "expression-syntax", ""),
        ("visitor == 1", "unknown-name", "visitor"),
        ("context.m + 1", "unknown-context-key", "m"),
        ("context['m']", "unknown-context-key", "'m']"),
        ("has(context.m)", "unknown-context-key", "m"),
        ("1 + sze('a')", "unknown-function", "sze('a')"),
        ("size()", "wrong-argument-count", "size()"),
        ("has(1)", "wrong-argument", "1"),
        ("context.n == 'a'", "type-mismatch", "context.n == 'a'"),
        ("context.n != context.name", "type-mismatch", "context.n != context.name"),
        ("context.nothing == 'a'", "type-mismatch", "context.nothing == 'a'"),
        ("context.one == 1", "type-mismatch", "context.one == 1"),
        ("context.n < 'a'", "type-mismatch", "context.n < 'a'"),
        ("context.n + 'a'", "type-mismatch", "context.n + 'a'"),
        ("context.name * 2", "type-mismatch", "context.name"),
        ("!context.n", "type-mismatch", "context.n"),
        ("-context.name", "type-mismatch", "context.name"),
        ("context.n && true", "type-mismatch", "context.n"),
        ("context.n ? 1 : 2", "type-mismatch", "context.n"),
        ("1 in context.n", "type-mismatch", "context.n"),
        ("1 in context.map", "type-mismatch", "1"),
        ("size(context.n)", "type-mismatch", "context.n"),
        ("context.n.lower()", "type-mismatch", "context.n"),
        ("context.n.x", "type-mismatch", "context.n"),
        ("context.list['a']", "type-mismatch", "context.list"),
        ("context.name[0]", "type-mismatch", "context.name"),
        ("context.list[context.name]", "type-mismatch", "context.name"),
        ("context.list[0] + 1", "type-mismatch", "context.list[0] + 1"),
        ("context.map.b", "unknown-field", "b"),
        ("context.untyped.b", "unknown-field", "b"),
        ("context.untyped + 1", "type-mismatch", "context.untyped + 1"),
        ("event.data.rsult", "unknown-field", "rsult"),
        ("event.at", "unknown-field", "at"),
        ("state.name", "unknown-field", "name"),
        ("event.data.date == 'x'", "unguarded-field", "date"),
        ("context.dict.a", "unguarded-field", "a"),
        ("heard(event.data.result, 'danse')", "unknown-phrase", "'danse'"),
        ("lookup('a', 'fqa')", "unknown-answers", "'fqa'"),
        ("In('tlk')", "unknown-state", "'tlk'"),
        ("matches('a', '(?!a)')", "unsafe-pattern", "'(?!a)'"),
        ("matches('a', context.name)", "unsafe-pattern", "context.name"),
        ("event.data.result == 1", "type-mismatch", "event.data.result == 1"),
        ("context.on == 'true'", "type-mismatch", "context.on == 'true'"),
        ("size(words('a')) == '1'", "type-mismatch", "size(words('a')) == '1'"),
        ("contains(1, 2).size()", "type-mismatch", "contains(1, 2)"),
    ],
)
def test_wrong(source: str, code: str, part: str) -> None:
    assert (code, part) in check(source)


def test_everything_is_found_in_order() -> None:
    found = check("context.m == 1 || sze('a') || event.data.rsult == 1 || context.n < 'a'")
    assert [code for code, _ in found] == ["unknown-context-key", "unknown-function", "unknown-field", "type-mismatch"]


def test_hints() -> None:
    def hint(source: str) -> str:
        return check_expression(source, context=CONTEXT, events={"heard": HEARD}, states=["talk"], phrases=[])[0].hint

    assert hint("context.visitr").startswith("did you mean `visitor`? `context` has ")
    assert hint("visitor == 'a'").startswith("did you mean `context.visitor`?")
    assert hint("event.data.rsult").startswith("did you mean `result`?")
    assert hint("event.data.date") == "check it with `has(event.data.date)` first"
    assert hint("context.n == '3'") == "this is always false"
    assert hint("In('tlak')").startswith("did you mean `talk`?")
    assert hint("context.n ** 2") == "there is no operator for powers: multiply"
    assert hint("context.n // 2").startswith("to divide, write `/`")
    assert hint("context.n <> 2") == "write `!=`"
    assert hint("event?.data") == "check with `has(…)` first"
    assert hint("context.größe").startswith("write a field with such a letter in brackets")


@for_each(
    ("source", "code"),
    [
        ("event.data.x > 1", "unknown-field"),
        ("has(event.data.x) && event.data.x > 1", None),
        ("event.name == 'face' && event.data.x > 1", None),
        ("event.name != 'face' || event.data.x > 1", None),
        ("event.name == 'heard' && event.data.x > 1", "unknown-field"),
        ("event.name == 'face' ? event.data.x : 0", None),
        ("event.name == 'face' ? 0 : event.data.x", "unknown-field"),
        ("event.name == 'face' && event.data.x == 'a'", "type-mismatch"),
        ("event.name == 'a'", None),
    ],
)
def test_several_events(source: str, code: str | None) -> None:
    found = check(source, EVENTS)
    assert [c for c, _ in found] == ([code] if code else [])


def test_a_field_of_some_events_has_its_own_message() -> None:
    finding = check_expression("event.data.x", context={}, events=EVENTS)[0]
    assert (finding.message, finding.hint) == (
        "not every event here has `event.data.x`",
        "check it with `has(event.data.x)` first",
    )


@for_each("events", [None, {}, {"a": None}, {"a": {}, "b": None}, {"a": {"type": "object"}}, {"a": {"anyOf": []}}])
def test_unknown_events_may_hold_anything(events: object) -> None:
    assert check("event.data.x.y + 1 > 2 && event.name == 'a'", events) == []


def test_unknown_surroundings() -> None:
    assert check_expression("context.m && In('x') && heard('a', 'b') && lookup('a', 'b') == 1", context=None) == []


def test_expected() -> None:
    guard = {"type": "boolean"}
    assert check("context.n + 1", expected=guard) == [("type-mismatch", "context.n + 1")]
    assert check("context.on", expected=guard) == []
    assert check("context.any", expected=guard) == []


def test_template() -> None:
    text = "Hi {{ context.visitr }}, {{ size(1) }} {{ context.n }}"
    found = check_template(text, context=CONTEXT)
    assert [(f.code, text[f.offset : f.offset + f.length]) for f in found] == [
        ("unknown-context-key", "visitr"),
        ("type-mismatch", "1"),
    ]
    assert [(f.code, f.offset) for f in check_template("a {{ b", context={})] == [("expression-syntax", 2)]
    assert [(f.code, f.offset) for f in check_template("a {{ 1 + }}", context={})] == [("expression-syntax", 9)]


def test_schema_of_first_values() -> None:
    assert [schema_of(v)["type"] for v in (None, 1, 1.5, "a", True, [], {})] == [
        "null",
        "number",
        "number",
        "string",
        "boolean",
        "array",
        "object",
    ]


def test_names() -> None:
    tree = parse_expression(
        "has(event.data.x) && heard(context.a, 'p') && lookup(context['b'].c, 't') == 1 && In('s') && In(context.d)"
    )
    found = names(tree)
    assert (found.context, found.event) == ({"a", "b", "d"}, {"x"})
    assert found.functions == {"has", "heard", "lookup", "In"}
    assert (found.phrases, found.answers, found.states) == ({"p"}, {"t"}, {"s"})
