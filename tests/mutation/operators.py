"""Mistakes in a YAML file: each operator makes one somewhere in a file."""

import re
from collections.abc import Callable, Mapping
from random import Random

from tests.mutation.text import Sheet

Operator = Callable[[Random, Sheet, Mapping[str, Sheet]], str]
"""The text of the mutant, from a file and all the others."""

NUMBER = re.compile(r"-?\d+(\.\d+)?")
DURATION = re.compile(r"\d+(\.\d+)?(ms|s|min|h)")
ODD = (
    "null", "true", "yes", "0", "-1", "5", "1.5", "1e400", "-.inf", ".nan", "99999999999999999999", "''", "a text",
    "[]", "{}", "[1]", "[[]]", "{a: 1}", "{a: {b: []}}", "12:30", "2026-01-01", "0x1F", "*", "'#idle'", "'.'", "'{{'",
    "é", "'\\0'", "!tag x", "&a x", "*a", "|\n  text", "'context.visitor'", "'event.data.result'",
)  # fmt: skip
EXPRESSIONS = (
    "context.visitor", "context.name_tries + 1", "event.data.result", "1 / 0", "hour() < 11", "size(context.visitor)",
    "context.battery > 'x'", "context.nothing", "trim(context.visitor) == ''", "[1, 2][5]", "{'a': 1}['b']", "true",
    "heard(event.data.result, 'dance')", "lookup(context.reply, 'faq')", "In('idle')", "context.visitor + 1",
    "((((", "'a' * 100000", "context.visitor matches '(a+)+'", "9223372036854775807 + 1", "-context.battery",
    "context.name_tries % 0", "words(context.reply)", "has(event.data.x)", "context", "event", "state",
)  # fmt: skip


def rename_key(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    path = random.choice(sheet.keys)
    other = sheet.source(random.choice(sheet.keys), key=True)
    return sheet.replaced(path, random.choice([other, _typo(random, sheet.source(path, key=True))]), key=True)


def misspell(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    path = random.choice(sheet.leaves)
    return sheet.replaced(path, _typo(random, sheet.source(path)))


def delete(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    return sheet.without(random.choice(sheet.nodes))


def duplicate(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    lines = sheet.text.splitlines(keepends=True)
    at, height = random.randrange(len(lines)), random.choice([1, 1, 2, 5])
    lines[at:at] = lines[at : at + height]
    return "".join(lines)


def retype(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    return sheet.replaced(random.choice(sheet.nodes), random.choice(ODD))


def empty(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    return sheet.replaced(random.choice(sheet.nodes), "")


def indent(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    lines = sheet.text.splitlines(keepends=True)
    at, height = random.randrange(len(lines)), random.choice([1, 1, 1, 2, 6])
    change = random.choice(["  ", "  ", "    ", " ", "\t", "-", "- "])
    for i in range(at, min(at + height, len(lines))):
        lines[i] = change + lines[i] if random.random() < 0.5 else lines[i].removeprefix(change)
    return "".join(lines)


def swap_lines(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    lines = sheet.text.splitlines(keepends=True)
    a = random.randrange(len(lines))
    b = random.choice([min(a + 1, len(lines) - 1), random.randrange(len(lines))])
    lines[a], lines[b] = lines[b], lines[a]
    return "".join(lines)


def swap_values(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Exchange two leaves; the later one is replaced first, so that the places stay right."""
    first, second = sorted(random.choices(sheet.leaves, k=2), key=lambda p: sheet.entry(p))
    one, two = sheet.source(first), sheet.source(second)
    (a, b), (c, d) = (sheet.offsets(sheet.document.place(p)) for p in (first, second))
    return sheet.text[:a] + two + sheet.text[b:c] + one + sheet.text[d:] if b <= c else sheet.replaced(first, two)


def truncate(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    return sheet.text[: random.randrange(len(sheet.text))]


def garble(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Replace a few characters by random ones; surrogates become bytes that are no UTF-8."""
    at, length = random.randrange(len(sheet.text)), random.choice([0, 1, 3])
    noise = "".join(random.choice([_ascii, _sign, _no_text])(random) for _ in range(random.choice([1, 1, 4])))
    return sheet.text[:at] + noise + sheet.text[at + length :]


def move(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Move a key with its value to another level: before another key, in line with it."""
    path, goal = random.choice(sheet.keys), random.choice(sheet.keys)
    start, end = sheet.entry(path)
    at = sheet.entry(goal)[0]
    if start <= at < end:
        return sheet.without(path)
    line = sheet.text.rfind("\n", 0, at) + 1
    flow = bool(sheet.text[line:at].strip(" -"))
    piece = sheet.text[start:end]
    piece = piece + ", " if flow else _shifted(piece, at - line - (start - sheet.text.rfind("\n", 0, start) - 1)) + "\n"
    piece += "" if flow else " " * (at - line)
    moved = random.random() < 0.5
    if not moved:
        return sheet.text[:at] + piece + sheet.text[at:]
    if at <= start:
        return sheet.text[:at] + piece + sheet.text[at:start] + sheet.text[end:]
    return sheet.text[:start] + sheet.text[end:at] + piece + sheet.text[at:]


def exchange(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Replace a value by one of another place or another file."""
    other = random.choice([sheet, random.choice(list(others.values()))])
    nodes = random.choice([other.leaves, other.nodes])
    value = other.document.data
    path = random.choice(nodes)
    for step in path:
        value = value[step]
    return sheet.replaced(random.choice(random.choice([sheet.leaves, sheet.nodes])), _flow(value))


def same_kind(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Replace a value by one of the same key elsewhere in the file: a target by a target, an angle by an angle."""
    path = random.choice(sheet.leaves)
    alike = [
        p
        for p in sheet.leaves
        if [s for s in p if isinstance(s, str)][-1:] == [s for s in path if isinstance(s, str)][-1:]
    ]
    return sheet.replaced(path, sheet.source(random.choice(alike)))


def scale(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    found = list(NUMBER.finditer(sheet.text))
    if not found:
        return sheet.text[::-1]
    number = random.choice(found)
    value = float(number[0]) * random.choice([-1, 0, 0.001, 0.5, 2, 10, 57.3, 1000, 1e9, 1e300])
    return sheet.text[: number.start()] + f"{value:g}" + sheet.text[number.end() :]


def unit(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    found = list(DURATION.finditer(sheet.text))
    if not found:
        return scale(random, sheet, others)
    match = random.choice(found)
    number = match[0].rstrip("minhs")
    new = random.choice(["{}", "{} s", "{}sec", "-{}s", "{}ms", "{}h", "{}min", "0s", "0.001ms", "1e9h", "{}m", "∞"])
    return sheet.text[: match.start()] + new.format(number) + sheet.text[match.end() :]


def confuse(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Replace a value by a list or a map, or a list by one of its items."""
    path = random.choice(sheet.nodes)
    value = sheet.value(path)
    ways: list[object] = [[value], {"a": value}, [[value]]]
    if isinstance(value, dict) and value:
        key = random.choice(list(value))
        ways += [[{k: v} for k, v in value.items()], list(value), list(value.values()), value[key], key]
    elif isinstance(value, list) and value:
        ways += [value[0], value * 2, value[::-1], {str(i): v for i, v in enumerate(value)}, []]
    else:
        ways += [{str(value): value}, {str(value): None}, [value, value], str(value), []]
    return sheet.replaced(path, _flow(random.choice(ways)))


def express(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Replace a text by an expression or a template, or an expression by a text."""
    path = random.choice(sheet.leaves)
    source = random.choice(EXPRESSIONS)
    return sheet.replaced(path, _flow(random.choice([source, f"Hello {{{{ {source} }}}}", "just words"])))


def operate(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Put another operator, name or literal into an expression."""
    spots = list(
        re.finditer(r"==|!=|&&|\|\||<|>|context\.\w+|event\.data\.\w+|\b(heard|size|trim|after|hour)\b", sheet.text)
    )
    if not spots:
        return express(random, sheet, others)
    spot, other = random.choice(spots), random.choice(spots)
    return sheet.text[: spot.start()] + other[0] + sheet.text[spot.end() :]


def mark(random: Random, sheet: Sheet, others: Mapping[str, Sheet]) -> str:
    """Add the marks of a merge, Windows' line ends, a byte order mark, a second document, or tabs."""
    lines = sheet.text.splitlines(keepends=True)
    at = random.randrange(len(lines))
    merged = [*lines[:at], "<<<<<<< HEAD\n", lines[at], "=======\n", lines[at], ">>>>>>> theirs\n", *lines[at + 1 :]]
    second = [*lines[:at], "---\n", *lines[at:]]
    return random.choice(
        ["".join(merged), sheet.text.replace("\n", "\r\n"), "\ufeff" + sheet.text, "".join(second),
         sheet.text.replace("  ", "\t", 1), sheet.text + sheet.text, "", "#\n", "# " + sheet.text.replace("\n", "\n# ")]
    )  # fmt: skip


OPERATORS: Mapping[str, Operator] = {
    "rename a key": rename_key, "misspell": misspell, "delete": delete, "duplicate": duplicate, "retype": retype,
    "empty": empty, "indent": indent, "swap lines": swap_lines, "swap values": swap_values, "truncate": truncate,
    "random bytes": garble, "move a key": move, "value of another file": exchange, "value of the same key": same_kind,
    "scale a number": scale, "unit": unit, "list or map": confuse, "expression": express, "operator": operate,
    "mark": mark,
}  # fmt: skip


def _ascii(random: Random) -> str:
    return chr(random.randrange(1, 128))


def _sign(random: Random) -> str:
    return random.choice(":-#[]{}'\"&*!|>%@`, \n\t")


def _no_text(random: Random) -> str:
    return chr(random.randrange(0xDC80, 0xDCFF))


def _typo(random: Random, word: str) -> str:
    at = random.randrange(max(1, len(word)))
    return random.choice(
        [word[:at] + word[at + 1 :], word[:at] + word[at : at + 1] * 2 + word[at + 1 :], word.upper(), word.lower(),
         word[:at] + word[at + 1 : at + 2] + word[at : at + 1] + word[at + 2 :], word + "s", word.replace("_", "-")]
    )  # fmt: skip


def _shifted(piece: str, by: int) -> str:
    first, *rest = piece.split("\n")
    return "\n".join(
        [first, *(" " * by + line if by > 0 else line[min(-by, len(line) - len(line.lstrip())) :] for line in rest)]
    )


def _flow(value: object) -> str:
    """Return the value in YAML's flow style, in one line."""
    match value:
        case None:
            return "null"
        case bool():
            return str(value).lower()
        case dict():
            return "{" + ", ".join(f"{_flow(k)}: {_flow(v)}" for k, v in value.items()) + "}"
        case list():
            return "[" + ", ".join(map(_flow, value)) + "]"
        case str():
            return "'" + value.replace("'", "''") + "'"
    return str(value)
