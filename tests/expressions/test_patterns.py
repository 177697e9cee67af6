"""Patterns match the same texts as Python's `re`; patterns that could run for ever are refused."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import ExpressionError
from lumen.expressions.patterns import compile_pattern
from tests.tables import for_each

PATIENT = settings(deadline=None)
"""No time limit: a busy machine is no fault of an expression."""

ATOMS = st.sampled_from(["a", "b", "c", ".", "[ab]", "[^a]", r"\w", r"\d", r"\s", r"\.", "1", " "])
ANCHORS = st.sampled_from(["^", "$", r"\b", r"\B"])
COUNTS = st.sampled_from(["", "*", "+", "?", "{2}", "{0,2}", "{1,}", "*?"])


def _flat() -> st.SearchStrategy[str]:
    part = st.tuples(ATOMS, COUNTS).map("".join) | ANCHORS
    sequence = st.lists(part, max_size=4).map("".join)
    return st.lists(sequence, min_size=1, max_size=3).map("|".join)


PATTERNS = st.lists(st.one_of(_flat().map("({})".format), _flat().map("(?:{})?".format), ATOMS), max_size=4).map(
    "".join
)


@PATIENT
@given(PATTERNS, st.text("abc1 .\u00e9_", max_size=12))
def test_finds_what_re_finds(pattern: str, text: str) -> None:
    expected = re.search(pattern.replace("$", r"\Z"), text) is not None
    if text or r"\B" not in pattern:  # Python before 3.14 has no \B in an empty text
        assert compile_pattern(pattern).search(text) == expected


@for_each(
    ("pattern", "text"),
    [
        ("(?i)ADA|é", "ada"),
        ("(?i)é", "É"),
        (r"[\]x]", "]"),
        ("[]x]", "]"),
        ("a{2,3}$", "aaa"),
        ("(ab){2}", "abab"),
        (r"\x41\u00e9", "Aé"),
        ("()", ""),
        ("a||b", ""),
        ("(yes|no) thanks", "no thanks"),
        ("}", "}"),
        (r"\{", "{"),
        ("^x(a+)+$", "xaaa"),
        ("^(a*)*$", "aaa"),
        ("^(a|b*){2,}$", "abba"),
        ("^((a+)b)*$", "aabab"),
        ("(?P<n>a)", "a"),
        ("^a{999}$", "a" * 999),
        ("^[[a]$", "["),
        ("(" * 30 + "a" + ")" * 30, "a"),
        (r"^\w+$", "Jos\u00e9"),
        (r"^[\W\d]$", "\u0663"),
        ("^[^\\W\\d_]+$", "\u4e2d\u6587"),
        (r"caf\u00e9\b", "un caf\u00e9 noir"),
        ("^\\\u00e9$", "\u00e9"),
        ("^.$", "\ud800"),
        ("^a.b$", "a\0b"),
    ],
)
def test_matches(pattern: str, text: str) -> None:
    assert compile_pattern(pattern).search(text)


@for_each(("pattern", "text"), [("a{3}", "aa"), ("a$", "a\n"), ("a.b", "a\nb"), ("[^a]", "a"), ("x{0}y", "x")])
def test_does_not_match(pattern: str, text: str) -> None:
    assert not compile_pattern(pattern).search(text)


@for_each(
    ("pattern", "message", "offset"),
    [
        (r"(a)\1", "refers to an earlier match", 3),
        (r"(?=a)", "this kind of", 0),
        ("(?<!a)b", "this kind of", 0),
        ("a**", "two repetition signs follow each other", 2),
        ("*a", "has nothing before it", 0),
        ("(a", "is not closed", 0),
        ("a)", "a `(` is missing", 1),
        ("[a", "is not closed", 0),
        ("[b-a]", "not a set", 0),
        (r"\q", "has no meaning", 0),
        ("a{3,2}", "counts downwards", 1),
        (r"(\w{100}){100}", "too large", 0),
        ("a\\", "has no meaning", 1),
        (r"\k<n>", "refers to an earlier match", 0),
        ("{", "nothing before it", 0),
    ],
)
def test_refused(pattern: str, message: str, offset: int) -> None:
    with pytest.raises(ExpressionError, match=re.escape(message)) as raised:
        compile_pattern(pattern)
    assert raised.value.offset == offset


@PATIENT
@given(st.text(r"ab()[]{}*+?|\^$.-:=!<P1,i", max_size=30))
def test_any_pattern_is_read_or_refused(pattern: str) -> None:
    offset = 0
    try:
        compile_pattern(pattern).search("ab1,i")
    except ExpressionError as error:
        offset = error.offset
    assert 0 <= offset <= len(pattern)


@for_each(
    "pattern",
    ["(a|aa)*b", "(?:a|a)*b", ".*.*.*.*.*x", "a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?a?x", "(a+)+$b", "((a*)*)*b"],
)
def test_hard_patterns_end(pattern: str) -> None:
    """Each would take `re` minutes or more on such a text."""
    assert not compile_pattern(pattern).search("a" * 1000)
