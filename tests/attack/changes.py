"""Make small random changes to files of other tools: misspell a name, change a value, repeat an element.

    changed(random, ending, text)   a `Change` of that text, or None if it has nothing to change

No change removes a key that only repeats a default. So each change has a meaning, unless the touched name has none.
"""

import ast
import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from random import Random
from typing import Any, NamedTuple

XML_ENDINGS = ("scxml", "xar", "urdf", "xml")
NUMBER = re.compile(r"(?<![\w.])-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_WORD = re.compile(r"[A-Za-z_]\w*")
_FCL_HEAD = re.compile(
    r"\b(FUNCTION_BLOCK|VAR_INPUT|VAR_OUTPUT|FUZZIFY|DEFUZZIFY|RULEBLOCK|OPTION\w*)\b", re.IGNORECASE
)
_COMMENTS = ("#", "%", "//", "/*", "(*", "END_FUNCTION_BLOCK")
"""Beginnings of lines whose changes have no effect."""
_OPPOSITES = {"true": "false", "false": "true"}

Touched = frozenset[tuple[str, str]]
"""The names that a change touches, with their places in the tables of formats: `("<Key>", "frame")`."""


class Change(NamedTuple):
    """A change: the new text, a description, and the changed line of the old text."""

    text: str
    what: str
    line: int
    around: tuple[int, ...]
    """The first lines of the enclosing elements, except the outermost."""
    touched: Touched
    misspelt: bool = False
    """Whether the change misspells a name of the format."""


Changer = Callable[[Random, str], Change | None]


def changed(random: Random, ending: str, text: str) -> Change | None:
    """Return a random change of a file with that ending, None if it has nothing to change."""
    return CHANGERS[ending](random, text)


def normal(ending: str, text: str) -> str:
    """Return the text with each element or key on its own line, or unchanged if it can't be parsed."""
    try:
        if ending in XML_ENDINGS:
            return _xml(ET.fromstring(text))
        return json.dumps(json.loads(text), indent=1, ensure_ascii=False) if ending == "json" else text
    except (ET.ParseError, ValueError, RecursionError):
        return text


def _other(random: Random, value: str) -> str:
    """Return a value with another meaning: with one number changed, or misspelt if it has no number."""
    if value in _OPPOSITES:
        return _OPPOSITES[value]
    numbers = list(NUMBER.finditer(value))
    if not numbers:
        return _misspelt(random, value)
    zeros = [match for match in numbers if not float(match.group())]
    match = random.choice(zeros or numbers)  # scaling an axis has no effect, so change a zero
    return value[: match.start()] + _number(match.group()) + value[match.end() :]


def _number(written: str) -> str:
    try:
        number = float(written)
    except ValueError:
        return "7"  # a number of Python in another notation
    if "." not in written and "e" not in written.lower():
        return str(int(number) + 1)
    return f"{number * 1.25 + 0.375:.6g}"


def _misspelt(random: Random, name: str) -> str:
    """Return the name with an extra letter, a name that no tool has."""
    at = random.randrange(len(name) + 1)
    return name[:at] + "q" + name[at:]


# XML


def _xml(root: ET.Element) -> str:
    ET.indent(root, " ")
    return ET.tostring(root, "unicode")


def _xml_changed(random: Random, text: str) -> Change | None:
    try:
        root = ET.fromstring(text)
    except ET.ParseError:
        return None
    above = {child: parent for parent in root.iter() for child in parent}
    lines = dict(zip(root.iter(), _begins(text), strict=True))
    element = random.choice(list(root.iter()))
    ways = [*(_xml_attribute(name) for name in element.attrib), _xml_repeated, _xml_renamed]
    if element is root:
        ways = ways[:-2]
    if (element.text or "").strip():
        ways.append(_xml_text)
    if not ways:
        return None
    line, tag = lines[element], local(element)
    places = {f"<{tag}>", _special_place(element, above)}
    around: list[int] = []
    touched: set[tuple[str, str]] = set()
    here = element
    while here in above:
        touched.add((f"<{local(above[here])}>", f"<{local(here)}>"))
        here = above[here]
        if here in above:
            around += [lines[here], lines[here[0]]]  # a finding about a curve may be at its first key
    before = {element.tag, *element.attrib}
    what, name = random.choice(ways)(random, element, above.get(element))
    touched |= {(place, name) for place in places}
    misspelt = before != {element.tag, *element.attrib}
    return Change(ET.tostring(root, "unicode"), what, line, tuple(around), frozenset(touched), misspelt)


def _special_place(element: ET.Element, above: Mapping[ET.Element, ET.Element]) -> str:
    """Return the place in the table for an element whose meaning differs from others of its name."""
    joint = above.get(element, element) if element.tag in ("axis", "limit") else element
    if element.tag == "limit" and joint.find("mimic") is not None:
        return "<limit> of a joint that follows"
    if joint.tag == "joint" and joint.get("type") == "fixed":
        return "<joint> that is fixed"
    if local(element) == "Tangent" and element.get("side") == "right" and _is_straight(above[element], above):
        return "<Tangent> before a straight way"
    if local(element) == "ActuatorCurve" and element.get("mute") == "1" and not len(element):
        return "<ActuatorCurve> without keys"
    if local(element) in ("BehaviorKeyframe", "Diagram") and not any(local(one) == "Box" for one in element.iter()):
        return "<Diagram> without boxes"
    if local(element) in ("script", "content") and not "".join(element.itertext()).strip():
        return "<script> without text"
    if local(element) in ("onentry", "onexit") and any(_is_timer(child) for child in element):
        return "timer of an `after`"
    if local(element) == "Timeline" and not any(local(child) == "ActuatorList" for child in element):
        return "<Timeline> without curves"
    return ""


def _is_straight(key: ET.Element, above: Mapping[ET.Element, ET.Element]) -> bool:
    """Return whether the way from a key to the next one is straight."""
    keys = list(above[key])
    after = keys[keys.index(key) + 1] if key is not keys[-1] else None
    left = [one.get("interpType") for one in after or () if one.get("side") == "left"]
    return "bezier" not in left


def _is_timer(element: ET.Element) -> bool:
    """Return whether the action starts or cancels the timer of an exported `after`; repeating it has no effect."""
    return any(element.get(key, "").startswith("after.") for key in ("id", "sendid"))


XmlWay = Callable[[Random, ET.Element, ET.Element | None], tuple[str, str]]


def _xml_attribute(name: str) -> XmlWay:
    def way(random: Random, element: ET.Element, _: ET.Element | None) -> tuple[str, str]:
        value = element.attrib[name]
        if random.random() < 0.5:
            new = _misspelt(random, name.rpartition("}")[2])
            items = [(new if key == name else key, value) for key, value in element.attrib.items()]
            element.attrib.clear()
            element.attrib.update(items)
            return f"`{name}` of `<{local(element)}>` is `{new}`", name
        half = name.endswith("_frame") and value.isdigit() and value != "1"  # half the frames cut keys off
        element.attrib[name] = str(int(value) // 2) if half else _other(random, value)
        return f"`{name}` of `<{local(element)}>` is {element.attrib[name]!r}, not {value!r}", name

    return way


def _xml_repeated(_: Random, element: ET.Element, parent: ET.Element | None) -> tuple[str, str]:
    assert parent is not None
    parent.insert(list(parent).index(element) + 1, deepcopy(element))
    return f"`<{local(element)}>` appears twice", ""


def _xml_renamed(random: Random, element: ET.Element, _: ET.Element | None) -> tuple[str, str]:
    before = local(element)
    space = element.tag[: len(element.tag) - len(before)]
    element.tag = space + _misspelt(random, before)
    return f"`<{before}>` is `<{local(element)}>`", ""


def _xml_text(random: Random, element: ET.Element, _: ET.Element | None) -> tuple[str, str]:
    before = element.text or ""
    element.text = _other(random, before)
    return f"the text of `<{local(element)}>` is {element.text.strip()[:60]!r}", ""


def local(element: ET.Element) -> str:
    """Return the element's name without its namespace."""
    return element.tag.rpartition("}")[2]


def _begins(text: str) -> list[int]:
    """Return the line of each element's start tag, in document order."""
    return [text.count("\n", 0, match.start()) + 1 for match in re.finditer(r"<(?=[\w:])", text)]


# JSON


def _json_changed(random: Random, text: str) -> Change | None:
    try:
        data = json.loads(text)
    except ValueError:
        return None
    places = list(_json_places(data, (), ""))
    if not places:
        return None
    holder, key, path, place = random.choice(places)
    name = str(key)
    if isinstance(holder, list) and place == "tags":
        return None  # tags are a set: repeating one has no effect
    if isinstance(holder, list):
        holder.insert(int(key), deepcopy(holder[int(key)]))
        what = f"{path} appears twice"
    elif random.random() < 0.5 or isinstance(holder[key], dict | list) or key == "reenter" or holder[key] is None:
        new = _misspelt(random, name)
        items = [(new if k == key else k, v) for k, v in holder.items()]
        holder.clear()
        holder.update(items)
        what = f"{path} is `{new}`"
    else:
        holder[key] = _json_other(random, holder[key])
        what = f"{path} is {holder[key]!r}"
    lines, parts = _json_lines(text), path.split(".")
    line = lines.get(path, 0)
    around = (*(lines.get(".".join(parts[:end]), 0) for end in range(1, len(parts))), line + 1)
    touched = {(place, name), *((part, part) for part in parts)}
    return Change(json.dumps(data, indent=1, ensure_ascii=False), what, line, around, frozenset(touched))


def _json_places(data: Any, path: tuple[str, ...], within: str) -> Iterator[tuple[Any, Any, str, str]]:
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in list(items):
        here = (*path, str(key))
        yield data, key, ".".join(here), within
        yield from _json_places(value, here, str(key) if isinstance(data, dict) else within)


def _json_other(random: Random, value: Any) -> Any:
    if isinstance(value, bool):
        return not value
    if isinstance(value, int | float):
        return value + 1
    return _other(random, value)


def _json_lines(text: str) -> dict[str, int]:
    """Return the line of each path in an indented JSON text that has one key or entry per line."""
    found: dict[str, int] = {}
    path: list[str] = []
    counts: list[int] = []
    for number, line in enumerate(text.splitlines(), 1):
        depth, body = len(line) - len(line.lstrip(" ")), line.strip()
        if not depth or body[0] in "]}":
            continue
        del path[depth - 1 :], counts[depth:]
        counts += [0] * (depth - len(counts))
        key = re.match(r'("(?:[^"\\]|\\.)*"): ', body)
        path.append(json.loads(key.group(1)) if key else str(counts[depth - 1]))
        counts[depth - 1] += 1
        found[".".join(path)] = number
    return found


# Line-based formats


PlaceOf = Callable[[list[str], int, int], tuple[str, str]]
"""Return the place and name of the item at a line and column; column -1 is the whole line."""


def _line_changed(place_of: PlaceOf, word: re.Pattern[str]) -> Changer:
    """Return a function that misspells a word, changes a number, or repeats a line of a line-based format."""

    def change(random: Random, text: str) -> Change | None:
        lines = text.split("\n")
        full = [i for i, line in enumerate(lines) if line.strip() and not line.lstrip().startswith(_COMMENTS)]
        if not full:
            return None
        at = random.choice(full)
        line = lines[at]
        start = -1
        found = list(word.finditer(line))
        numbers = list(NUMBER.finditer(line))
        way = random.choice(("word", "number", "twice"))
        if way == "number" and numbers:
            match = random.choice(numbers)
            start = match.start()
            lines[at] = line[:start] + _number(match.group()) + line[match.end() :]
            what = f"{match.group()} is {_number(match.group())}"
        elif way == "word" and found:
            match = random.choice(found)
            new, start = _misspelt(random, match.group()), match.start()
            lines[at] = line[:start] + new + line[match.end() :]
            what = f"`{match.group()}` is `{new}`"
        else:
            lines.insert(at, line)
            what = f"the line {line.strip()[:60]!r} appears twice"
        before = text.split("\n")
        around = _part(before, at) if place_of is _fll_place else ()
        return Change("\n".join(lines), what, at + 1, around, frozenset({place_of(before, at, start)}))

    return change


def _part(lines: list[str], at: int) -> tuple[int, ...]:
    """Return the `enabled` lines of the engine part that contains a line."""
    first = next((i for i in range(at, -1, -1) if lines[i][:1].strip()), 0)
    last = next((i for i in range(at + 1, len(lines)) if lines[i][:1].strip()), len(lines))
    return tuple(number + 1 for number in range(first, last) if "enabled" in lines[number])


def _fis_place(lines: list[str], at: int, start: int) -> tuple[str, str]:
    join = lines[at].rfind(":")
    if 0 <= join < start and sum(number not in "0" for number in lines[at].partition(",")[0].split()) == 1:
        return "[Rules]", "AND or OR of a single condition"
    section = next((line for line in reversed(lines[: at + 1]) if line.lstrip().startswith("[")), "[]")
    return re.sub(r"\d+", "", section.strip()), lines[at].partition("=")[0].strip()


def _fll_place(lines: list[str], at: int, _: int) -> tuple[str, str]:
    head = next((line for line in reversed(lines[: at + 1]) if not line.startswith((" ", "\t"))), "")
    return head.partition(":")[0].strip(), lines[at].partition(":")[0].strip()


def _fcl_place(lines: list[str], at: int, start: int) -> tuple[str, str]:
    parts = [*lines[:at], lines[at][: max(start, 0)]]
    head = next((heads[-1].upper() for line in reversed(parts) if (heads := _FCL_HEAD.findall(line))), "")
    before = re.search(r"(\w+)\W*$", lines[at][: max(start, 0)])
    if before and before.group(1).upper() in ("RULE", "RULEBLOCK", "FUNCTION_BLOCK"):
        return head, f"{before.group(1).upper()} name"
    key = _WORD.search(lines[at])
    return head, key.group().upper() if key else ""


def _motion_place(lines: list[str], at: int, start: int) -> tuple[str, str]:
    if not at:
        return "first line", ""
    return "pose", "name" if lines[at][: max(start, 0)].count(",") == 1 else ""


# Python


def _python_changed(random: Random, text: str) -> Change | None:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    nodes = [
        node
        for node in ast.walk(tree)
        if (isinstance(node, ast.Constant) and not isinstance(node.value, bool | None | bytes))
        or isinstance(node, ast.Call | ast.Expr | ast.Assign | ast.Attribute)
    ]
    if not nodes:
        return None
    node = random.choice(nodes)
    lines = text.split("\n")
    calls = {("call", _called(call)) for call in ast.walk(tree) if isinstance(call, ast.Call) and _holds(call, node)}
    if isinstance(node, ast.Assign):
        return None  # repeating an assignment has no effect
    if isinstance(node, ast.Expr):
        first, last = node.lineno - 1, node.end_lineno or node.lineno
        lines[last:last] = lines[first:last]
        what = f"the line {lines[first].strip()[:60]!r} appears twice"
        return Change("\n".join(lines), what, node.lineno, (), frozenset(calls))
    part = ast.get_source_segment(text, node) or ""
    if isinstance(node, ast.Constant):
        new = _number(part) if isinstance(node.value, int | float) else _other(random, part[1:-1])
        new = new if isinstance(node.value, int | float) else part[0] + new + part[-1]
    else:
        part = part if isinstance(node, ast.Attribute) else ast.get_source_segment(text, node.func) or ""
        name = part.rpartition(".")[2]
        new = part[: len(part) - len(name)] + _misspelt(random, name)
    start = sum(len(line.encode()) + 1 for line in lines[: node.lineno - 1]) + node.col_offset
    behind = text.encode()[start + len(part.encode()) :].decode("utf-8", "replace")
    if re.match(r"[\s\d.,+-]*\]\s*\]\s*\]", behind):
        calls.add(("handle", "after the last key"))
    data = text.encode()
    result = (data[:start] + data[start:].replace(part.encode(), new.encode(), 1)).decode("utf-8", "replace")
    return Change(result, f"`{part[:60]}` is `{new[:60]}`", node.lineno, (), frozenset(calls))


def _called(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def _holds(call: ast.AST, node: ast.AST) -> bool:
    return any(one is node for one in ast.walk(call)) or (isinstance(node, ast.Expr) and node.value is call)


CHANGERS: Mapping[str, Changer] = {
    **dict.fromkeys(XML_ENDINGS, _xml_changed),
    "json": _json_changed,
    "fis": _line_changed(_fis_place, re.compile(r"[A-Za-z]\w*")),
    "fll": _line_changed(_fll_place, re.compile(r"[A-Za-z]\w*")),
    "fcl": _line_changed(_fcl_place, re.compile(r"[A-Za-z]\w*")),
    "motion": _line_changed(_motion_place, re.compile(r"[A-Za-z]\w*")),
    "py": _python_changed,
}
