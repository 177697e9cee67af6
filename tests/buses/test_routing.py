"""Topic matching against the rules of AMQP 0-9-1, and against the plainest way to write them down."""

from hypothesis import given
from hypothesis import strategies as st

from lumen.bus.memory import matches
from tests.tables import for_each

WORDS = st.lists(st.sampled_from(["a", "b", "", "*", "#"]), max_size=7).map(".".join)


def plainly(pattern: list[str], key: list[str]) -> bool:
    """Return whether a key matches, by the definition, word by word, without regard to speed."""
    if not pattern:
        return not key
    if pattern[0] == "#":
        return any(plainly(pattern[1:], key[i:]) for i in range(len(key) + 1))
    return bool(key) and pattern[0] in ("*", key[0]) and plainly(pattern[1:], key[1:])


@for_each(
    ("pattern", "key", "expected"),
    [
        ("avatar.NAO.data.image", "avatar.NAO.data.image", True),
        ("avatar.NAO.data.*", "avatar.NAO.data.image", True),
        ("avatar.NAO.data.*", "avatar.NAO.data", False),
        ("avatar.*.data", "avatar.NAO.command.data", False),
        ("avatar.#", "avatar", True),
        ("avatar.#.image", "avatar.image", True),
        ("avatar.#.image", "avatar.NAO.data.image", True),
        ("#.data.#", "avatar.NAO.data.image", True),
        ("#", "", True),
        ("*", "", False),
        ("", "", True),
        ("", "a", False),
        ("*.b", ".b", True),
        ("a", "A", False),
        ("a.b", "a.bc", False),
    ],
)
def test_examples(pattern: str, key: str, expected: bool) -> None:
    assert matches(pattern, key) is expected


@given(pattern=WORDS, key=WORDS)
def test_it_is_the_definition(pattern: str, key: str) -> None:
    split = [text.split(".") if text else [] for text in (pattern, key)]
    assert matches(pattern, key) == plainly(*split)


def test_a_pattern_of_many_hashes_is_no_bomb() -> None:
    assert not matches(".".join(["#", "a"] * 60) + ".b", ".".join(["a"] * 120))
