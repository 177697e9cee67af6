"""The patterns of `matches`: regular expressions in time proportional to the text.

Ours because Python's `re` tries alternatives one after another, so that an innocent pattern can take minutes on a
text that a message brought. A pattern is read into parts and those become an automaton. Repetitions inside
repetitions, references back and looking around are refused: they are where patterns become riddles.
"""

import re
from functools import lru_cache

from lumen.errors import ExpressionError
from lumen.interpreters.expressions.automaton import AutomatonState, CharacterTest, CompiledPattern

_ATOM = re.compile(
    r"\\x[0-9a-fA-F]{2}|\\u[0-9a-fA-F]{4}|\\[^a-zA-Z0-9]|\\[dDwWsSfnrtv]|\[\^?\]?(?:\\.|[^\\\]])*\]|[^\\[]", re.S
)
_CONFUSING = re.compile(r"\[|--|&&|\|\||~~")
_COUNT = re.compile(r"\{(\d{1,4})(,?)(\d{0,4})\}")
_MAX_NESTED_GROUPS = 20
MAX_PATTERN_STATES = 200
"""States of a pattern's automaton, all of which may be followed at once."""


@lru_cache(maxsize=512)
def compile_pattern(source: str) -> CompiledPattern:
    """The pattern, ready to search; raises ExpressionError with the offset in `source` for what is not allowed."""
    return _PatternCompiler(source).pattern()


class _PatternCompiler:
    """Reads a pattern into nested parts, then builds their states from the last part to the first."""

    def __init__(self, source: str) -> None:
        self.ignore_case = source.startswith("(?i)")
        self.source, self.position, self.level = source, 4 * self.ignore_case, 0
        self.states: list[AutomatonState] = []

    def pattern(self) -> CompiledPattern:
        parsed, _ = self.alternatives()
        if self.position < len(self.source):
            raise self.error("a `(` is missing for this `)`", "write `\\)` for the sign itself")
        return CompiledPattern(self.states, self.build(parsed, self.state("end", None, ())))

    def error(self, message: str, hint: str = "", offset: int | None = None) -> ExpressionError:
        return ExpressionError(message, self.position if offset is None else offset, hint)

    def peek(self) -> str:
        return self.source[self.position : self.position + 1]

    def alternatives(self) -> tuple[tuple[object, ...], bool]:
        """The parts between here and the closing `)` or the end, and whether a quantifier stands in them."""
        branches, repeats = [], False
        while True:
            branch, inner = self.sequence()
            branches.append(branch)
            repeats |= inner
            if self.peek() != "|":
                return ("any", *branches), repeats
            self.position += 1

    def sequence(self) -> tuple[tuple[object, ...], bool]:
        parts, repeats = [], False
        while self.peek() not in ("", "|", ")"):
            start = self.position
            part, inner = self.part()
            low, high = self.quantifier()
            if (low, high) != (1, 1):
                repeated = high is None or high > 1
                if inner and repeated:
                    hint = "repeat either the group or what is in it"
                    raise self.error("a repetition stands inside a repetition", hint, start)
                part, inner = ("repeat", part, low, high), inner or repeated
            repeats |= inner
            parts.append(part)
        return ("all", *parts), repeats

    def part(self) -> tuple[tuple[object, ...], bool]:
        start, sign = self.position, self.peek()
        if sign == "(":
            return self.group()
        if sign in "*+?{":
            raise self.error(f"`{sign}` has nothing before it to repeat", f"write `\\{sign}` for the sign itself")
        if sign in "^$":
            self.position += 1
            return ("at", sign), False
        two = self.source[start : start + 2]
        if two in (r"\b", r"\B"):
            self.position += 2
            return ("at", two), False
        if len(two) == 2 and sign == "\\" and two[1] in "123456789kP":
            raise self.error(f"`{two}` refers back to a group", "a pattern can't look at what it matched before")
        atom = _ATOM.match(self.source, start)
        if atom is None:
            what = "this `[` is not closed" if sign == "[" else f"`{two}` has no meaning in a pattern"
            raise self.error(what, "write `\\\\` for a backslash" if sign == "\\" else "")
        self.position = atom.end()
        return ("char", self.character(atom[0], start)), False

    def character(self, atom: str, offset: int) -> "re.Pattern[str] | str":
        if len(atom) == 1 and atom != "." and not self.ignore_case:
            return atom
        if len(atom) > 2 and _CONFUSING.search(re.sub(r"\\.", "", atom[1:])):
            hint = "write a backslash before `[` and before signs that stand twice"
            raise self.error(f"`{atom[:40]}` is not a clear set of characters", hint, offset)
        try:
            return re.compile(atom, re.IGNORECASE if self.ignore_case else 0)
        except re.error as error:
            raise self.error(f"`{atom[:40]}` is not a set of characters", str(error), offset) from None

    def group(self) -> tuple[tuple[object, ...], bool]:
        start = self.position
        self.position += 3 if self.source.startswith("(?:", start) else 1
        if self.peek() == "?":
            raise self.error("a group can't begin with `(?` here", "write `(…)` or `(?:…)`", start)
        self.level += 1
        if self.level > _MAX_NESTED_GROUPS:
            raise self.error(f"more than {_MAX_NESTED_GROUPS} groups stand inside each other")
        inner, repeats = self.alternatives()
        if self.peek() != ")":
            raise self.error("this `(` is not closed", "write `\\(` for the sign itself", start)
        self.position += 1
        self.level -= 1
        return inner, repeats

    def quantifier(self) -> tuple[int, int | None]:
        """How often the part before is repeated: least and most, None for any number."""
        sign, start = self.peek(), self.position
        bounds: dict[str, tuple[int, int | None]] = {"*": (0, None), "+": (1, None), "?": (0, 1)}
        if sign in bounds:
            self.position += 1
            low, high = bounds[sign]
        elif match := _COUNT.match(self.source, start):
            self.position = match.end()
            low = int(match[1])
            high = (int(match[3]) if match[3] else None) if match[2] else low
            if high is not None and high < low:
                raise self.error(f"`{match[0]}` counts downwards", f"write `{{{high},{low}}}`", start)
        else:
            return 1, 1
        if self.peek() == "?":
            self.position += 1
        if self.peek() in bounds or _COUNT.match(self.source, self.position):
            raise self.error("a repetition is repeated", "one `*`, `+` or `?` is enough")
        return low, high

    def state(self, kind: str, test: CharacterTest, next: tuple[int, ...]) -> int:
        if len(self.states) >= MAX_PATTERN_STATES:
            raise self.error("the pattern is too large", "count fewer repetitions", 0)
        self.states.append(AutomatonState(kind, test, next))
        return len(self.states) - 1

    def build(self, part: tuple[object, ...], following: int) -> int:
        """The state where `part` begins, when `following` is where it leads."""
        match part:
            case ("any", *branches):
                starts = tuple(self.build(b, following) for b in branches if isinstance(b, tuple))
                return starts[0] if len(starts) == 1 else self.state("split", None, starts)
            case ("all", *parts):
                for inner in reversed(parts):
                    if isinstance(inner, tuple):
                        following = self.build(inner, following)
                return following
            case ("repeat", tuple() as inner, int() as low, high):
                return self.repeat(inner, low, high if isinstance(high, int) else None, following)
            case (str() as kind, (str() | re.Pattern()) as test):
                return self.state(kind, test, (following,))
        raise AssertionError(part)

    def repeat(self, inner: tuple[object, ...], low: int, high: int | None, following: int) -> int:
        if high is None:
            loop = self.state("split", None, ())
            self.states[loop] = AutomatonState("split", None, (self.build(inner, loop), following))
            following = loop
        for _ in range((high or low) - low if high is not None else 0):
            following = self.state("split", None, (self.build(inner, following), following))
        for _ in range(low):
            following = self.build(inner, following)
        return following
