"""Reads Fuzzy Control Language (IEC 61131-7, jFuzzyLogic and FuzzyLite) as the data of a controller file.

`FUNCTION_BLOCK` contains `VAR_INPUT`, `VAR_OUTPUT`, a `FUZZIFY` for each input, a `DEFUZZIFY` for each output, and
`RULEBLOCK`s. A declaration can name several variables and their range. A term is a list of points, a single value or,
outside the standard, a shape with parameters.
"""

import re
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from math import inf
from typing import Any, NamedTuple

from lumen.features.formats_fuzzy.fcl_words import ACCUS, ACTS, ANDS, METHODS, NUMBER, ORS, function, reach, shape
from lumen.features.formats_fuzzy.fll.controller_draft import ControllerDraft, operators, ranged
from lumen.features.formats_fuzzy.fll.fuzzylite_names import plain
from lumen.features.formats_fuzzy.fll.infix_formulas import Trouble
from lumen.language.controllers import WEIGHTED_DEFUZZIFIERS
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.text_lines import LineIndex, lines_of
from lumen.project.formats.conversion_findings import ConversionFindings, broken
from lumen.project.formats.encodings import text_of
from lumen.project.formats.known import FormatTable, Known
from lumen.project.rule_parser import RuleWord

_COMMENT = re.compile(r"(?P<open>\(\*|/\*)|//[^\n]*")
_OPEN = re.compile(r"(VAR_INPUT|VAR_OUTPUT|FUZZIFY|DEFUZZIFY|RULEBLOCK)\b", re.IGNORECASE)
_POINT = re.compile(rf"\(\s*({NUMBER})\s*,\s*({NUMBER})\s*\)")
_RANGE = re.compile(rf"\(\s*({NUMBER}?)\s*\.\.\s*({NUMBER}?)\s*\)")
_RULE = re.compile(r"RULE\s+\w+\s*:\s*(.*)", re.IGNORECASE | re.DOTALL)
_SETTING = re.compile(r"(\w+)\s*(?::=|:)\s*(.*)", re.DOTALL)
_TERM = re.compile(r"TERM\s+(\S+)\s*:=\s*(.*)", re.IGNORECASE | re.DOTALL)

_DECLARATION = re.compile(
    r"(?P<names>[^\s:,;()]+(?:\s*,\s*[^\s:,;()]+)*)\s*:\s*(?P<type>\w+)\s*(?P<range>\(.*?\))?\s*(?P<rest>.*)",
    re.DOTALL,
)
_FRAME = re.compile(r"\s*(?:FUNCTION_BLOCK(?:[ \t]+[^\s;]+)?|END_FUNCTION_BLOCK|;)?\s*", re.IGNORECASE)

_DECLARED = Known(
    read=frozenset(("NAME", "REAL", "RANGE")), meaningless={"LREAL": "all numbers in Lumen have this precision"}
)
KNOWN: FormatTable = {
    "VAR_INPUT": _DECLARED,
    "VAR_OUTPUT": _DECLARED,
    "FUZZIFY": Known(frozenset(("TERM", "RANGE"))),
    "DEFUZZIFY": Known(frozenset(("TERM", "RANGE", "METHOD", "DEFAULT", "ACCU"))),
    "RULEBLOCK": Known(
        frozenset(("RULE", "AND", "OR", "ACT", "ACCU")),
        meaningless={
            "RULE name": "rules are identified by their order",
            "RULEBLOCK name": "a single block needs no name",
        },
    ),
    "FUNCTION_BLOCK": Known(
        frozenset(("VAR_INPUT", "VAR_OUTPUT", "FUZZIFY", "DEFUZZIFY", "RULEBLOCK")),
        meaningless={"FUNCTION_BLOCK name": "the controller has the name of the file"},
    ),
}
"""The parts of a function block that are read or meaningless, by section."""

_OPERATORS = ("AND", "OR", "ACT", "ACCU")
_USUAL = {"conjunction": "minimum", "disjunction": "maximum", "implication": "minimum"}


class FclStatement(NamedTuple):
    """The text before a `;`, and its offset in the file."""

    text: str
    offset: int


class FclSection(NamedTuple):
    """A section `KIND name` with its statements, from `offset` to `end` in the text; `VAR_…` has no name."""

    kind: str
    name: str
    statements: list[FclStatement]
    offset: int
    end: int


def read_fcl(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a controller file, and findings.

    Raises ForeignFileError if the file has no `FUZZIFY`, or if no output or rule is left.
    """
    findings = ConversionFindings()
    text = text_of(file, content, findings)
    reader = _FclReader(file, text, findings)
    block = reader.first(_without_comments(text))
    sections = list(_sections(block))
    reader.tell_outside(block, sections)
    reader.tell_cut(block)
    if not any(section.kind == "FUZZIFY" for section in sections):
        raise broken(Place(file), "not-a-controller", "this is not a function block: it has no FUZZIFY")
    return reader.block(sections), findings.diagnostics


def _without_comments(text: str) -> str:
    """Return the text with comments replaced by spaces, which preserves offsets.

    An unclosed comment extends to the end of the text.
    """
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
        until = close.end() if close else len(text)
        yield FclSection(kind, name, list(_statements(text, begin, stop)), match.start(), until)
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
        self.ranges: dict[str, tuple[str, FclStatement]] = {}
        self.declarations: list[tuple[str, str, FclStatement]] = []
        self.declared: set[str] = set()

    def place(self, offset: int, length: int = 1) -> Place:
        row, column = self.lines.line(offset), self.lines.column(offset)
        return Place(self.file, row, column, row, column + max(length, 1))

    def at(self, statement: FclStatement) -> Place:
        return self.place(statement.offset, len(lines_of(statement.text)[0]))

    def first(self, text: str) -> str:
        """Return the text before a second function block; report that block if there is one."""
        begins = list(re.finditer(r"\bFUNCTION_BLOCK\b", text, re.IGNORECASE))
        if len(begins) < 2:
            return text
        place = self.place(begins[1].start(), len("FUNCTION_BLOCK"))
        self.findings.lost(place, "a second function block is left out", "save each block in its own file")
        return text[: begins[1].start()]

    def tell_outside(self, text: str, sections: list[FclSection]) -> None:
        """Report each text before, between or after the sections, at its first word.

        `FUNCTION_BLOCK NAME`, `END_FUNCTION_BLOCK` and `;` at the beginning of such a text are skipped.
        """
        for begin, end in zip([0, *(s.end for s in sections)], [*(s.offset for s in sections), len(text)], strict=True):
            outside = text[begin:end]
            at = 0
            while (match := _FRAME.match(outside, at)) and match.end() > at:
                at = match.end()
            if word := re.compile(r"\S+").match(outside, at):
                near = get_close_matches(word[0].upper(), [*KNOWN, *(f"END_{name}" for name in KNOWN)], 1)
                message = f"`{word[0][:40]}` is not a section; it and the text after it are left out"
                hint = f"did you mean `{near[0]}`?" if near else ""
                self.findings.lost(self.place(begin + at, len(word[0])), message, hint)

    def tell_cut(self, text: str) -> None:
        """Report a missing `END_FUNCTION_BLOCK`, a sign that the file is incomplete."""
        if re.search(r"\bFUNCTION_BLOCK\b", text, re.IGNORECASE) and not re.search(
            r"\bEND_FUNCTION_BLOCK\b", text, re.IGNORECASE
        ):
            place = self.place(len(text.rstrip()))
            self.findings.changed(place, "`END_FUNCTION_BLOCK` is missing: the file may be incomplete")

    def block(self, sections: list[FclSection]) -> dict[str, Any]:
        blocks = [section for section in sections if section.kind == "RULEBLOCK"]
        said = [self.operators(section) for section in blocks]
        for section in sections:
            if section.kind.startswith("VAR"):
                self.declare(section)
        self.asked(sections)
        for section in sections:
            if section.kind in ("FUZZIFY", "DEFUZZIFY"):
                self.variable(section)
        for section, norms in zip(blocks, said, strict=True):
            rules = [self.rule(statement) for statement in section.statements]
            named = {"name": section.name, "operators": operators(norms, _USUAL)}
            self.draft.blocks.append({**named, "rules": [rule for rule in rules if rule]})
        for _, name, statement in self.declarations:
            if name not in self.draft.names:
                self.findings.lost(self.at(statement), f"`{name}` is left out: it has no terms")
        return self.draft.result()

    def declare(self, section: FclSection) -> None:
        """Read declarations such as `a, b : REAL;`, and their range.

        The range follows the type, `REAL (0 .. 9)`, or the whole declaration, `RANGE := (0 .. 9);`.
        """
        names: list[str] = []
        for statement in section.statements:
            setting = _SETTING.fullmatch(statement.text)
            if setting and setting[1].upper() == "RANGE" and names:
                self.ranges.update((name, (setting[2].strip(), statement)) for name in names)
                continue
            match = _DECLARATION.fullmatch(statement.text)
            if match is None:
                self.findings.lost(self.at(statement), "this is not a declaration", "write: a, b : REAL;")
                continue
            names = [name.strip() for name in match["names"].split(",")]
            for twice in self.declared.intersection(names):
                message = f"`{twice}` is declared twice: both declarations are read as one variable"
                self.findings.changed(self.at(statement), message, "if you mean two variables, rename one")
            self.declared.update(names)
            self.declarations += [(section.kind, name, statement) for name in names]
            if match["range"]:
                self.ranges.update((name, (match["range"], statement)) for name in names)
            known = KNOWN[section.kind]
            if match["type"].upper() not in (*known.read, *known.meaningless):
                message = f"the type `{match['type'][:40]}` is read as REAL"
                self.findings.changed(self.at(statement), message)
            if match["rest"]:
                self.findings.lost(self.at(statement), f"`{match['rest'][:40]}` in a declaration is left out")

    def asked(self, sections: list[FclSection]) -> None:
        """Add the inputs that formulas use but that have no FUZZIFY section, and so no terms.

        Each gets its declared range; an end that is missing or can't be read is infinite.
        """
        formulas = " ".join(t.text for s in sections if s.kind == "DEFUZZIFY" for t in s.statements)
        words = set(
            re.findall(r"[A-Za-z_]\w*", " ".join(re.findall(r"(?i):=\s*FUNCTION\b(.*?)(?= TERM |$)", formulas)))
        )
        known = {section.name for section in sections if section.kind == "FUZZIFY"}
        for kind, name, statement in self.declarations:
            if kind == "VAR_INPUT" and name in words - known:
                match = _RANGE.fullmatch(self.ranges.get(name, ("", None))[0])
                ends = (float(match[1] or -inf), float(match[2] or inf)) if match else (-inf, inf)
                self.draft.variable("inputs", name, self.at(statement))["range"] = ranged(*ends)

    def operators(self, section: FclSection) -> dict[str, Any]:
        """Return a rule block's AND, OR and ACT; store its ACCU for the outputs.

        A missing AND or OR is derived from the other. Unknown, repeated and inconsistent settings are reported.
        """
        found: dict[str, Any] = {}
        partners: dict[str, str] = {}
        accu, seen = "", set[str]()
        for statement in section.statements:
            match = _SETTING.fullmatch(statement.text)
            key, word = (match[1].upper(), match[2].lower()) if match else ("", "")
            if key not in _OPERATORS:
                continue
            if key in seen:
                self.findings.lost(self.at(statement), f"`{key}` is set twice: the last value is used")
            seen.add(key)
            side, other = ("conjunction", "disjunction") if key == "AND" else ("disjunction", "conjunction")
            if key in ("AND", "OR") and (pair := (ANDS if key == "AND" else ORS).get(word)):
                if side in partners and pair[0] != partners[side]:
                    message = f"`{statement.text}` does not match the operator before it: both are used as written"
                    self.findings.changed(self.at(statement), message, "jFuzzyLogic derives both from the last one")
                found[side], partners[other] = pair
            elif key == "ACT" and word in ACTS:
                found["implication"] = ACTS[word]
            elif key == "ACCU" and word in ACCUS:
                accu = ACCUS[word]
            else:
                self.findings.lost(self.at(statement), f"unknown {key} `{word.upper()}`")
        if self.accu.setdefault("", accu) != accu:
            place = self.place(section.offset, len(section.kind))
            self.findings.lost(
                place,
                "ACCU differs from that of the first rule block and is left out",
                "write the same ACCU in all blocks",
            )
        return {**partners, **found}

    def variable(self, section: FclSection) -> None:
        side = "inputs" if section.kind == "FUZZIFY" else "outputs"
        spec = self.draft.variable(side, section.name, self.place(section.offset, len(section.kind)))
        settings: dict[str, tuple[str, FclStatement]] = {}
        for statement in section.statements:
            if (match := _SETTING.fullmatch(statement.text)) and not statement.text.upper().startswith("TERM"):
                key = match[1].upper()
                if key in settings:
                    self.findings.lost(self.at(statement), f"`{key}` is set twice: the first value is used")
                settings.setdefault(key, (match[2].strip(), statement))
                for _, hint in KNOWN[section.kind].losses([key]) if side == "inputs" else ():
                    self.findings.lost(self.at(statement), f"an input can't have `{key}`", hint)
        if side == "outputs":
            self.output(spec, settings)
        ends: list[float] = []
        for statement in section.statements:
            if match := _TERM.fullmatch(statement.text):
                ends += self.term(section.name, spec, match[1], match[2].strip(), statement)
            elif not _SETTING.fullmatch(statement.text):
                self.findings.lost(self.at(statement), "this is neither a term nor a setting")
        if side == "outputs":
            self.accumulated(section, spec)
        self.range(section, spec, settings, ends)
        spec.update({key: spec.pop(key) for key in ("terms",) if key in spec})

    def range(self, section: FclSection, spec: dict[str, Any], settings: Mapping[str, Any], ends: list[float]) -> None:
        declared = self.ranges.get(section.name, ("", None))
        said, statement = settings.get("RANGE", declared)
        if declared[1] and _RANGE.sub(r"\1 \2", said) != _RANGE.sub(r"\1 \2", declared[0]):
            message = f"the range in the declaration of `{section.name}` differs from `RANGE` and is left out"
            self.findings.lost(self.at(declared[1]), message, "delete one of the two ranges")
        match = _RANGE.fullmatch(said)
        if match and match[1] and match[2] and float(match[1]) < float(match[2]):
            spec["range"] = ranged(float(match[1]), float(match[2]))
            return
        place = self.at(statement) if statement else self.place(section.offset, len(section.kind))
        weighted = spec.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        if len(set(ends)) < 2 and weighted:
            self.findings.changed(place, f"the range of `{section.name}` is empty, so its values are not limited")
            ends = [*(ends or [0.0]), (ends or [0.0])[0] + 1.0]
        elif len(set(ends)) < 2:
            self.findings.lost(place, f"`{section.name}` has no range", "write: RANGE := (0 .. 10);")
            ends = [0.0, 1.0]
        else:
            message = f"`{section.name}` has no range: it gets the range of its terms"
            self.findings.changed(place, message, "write: RANGE := (0 .. 10);")
        spec["range"] = ranged(min(ends), max(ends))

    def output(self, spec: dict[str, Any], settings: Mapping[str, tuple[str, FclStatement]]) -> None:
        for key, (said, statement) in settings.items():
            match key:
                case "METHOD" if said.lower() in METHODS:
                    spec.update(operators({"defuzzifier": METHODS[said.lower()]}, {"defuzzifier": "centroid"}))
                case "DEFAULT" if said.upper() == "NC":
                    spec["lock-previous"] = True
                case "DEFAULT" if re.fullmatch(NUMBER, said):
                    spec["default"] = plain(float(said))
                case "ACCU" if said.lower() in ACCUS:
                    spec["aggregation"] = ACCUS[said.lower()]
                case "RANGE":
                    pass
                case _:
                    self.findings.lost(self.at(statement), f"an output can't have `{key} : {said}`")

    def accumulated(self, section: FclSection, spec: dict[str, Any]) -> None:
        """Set the aggregation of an output's conclusions from its own ACCU, else from the rule blocks' ACCU.

        Without either, a weighted defuzzifier sums them, and any other uses their maximum, which is reported.
        """
        weighted = spec.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        said = spec.pop("aggregation", "") or self.accu.get("", "")
        if not said and not weighted:
            place = self.place(section.offset, len(section.kind))
            message = f"ACCU is missing: the conclusions about `{section.name}` are combined by their maximum"
            self.findings.changed(place, message, "for the sum, as in jFuzzyLogic, write ACCU : SUM;")
        usual = "unbounded-sum" if weighted else "maximum"
        spec.update(operators({"aggregation": said or None}, {"aggregation": usual}))

    def term(self, variable: str, spec: dict[str, Any], name: str, said: str, statement: FclStatement) -> list[float]:
        """Add a term, or report one that can't be read.

        Return the x values of its points or its shape's ends, which determine a missing range; empty if it has none.
        """
        points = [float(number) for point in _POINT.findall(said) for number in point]
        if points and not _POINT.sub("", said).strip():
            self.draft.term(variable, spec, name, "discrete", points, self.at(statement))
            return points[::2]
        if re.fullmatch(NUMBER, said):
            return self.single(variable, spec, name, float(said), statement)
        if match := re.fullmatch(r"(?i)FUNCTION\s+(.*)", said, re.DOTALL):
            return self.function(variable, spec, name, match[1], statement)
        if (found := shape(said)) is None:
            message = f"the term `{name}` of `{variable}` is left out: `{said[:40]}` can't be read"
            self.findings.lost(self.at(statement), message)
            return []
        kind, values = found
        self.draft.term(variable, spec, name, kind, values, self.at(statement))
        return reach(kind, values) if not isinstance(values, str) else []

    def function(
        self, variable: str, spec: dict[str, Any], name: str, text: str, statement: FclStatement
    ) -> list[float]:
        """Add a term whose value is computed from the inputs, or report why it is left out; return an empty list."""
        output = spec is self.draft.sides["outputs"].get(self.draft.names[variable])
        inputs = {theirs: ours for theirs, ours in self.draft.names.items() if ours in self.draft.sides["inputs"]}
        found = function(text, inputs) if output else Trouble("the terms of an input must be sets", 0)
        if isinstance(found, Trouble):
            message = f"the term `{name}` of `{variable}` is left out: {found.message}"
            self.findings.lost(self.at(statement), message)
            return []
        if spec.get("defuzzifier", "centroid") == "centroid":
            spec["defuzzifier"] = "weighted-average"
        self.draft.term(variable, spec, name, "function", found, self.at(statement))
        return []

    def single(self, variable: str, spec: dict[str, Any], name: str, x: float, statement: FclStatement) -> list[float]:
        """Add a term with a single value; return `[x]`.

        The term is a constant for a weighted defuzzifier, which replaces an output's `centroid`, else a set without
        width.
        """
        if spec.get("defuzzifier", "centroid") == "centroid" and spec is self.draft.sides["outputs"].get(
            self.draft.names[variable]
        ):
            spec["defuzzifier"] = "weighted-average"
        if spec.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS:
            self.draft.term(variable, spec, name, "constant", [x], self.at(statement))
        else:
            self.draft.term(variable, spec, name, "rectangle", [x, x], self.at(statement))
        return [x]

    def rule(self, statement: FclStatement) -> str:
        match = _RULE.fullmatch(statement.text)
        if match is None:
            if not (setting := _SETTING.fullmatch(statement.text)) or setting[1].upper() not in _OPERATORS:
                self.findings.lost(
                    self.at(statement), "this is neither a rule nor an operator", "write: RULE 1 : IF … THEN …;"
                )
            return ""
        begin = statement.offset + match.start(1)

        def spot(word: RuleWord) -> Place:
            return self.place(begin + min(word.offset, len(match[1])), len(word.text))

        return self.draft.rule(match[1], self.at(statement), spot)
