"""Reads fuzzy inference systems of MATLAB and Octave (`.fis`) as the data of a controller file.

The sections are `[System]`, `[Input1]`, `[Output1]` and `[Rules]` (Fuzzy Logic Toolbox, "Save and Load Fuzzy Inference
Systems"). A rule is a row of term numbers, `1 -2, 1 (0.5) : 1`, with a minus for `not` and 0 for an unused variable.
Octave writes a hedge after the point: `1.2` is `very` before the first term. If no rule fires, an output is in the
middle of its range.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from math import isfinite, nan
from typing import Any, NamedTuple

from lumen.features.formats_fuzzy.fll.controller_draft import ControllerDraft, operators, ranged
from lumen.features.formats_fuzzy.fll.fuzzylite_names import plain, written
from lumen.features.formats_fuzzy.set_formulas import set_formula
from lumen.language.controllers import WEIGHTED_DEFUZZIFIERS
from lumen.language.diagnostics import Diagnostic, Place, did_you_mean
from lumen.language.text_lines import lines_of
from lumen.project.formats.conversion_findings import ConversionFindings, broken
from lumen.project.formats.encodings import text_of
from lumen.project.formats.known import FormatTable, Known
from lumen.project.rule_parser import RuleSyntaxError, parse_rule

_SECTION = re.compile(r"\[(System|Input|Output|Rules)\s*(\d*)\]", re.IGNORECASE)
_MF = re.compile(r"MF(\d+)")
_TERM = re.compile(r"'(?P<name>[^']*)'\s*:\s*'(?P<shape>\w+)'\s*,\s*\[(?P<values>[^\]]*)\]")
_RULE = re.compile(r"(?P<asked>[-+.\d\s]+),(?P<said>[-+.\d\s]+)\((?P<weight>[-+.\deE]+)\)\s*:\s*(?P<join>[12])\s*$")

_SHAPES: Mapping[str, tuple[str, Callable[[list[float]], list[float]]]] = {
    "trimf": ("triangle", lambda p: p),
    "trapmf": ("trapezoid", lambda p: p),
    "gaussmf": ("gaussian", lambda p: [p[1], p[0]]),
    "gauss2mf": ("gaussian-product", lambda p: [p[1], p[0], p[3], p[2]]),
    "gbellmf": ("bell", lambda p: [p[2], p[0], p[1]]),
    "sigmf": ("sigmoid", lambda p: [p[1], p[0]]),
    "dsigmf": ("sigmoid-difference", lambda p: [p[1], p[0], p[2], p[3]]),
    "psigmf": ("sigmoid-product", lambda p: [p[1], p[0], p[2], p[3]]),
    "smf": ("s-shape", lambda p: p),
    "zmf": ("z-shape", lambda p: p),
    "pimf": ("pi-shape", lambda p: p),
    "linsmf": ("ramp", lambda p: p),
    "linzmf": ("ramp", lambda p: [p[1], p[0]]),
    "constant": ("constant", lambda p: p),
    "linear": ("linear", lambda p: p),
}
_OCTAVE_PRODUCTS = {
    name.replace("-", "_"): name
    for name in ("algebraic-product", "bounded-difference", "drastic-product", "einstein-product", "hamacher-product")
}
_OCTAVE_SUMS = {
    name.replace("-", "_"): name
    for name in ("algebraic-sum", "bounded-sum", "drastic-sum", "einstein-sum", "hamacher-sum")
}
_PRODUCTS = {"min": "minimum", "prod": "algebraic-product", **_OCTAVE_PRODUCTS}
_SUMS = {"max": "maximum", "probor": "algebraic-sum", **_OCTAVE_SUMS}
_NORMS = {
    "AndMethod": ("conjunction", _PRODUCTS),
    "OrMethod": ("disjunction", {**_SUMS, "sum": "unbounded-sum"}),
    "ImpMethod": ("implication", _PRODUCTS),
    "AggMethod": ("aggregation", {**_SUMS, "sum": "unbounded-sum"}),
    "DefuzzMethod": (
        "defuzzifier",
        {"centroid": "centroid", "bisector": "bisector", "mom": "mean-of-maximum", "som": "smallest-of-maximum",
         "lom": "largest-of-maximum", "wtaver": "weighted-average", "wtsum": "weighted-sum"},
    ),
}  # fmt: skip
_USUAL = {
    "conjunction": "minimum",
    "disjunction": "maximum",
    "implication": "minimum",
    "defuzzifier": "centroid",
}


MAX_TERM_NUMBER, MAX_TERM_GAP = 1e6, 10
"""The limit of a term's number, and the most missing terms of a variable that are reported."""

_TYPES = ("mamdani", "sugeno", "tsukamoto")
_VARIABLE = Known(read=frozenset(("Name", "Range", "NumMFs", "MF…")))
KNOWN: FormatTable = {
    "[System]": Known(
        read=frozenset((*_NORMS, "Type", "NumInputs", "NumOutputs", "NumRules")),
        meaningless={"Name": "the controller has the name of the file", "Version": "the version of the format"},
    ),
    "[Input]": _VARIABLE,
    "[Output]": _VARIABLE,
    "[Rules]": Known(
        read=frozenset(("rule", "hedge", "not", "weight", "AND or OR")),
        meaningless={"AND or OR of a single condition": "a single condition needs no operator"},
    ),
}
"""The parts of each section that are read or meaningless; `MF…` stands for `MF1`, `MF2`, …"""

_HEDGES = {0.5: ("somewhat",), 2.0: ("very",), 4.0: ("very", "very")}
"""Lumen's hedges, by the power of a membership. Octave adds a tenth of it to the term number: `1.2` is `very`."""


class FisLine(NamedTuple):
    """A line `Key=value` of a section, or a rule."""

    key: str
    """The key; empty for a rule or a line without `=`."""
    value: str
    """The value, or the whole line without a key."""
    place: Place
    """The line's place, without indentation."""


class FisSection(NamedTuple):
    """A section with its lines, and its heading's number (0 for none) and place."""

    kind: str
    number: int
    lines: list[FisLine]
    place: Place

    def line(self, key: str) -> FisLine | None:
        """Return the first line with this key, or None."""
        return next((line for line in self.lines if line.key == key), None)


class FisVariable(NamedTuple):
    """An input or output, by Lumen's name."""

    name: str
    spec: dict[str, Any]
    """The variable's data in the controller file."""
    terms: list[str]
    """Lumen's names of the terms, in the file's order; empty for a term that is left out."""
    shapes: dict[str, tuple[str, list[float]]]
    """The kind and parameters of each term, by Lumen's name."""


def read_fis(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a controller file, and findings.

    Raises ForeignFileError if the file has no input, or if no output or rule is left.
    """
    findings = ConversionFindings()
    text = text_of(file, content, findings)
    sections = list(_sections(file, text, findings))
    if not any(section.kind == "input" for section in sections):
        raise broken(Place(file), "not-a-controller", "this is not a MATLAB fuzzy system: it has no [Input1]")
    return _FisReader(file, findings).system(sections), findings.diagnostics


def _sections(file: str, text: str, findings: ConversionFindings) -> Iterator[FisSection]:
    """Yield the sections in file order; report lines outside sections and unknown headings."""
    section: FisSection | None = None
    for row, source in enumerate(lines_of(text), 1):
        said = source.strip()
        place = Place(file, row, len(source) - len(source.lstrip()) + 1, row, len(source.rstrip()) + 1)
        if not said or said[0] in "%#":
            continue
        if match := _SECTION.fullmatch(said):
            if section:
                yield section
            section = FisSection(match[1].lower(), int(match[2][:6] or 0), [], place)
        elif section is None or said.startswith("["):
            hint = "the sections are [System], [Input1], [Output1] and [Rules]"
            findings.lost(place, f"`{said[:40]}` is left out: it is not in a section", hint)
        else:
            key, equals, value = said.partition("=")
            plain = section.kind == "rules" or not equals
            section.lines.append(FisLine("", said, place) if plain else FisLine(key.strip(), value.strip(), place))
    if section:
        yield section


class _FisReader:
    def __init__(self, file: str, findings: ConversionFindings) -> None:
        self.findings, self.draft = findings, ControllerDraft(file, findings)
        self.order: dict[str, list[FisVariable]] = {"input": [], "output": []}

    def system(self, sections: list[FisSection]) -> dict[str, Any]:
        for section in sections:
            self.known(section)
        heads = [section for section in sections if section.kind == "system"]
        said = self.norms(heads[0]) if heads else {}
        for twice in heads[1:]:
            self.findings.lost(twice.place, "a second [System] is left out")
        for side in self.order:
            for section in self.numbered([section for section in sections if section.kind == side]):
                self.variable(section, said)
        for twice in [section for section in sections if section.kind == "rules"][1:]:
            self.findings.changed(twice.place, "the rules of a second [Rules] are added to those of the first")
        lines = [line for section in sections if section.kind == "rules" for line in section.lines]
        rules = [self.rule(line) for line in lines]
        if heads:
            found = (len(self.order["input"]), len(self.order["output"]), len(lines))
            for key, count in zip(("NumInputs", "NumOutputs", "NumRules"), found, strict=True):
                self.count(heads[0], key, count)
        weighted = said.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        usual = {**_USUAL, "aggregation": "unbounded-sum" if weighted else "maximum"}
        block = {"name": "", "operators": operators(said, usual), "rules": [rule for rule in rules if rule]}
        self.draft.blocks.append(block)
        return self.draft.result()

    def known(self, section: FisSection) -> None:
        """Report a section's unknown and repeated keys."""
        if section.kind == "rules":
            return
        table, seen = KNOWN[f"[{section.kind.capitalize()}]"], set[str]()
        for line in section.lines:
            key = "MF…" if section.kind != "system" and _MF.fullmatch(line.key) else line.key
            for name, hint in table.losses([key]):
                self.findings.lost(line.place, f"`{(name or line.value)[:40]}` is left out", hint)
            if line.key and line.key in seen:
                self.findings.lost(line.place, f"`{line.key}` is set twice: the first value is used")
            seen.add(line.key)

    def numbered(self, sections: list[FisSection]) -> list[FisSection]:
        """Return the sections in the order of their numbers, to which rules refer; report gaps and repetitions."""
        found = sorted(sections, key=lambda section: section.number)
        for number, section in enumerate(found, 1):
            if section.number != number:
                kind = section.kind.capitalize()
                message = f"[{kind}{section.number or ''}] is read as number {number}: rules refer to it by this number"
                self.findings.lost(section.place, message, f"write [{kind}{number}]")
        return found

    def count(self, section: FisSection, key: str, found: int) -> None:
        """Report the count under `key` if it differs from the number found."""
        line = section.line(key)
        if line and _numbers(line.value) != [float(found)]:
            self.findings.lost(line.place, f"`{key}` is {line.value[:20]}, but the file has {found}: all are read")

    def norms(self, head: FisSection) -> dict[str, Any]:
        said: dict[str, Any] = {}
        for line in head.lines:
            value = line.value.strip("'\"").lower()
            if line.key in _NORMS:
                word, table = _NORMS[line.key]
                if value in table:
                    said.setdefault(word, table[value])
                else:
                    near = did_you_mean(value, table, "there are")
                    self.findings.lost(line.place, f"unknown {word} `{value}`: the default is used", near)
            elif line.key == "Type" and value not in _TYPES:
                self.findings.lost(
                    line.place, f"unknown system type `{value[:40]}`", f"write one of {', '.join(_TYPES)}"
                )
        kind, weighted = head.line("Type"), said.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        if kind and (kind.value.strip("'\"").lower() == "mamdani") == weighted:
            method = said.get("defuzzifier", "centroid")
            message = f"`Type` is {kind.value[:40]}, but the defuzzification is {method}: `Type` is ignored"
            self.findings.changed(
                kind.place,
                message,
                "mamdani needs a defuzzification method for sets; sugeno and tsukamoto need wtaver or wtsum",
            )
        if weighted:
            said.pop("implication", None)  # it only cuts sets, not values
            said["aggregation"] = "unbounded-sum"  # each rule has its own weight, whatever the file sets
        return said

    def variable(self, section: FisSection, said: Mapping[str, Any]) -> None:
        side = section.kind
        named = section.line("Name")
        name = named.value.strip("'\"") if named else f"{side}{len(self.order[side]) + 1}"
        place = named.place if named else section.place
        spec = self.draft.variable(f"{side}s", name, place)
        variable = FisVariable(next(reversed(self.draft.sides[f"{side}s"])), spec, [], {})
        self.order[side].append(variable)
        span = section.line("Range")
        ends = _numbers(span.value.strip("[]")) if span else []
        if len(ends) != 2 or not ends[0] < ends[1] or not all(map(isfinite, ends)):
            self.findings.lost(span.place if span else place, f"`{name}` has no valid range: [0 1] is used")
            ends = [0.0, 1.0]
        spec["range"] = ranged(*ends)
        if side == "output":
            spec["default"] = plain(ends[0] / 2 + ends[1] / 2)  # MATLAB's value if no rule fires
        if side == "output" and said.get("defuzzifier", "centroid") != "centroid":
            spec["defuzzifier"] = said["defuzzifier"]
        terms = {int(match[1][:6]): line for line in reversed(section.lines) if (match := _MF.fullmatch(line.key))}
        for number in sorted(terms):
            while len(variable.terms) < min(number - 1, len(terms) + MAX_TERM_GAP):
                variable.terms.append("")
                self.findings.lost(terms[number].place, f"`{name}` has no MF{len(variable.terms)}")
            self.term(name, variable, terms[number])
        self.count(section, "NumMFs", len(terms))

    def term(self, said: str, variable: FisVariable, line: FisLine) -> None:
        match = _TERM.fullmatch(line.value)
        variable.terms.append("")
        if match is None or match["shape"] not in _SHAPES:
            what = f"unknown shape `{match['shape']}`" if match else "write 'NAME':'SHAPE',[PARAMETERS]"
            self.findings.lost(line.place, f"a term of `{said}` is left out: {what}")
            return
        kind, order = _SHAPES[match["shape"]]
        values = _numbers(match["values"])
        try:
            values = order(values)
        except IndexError:
            values = []
        before = len(variable.spec.get("terms", ()))
        self.draft.term(said, variable.spec, match["name"], kind, values, line.place)
        if len(variable.spec.get("terms", ())) > before:
            variable.terms[-1] = next(reversed(variable.spec["terms"]))
            variable.shapes[variable.terms[-1]] = kind, values

    def rule(self, line: FisLine) -> str:
        match = _RULE.fullmatch(line.value)
        asked, said = (_numbers(match[key]) for key in ("asked", "said")) if match else ([], [])
        if match is None or (len(asked), len(said)) != (len(self.order["input"]), len(self.order["output"])):
            self.findings.lost(
                line.place,
                "this is not a rule for these inputs and outputs",
                "with two inputs and one output, write: 1 2, 1 (1) : 1",
            )
            return ""
        inputs = self.propositions("input", asked, line)
        outputs = self.propositions("output", said, line)
        if inputs is None or outputs is None:
            return ""
        if not outputs:
            self.findings.lost(
                line.place, "this rule has no conclusion", "write the number of a term, not 0, for an output"
            )
            return ""
        join = " and " if match["join"] == "1" else " or "
        everything = f"{self.order['input'][0].name} is any"
        weight = _numbers(match["weight"])[0]
        suffix = "" if weight == 1.0 else f" with {written(weight) if isfinite(weight) else weight}"
        rule = f"if {join.join(inputs) or everything} then {' and '.join(outputs)}{suffix}"
        try:
            parse_rule(rule)
        except RuleSyntaxError as error:
            self.findings.lost(line.place, f"this rule is left out: {error.message}", error.hint)
            return ""
        return rule

    def propositions(self, side: str, numbers: list[float], line: FisLine) -> list[str] | None:
        """Return `variable is term`, with hedges, for each number that is not 0.

        Report it and return None if a number's term does not exist or can't be derived.
        """
        found = []
        for variable, number in zip(self.order[side], numbers, strict=True):
            if not number:
                continue
            size = abs(number) if abs(number) < MAX_TERM_NUMBER else 0.0
            which = int(size) if size == size else 0
            if not (0 < which <= len(variable.terms) and variable.terms[which - 1]):
                self.findings.lost(line.place, "this rule refers to a term that does not exist")
                return None
            term, power = variable.terms[which - 1], round(10 * (size - which), 2) or 1.0
            derive = side == "output" and (number < 0 or power != 1.0)
            if derive or (power != 1.0 and power not in _HEDGES):
                term = self.derived(variable, term, power, line, negated=number < 0 and side == "output")
                if not term:
                    return None
                power = 1.0
            hedges = (*(("not",) if number < 0 and side == "input" else ()), *_HEDGES.get(power, ()))
            found.append(" ".join([variable.name, "is", *hedges, term]))
        return found

    def derived(self, variable: FisVariable, term: str, power: float, line: FisLine, *, negated: bool) -> str:
        """Add a term for a set's complement or for a power of its membership, and return the new term's name.

        Report a term that is not a set, and return an empty name. In a conclusion, a hedge changes the rule's degree in
        Lumen, but the set in Octave.
        """
        kind, values = variable.shapes[term]
        formula = set_formula(kind, values)
        what = f"`{variable.name} is {'not ' if negated else ''}{term}`"
        if power != 1.0:
            what += f" to the power of {power:g} (a hedge)"
        if not formula:
            self.findings.lost(line.place, f"this rule is left out: it uses {what}, but `{term}` is not a set")
            return ""
        raised = formula if power == 1.0 else f"pow({formula}, {power:g})"
        name = f"{'not-' if negated else ''}{term}{'' if power == 1.0 else f'-{power:g}'}".replace(".", "_")
        shape = {"function": f"1 - ({raised})" if negated else raised}
        terms = variable.spec["terms"]
        while name in terms and terms[name] != shape:
            name += "_"
        terms[name] = shape
        self.findings.changed(line.place, f"{what} becomes a separate term, `{name}`")
        return name


def _numbers(text: str) -> list[float]:
    return [_number(word) for word in text.replace(",", " ").split()]


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return nan
