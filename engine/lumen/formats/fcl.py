"""Fuzzy Control Language (IEC 61131-7) as the data of a controller file; also as jFuzzyLogic and FuzzyLite write it.

`FUNCTION_BLOCK` holds `VAR_INPUT`, `VAR_OUTPUT`, a `FUZZIFY` for each input, a `DEFUZZIFY` for each output, and
`RULEBLOCK`s. A term is a row of points, a single value, or (not in the norm) a shape with its parameters.
"""

import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.formats.conversion_findings import ConversionFindings, broken
from lumen.formats.fll.controller_draft import ControllerDraft, operators, ranged
from lumen.formats.fll.fuzzylite_names import SHAPES, plain
from lumen.language.controllers import TERM_PARAMETERS, WEIGHTED_DEFUZZIFIERS
from lumen.language.diagnostics import Diagnostic, Place
from lumen.loading.line_index import LineIndex
from lumen.loading.rule_parser import RuleWord

_COMMENT = re.compile(r"(?P<open>\(\*|/\*)|//[^\n]*")
_OPEN = re.compile(r"(VAR_INPUT|VAR_OUTPUT|FUZZIFY|DEFUZZIFY|RULEBLOCK)\b", re.IGNORECASE)
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_POINT = re.compile(rf"\(\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)")
_RANGE = re.compile(rf"\(\s*({_NUMBER}?)\s*\.\.\s*({_NUMBER}?)\s*\)")
_RULE = re.compile(r"RULE\s+\w+\s*:\s*(.*)", re.IGNORECASE | re.DOTALL)
_SETTING = re.compile(r"(\w+)\s*(?::=|:)\s*(.*)", re.DOTALL)
_TERM = re.compile(r"TERM\s+(\S+)\s*:=\s*(.*)", re.IGNORECASE | re.DOTALL)

_AND = {"min": "minimum", "prod": "algebraic-product", "bdif": "bounded-difference"}
_OR = {"max": "maximum", "asum": "algebraic-sum", "bsum": "bounded-sum"}
_ACCU = {**_OR, "nsum": "normalized-sum", "sum": "unbounded-sum"}
_METHODS = {"cog": "centroid", "cogs": "weighted-average", "coa": "bisector", "lm": "smallest-of-maximum",
            "rm": "largest-of-maximum", "mm": "mean-of-maximum"}  # fmt: skip
_SHAPES = {"trian": "triangle", "trape": "trapezoid", "gauss": "gaussian", "gbell": "bell", "sigm": "sigmoid",
           **{name.lower(): kind for name, kind in SHAPES.items() if kind not in ("function", "linear")}}  # fmt: skip
_NORMS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "AND": ("conjunction", _AND), "OR": ("disjunction", _OR), "ACT": ("implication", _AND), "ACCU": ("accu", _ACCU),
}  # fmt: skip
_DUAL = {"maximum": "minimum", "algebraic-sum": "algebraic-product", "bounded-sum": "bounded-difference"}
_USUAL = {"conjunction": "minimum", "disjunction": "maximum", "implication": "minimum"}


class FclStatement(NamedTuple):
    """What stands before a `;`, and the offset at which it begins."""

    text: str
    offset: int


class FclSection(NamedTuple):
    """`KIND name`, its statements, and where it begins."""

    kind: str
    name: str
    statements: list[FclStatement]
    offset: int


def read_fcl(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """The data of a controller file, and what could not be carried over. Raises ForeignFileError for no block."""
    text = content.decode("utf-8-sig", errors="replace")
    findings = ConversionFindings()
    reader = _FclReader(file, text, findings)
    sections = list(_sections(_without_comments(text)))
    if not any(section.kind == "FUZZIFY" for section in sections):
        raise broken(Place(file), "not-a-controller", "this is no function block: it has no FUZZIFY")
    return reader.block(sections), findings.diagnostics


def _without_comments(text: str) -> str:
    """The text with blanks in place of comments, so that all else stays where it is; an unclosed one goes on."""
    parts, at = [], 0
    while match := _COMMENT.search(text, at):
        end = match.end()
        if match["open"]:
            close = text.find("*)" if match["open"] == "(*" else "*/", end)
            end = len(text) if close < 0 else close + 2
        parts += [text[at : match.start()], re.sub(r"[^\n]", " ", text[match.start() : end])]
        at = end
    return "".join([*parts, text[at:]])


def _sections(text: str) -> Iterator[FclSection]:
    at = 0
    while match := _OPEN.search(text, at):
        kind = match[1].upper()
        end = re.compile(r"END_VAR\b" if kind.startswith("VAR") else rf"END_{kind}\b", re.IGNORECASE)
        close = end.search(text, match.end())
        stop = close.start() if close else len(text)
        begin, name = match.end(), ""
        if not kind.startswith("VAR") and (word := re.compile(r"\s*([^\s;]+)").match(text, begin, stop)):
            begin, name = word.end(), word[1]
        yield FclSection(kind, name, list(_statements(text, begin, stop)), match.start())
        at = close.end() if close else len(text)


def _statements(text: str, begin: int, stop: int) -> Iterator[FclStatement]:
    for part in re.finditer(r"[^;]+", text[begin:stop]):
        said = part[0].strip()
        if said:
            yield FclStatement(said, begin + part.start() + part[0].index(said[0]))


class _FclReader:
    def __init__(self, file: str, text: str, findings: ConversionFindings) -> None:
        self.file, self.lines, self.findings = file, LineIndex(text), findings
        self.draft = ControllerDraft(file, findings)
        self.accu: dict[str, str] = {}

    def place(self, offset: int, length: int = 1) -> Place:
        row, column = self.lines.line(offset), self.lines.column(offset)
        return Place(self.file, row, column, row, column + max(length, 1))

    def at(self, statement: FclStatement) -> Place:
        return self.place(statement.offset, len(statement.text.split("\n")[0]))

    def block(self, sections: list[FclSection]) -> dict[str, Any]:
        blocks = [section for section in sections if section.kind == "RULEBLOCK"]
        said = [self.operators(section) for section in blocks]
        for section in sections:
            if section.kind in ("FUZZIFY", "DEFUZZIFY"):
                self.variable(section)
        for section, norms in zip(blocks, said, strict=True):
            rules = [self.rule(statement) for statement in section.statements]
            named = {"name": section.name, "operators": operators(norms, _USUAL)}
            self.draft.blocks.append({**named, "rules": [rule for rule in rules if rule]})
        for section in sections:
            if section.kind.startswith("VAR"):
                self.declared(section)
        return self.draft.result()

    def declared(self, section: FclSection) -> None:
        for statement in section.statements:
            name = statement.text.partition(":")[0].strip()
            if name not in self.draft.names:
                self.findings.lost(self.at(statement), f"`{name}` has no terms, and is left out")

    def operators(self, section: FclSection) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for statement in section.statements:
            match = _SETTING.fullmatch(statement.text)
            if match and match[1].upper() in _NORMS:
                word, table = _NORMS[match[1].upper()]
                if match[2].lower() in table:
                    found[word] = table[match[2].lower()]
                else:
                    self.findings.lost(self.at(statement), f"there is no {match[1]} `{match[2]}` here")
        if "disjunction" in found:
            found.setdefault("conjunction", _DUAL[found["disjunction"]])  # the norm: one alone means its dual
        self.accu.update({"": found.pop("accu")} if "accu" in found else {})
        return found

    def variable(self, section: FclSection) -> None:
        side = "inputs" if section.kind == "FUZZIFY" else "outputs"
        spec = self.draft.variable(side, section.name, self.place(section.offset, len(section.kind)))
        settings = {}
        for statement in section.statements:
            if (match := _SETTING.fullmatch(statement.text)) and not statement.text.upper().startswith("TERM"):
                settings[match[1].upper()] = (match[2].strip(), statement)
        if side == "outputs":
            self.output(spec, settings)
        reach: list[float] = []
        for statement in section.statements:
            if match := _TERM.fullmatch(statement.text):
                reach += self.term(section.name, spec, match[1], match[2].strip(), statement)
            elif not _SETTING.fullmatch(statement.text):
                self.findings.lost(self.at(statement), "this can't be read")
        self.range(section, spec, settings, reach)
        spec.update({key: spec.pop(key) for key in ("terms",) if key in spec})

    def range(self, section: FclSection, spec: dict[str, Any], settings: Mapping[str, Any], reach: list[float]) -> None:
        said, statement = settings.get("RANGE", ("", None))
        match = _RANGE.fullmatch(said)
        if match and match[1] and match[2] and float(match[1]) < float(match[2]):
            spec["range"] = ranged(float(match[1]), float(match[2]))
            return
        place = self.at(statement) if statement else self.place(section.offset, len(section.kind))
        if len(set(reach)) < 2:
            self.findings.lost(place, f"`{section.name}` has no range", "write: RANGE := (0 .. 10);")
            reach = [0.0, 1.0]
        else:
            message = f"the range of `{section.name}` is that of its terms"
            self.findings.changed(place, message, "write: RANGE := (0 .. 10);")
        spec["range"] = ranged(min(reach), max(reach))

    def output(self, spec: dict[str, Any], settings: Mapping[str, tuple[str, FclStatement]]) -> None:
        for key, (said, statement) in settings.items():
            match key:
                case "METHOD" if said.lower() in _METHODS:
                    spec.update(operators({"defuzzifier": _METHODS[said.lower()]}, {"defuzzifier": "centroid"}))
                case "DEFAULT" if said.upper() == "NC":
                    spec["lock-previous"] = True
                case "DEFAULT" if re.fullmatch(_NUMBER, said):
                    spec["default"] = plain(float(said))
                case "ACCU" if said.lower() in _ACCU:
                    spec["aggregation"] = _ACCU[said.lower()]
                case "RANGE":
                    pass
                case _:
                    self.findings.lost(self.at(statement), f"`{key} : {said}` can't be said of an output")
        weighted = spec.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        said = spec.pop("aggregation", "" if weighted else self.accu.get("", ""))
        spec.update(operators({"aggregation": said or None}, {"aggregation": "maximum"}))

    def term(self, variable: str, spec: dict[str, Any], name: str, said: str, statement: FclStatement) -> list[float]:
        """Where it begins and ends, to know how far the variable reaches."""
        points = [float(number) for point in _POINT.findall(said) for number in point]
        words = said.split()
        numbers = [float(word) for word in words[1:] if re.fullmatch(_NUMBER, word)]
        if points and not _POINT.sub("", said).strip():
            self.draft.term(variable, spec, name, "discrete", points, self.at(statement))
            return points[::2]
        if re.fullmatch(_NUMBER, said):
            return self.single(variable, spec, name, float(said), statement)
        kind = _SHAPES.get(words[0].lower(), "") if words else ""
        if not kind or len(numbers) != len(words) - 1:
            message = f"the term `{name}` of `{variable}` is left out: `{said[:40]}` can't be read"
            self.findings.lost(self.at(statement), message)
            return []
        if words[0].lower() in ("gbell", "sigm"):  # jFuzzyLogic's order
            numbers = [*numbers[-1:], *numbers[:-1]]
        self.draft.term(variable, spec, name, kind, numbers, self.at(statement))
        return _reach(kind, numbers)

    def single(self, variable: str, spec: dict[str, Any], name: str, x: float, statement: FclStatement) -> list[float]:
        """A value for outputs; for a set it has no width."""
        if spec.get("defuzzifier", "centroid") == "centroid" and spec is self.draft.sides["outputs"].get(variable):
            spec["defuzzifier"] = "weighted-average"
        if spec.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS:
            self.draft.term(variable, spec, name, "constant", [x], self.at(statement))
        else:
            self.draft.term(variable, spec, name, "rectangle", [x, x], self.at(statement))
        return [x]

    def rule(self, statement: FclStatement) -> str:
        match = _RULE.fullmatch(statement.text)
        if match is None:
            if not (setting := _SETTING.fullmatch(statement.text)) or setting[1].upper() not in _NORMS:
                self.findings.lost(self.at(statement), "this can't be read", "a rule reads: RULE 1 : IF … THEN …;")
            return ""
        begin = statement.offset + match.start(1)

        def spot(word: RuleWord) -> Place:
            return self.place(begin + min(word.offset, len(match[1])), len(word.text))

        return self.draft.rule(match[1], self.at(statement), spot)


def _reach(kind: str, parameters: list[float]) -> list[float]:
    """Where a shape begins and ends, a gaussian 3 sigma from its mean; nothing for those that go on without end."""
    match kind, parameters:
        case "gaussian", [mean, sigma, *_]:
            return [mean - 3 * abs(sigma), mean + 3 * abs(sigma)]
        case (("triangle" | "trapezoid" | "rectangle" | "ramp" | "s-shape" | "z-shape" | "pi-shape"), _):
            return parameters[: len(TERM_PARAMETERS[kind])]
    return []
