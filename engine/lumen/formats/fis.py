"""MATLAB's fuzzy inference systems (`.fis`, and Octave's) as the data of a controller file.

Fuzzy Logic Toolbox, "Save and Load Fuzzy Inference Systems": sections `[System]`, `[Input1]`, `[Output1]`, `[Rules]`; a
rule is the numbers of its terms, `1 -2, 1 (0.5) : 1`, a minus for `not`, 0 for a variable that is not asked.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from math import isfinite, nan
from typing import Any, NamedTuple

from lumen.formats.conversion_findings import ConversionFindings, broken
from lumen.formats.fll.controller_draft import ControllerDraft, operators, ranged
from lumen.formats.fll.fuzzylite_names import written
from lumen.language.controllers import WEIGHTED_DEFUZZIFIERS
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.text_lines import lines_of
from lumen.loading.rule_parser import RuleWord

_SECTION = re.compile(r"\[(System|Input|Output|Rules)\s*(\d*)\]", re.IGNORECASE)
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
    "conjunction": "minimum", "disjunction": "maximum", "implication": "minimum", "defuzzifier": "centroid",
}  # fmt: skip


class FisLine(NamedTuple):
    """`Key=value` of a section, or a rule (without a key), and its place."""

    key: str
    value: str
    place: Place


class FisSection(NamedTuple):
    kind: str
    lines: list[FisLine]
    place: Place


def read_fis(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """The data of a controller file, and what could not be carried over. Raises ForeignFileError for no system."""
    text = content.decode("utf-8-sig", errors="replace")
    findings = ConversionFindings()
    sections = list(_sections(file, text))
    if not any(section.kind == "input" for section in sections):
        raise broken(Place(file), "not-a-controller", "this is no system of MATLAB: it has no [Input1]")
    return _FisReader(file, findings).system(sections), findings.diagnostics


def _sections(file: str, text: str) -> Iterator[FisSection]:
    section: FisSection | None = None
    for row, source in enumerate(lines_of(text), 1):
        said = source.strip()
        place = Place(file, row, len(source) - len(source.lstrip()) + 1, row, len(source.rstrip()) + 1)
        if match := _SECTION.fullmatch(said):
            if section:
                yield section
            section = FisSection(match[1].lower(), [], place)
        elif said and section and said[0] not in "%#":
            key, equals, value = said.partition("=")
            plain = section.kind == "rules" or not equals
            section.lines.append(FisLine("", said, place) if plain else FisLine(key.strip(), value.strip(), place))
    if section:
        yield section


class _FisReader:
    def __init__(self, file: str, findings: ConversionFindings) -> None:
        self.findings, self.draft = findings, ControllerDraft(file, findings)
        self.order: dict[str, list[tuple[str, list[str]]]] = {"input": [], "output": []}
        self.shown: set[str] = set()

    def system(self, sections: list[FisSection]) -> dict[str, Any]:
        head = next((section for section in sections if section.kind == "system"), None)
        said = self.norms(head) if head else {}
        for section in sections:
            if section.kind in self.order:
                self.variable(section, said)
        rules = [self.rule(line) for section in sections if section.kind == "rules" for line in section.lines]
        weighted = said.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS
        usual = {**_USUAL, "aggregation": "unbounded-sum" if weighted else "maximum"}
        block = {"name": "", "operators": operators(said, usual), "rules": [rule for rule in rules if rule]}
        self.draft.blocks.append(block)
        return self.draft.result()

    def norms(self, head: FisSection) -> dict[str, Any]:
        said: dict[str, Any] = {}
        for line in head.lines:
            if line.key in _NORMS:
                word, table = _NORMS[line.key]
                value = line.value.strip("'\"").lower()
                if value in table:
                    said[word] = table[value]
                else:
                    self.findings.lost(line.place, f"there is no {word} `{value}` here: the usual one is used")
        if said.get("defuzzifier") in WEIGHTED_DEFUZZIFIERS:
            said.pop("implication", None)  # a value is not cut
            said["aggregation"] = "unbounded-sum"  # every rule counts with its own weight, whatever is set in the file
        return said

    def variable(self, section: FisSection, said: Mapping[str, Any]) -> None:
        side = section.kind
        named = next((line for line in section.lines if line.key == "Name"), None)
        name = named.value.strip("'\"") if named else f"{side}{len(self.order[side]) + 1}"
        place = named.place if named else section.place
        spec = self.draft.variable(f"{side}s", name, place)
        self.order[side].append((name, []))
        span = next((line for line in section.lines if line.key == "Range"), None)
        ends = _numbers(span.value.strip("[]")) if span else []
        if len(ends) != 2 or not ends[0] < ends[1] or not all(map(isfinite, ends)):
            self.findings.lost(span.place if span else place, f"the range of `{name}` holds nothing")
            ends = [0.0, 1.0]
        spec["range"] = ranged(*ends)
        for line in section.lines:
            if re.fullmatch(r"MF\d+", line.key):
                self.term(side, name, spec, line)
            elif line.key not in ("Name", "Range", "NumMFs"):
                self.findings.lost(line.place, f"`{line.key or line.value[:20]}` can't be said of a variable")

    def term(self, side: str, variable: str, spec: dict[str, Any], line: FisLine) -> None:
        match = _TERM.fullmatch(line.value)
        self.order[side][-1][1].append("")
        if match is None or match["shape"] not in _SHAPES:
            what = (
                f"there is no shape `{match['shape']}` here"
                if match
                else "'NAME':'SHAPE',[PARAMETERS] should stand here"
            )
            self.findings.lost(line.place, f"a term of `{variable}` is left out: {what}")
            return
        kind, order = _SHAPES[match["shape"]]
        values = _numbers(match["values"])
        try:
            values = order(values)
        except IndexError:
            values = []
        before = len(spec.get("terms", ()))
        self.draft.term(variable, spec, match["name"], kind, values, line.place)
        if len(spec.get("terms", ())) > before:
            self.order[side][-1][1][-1] = next(reversed(spec["terms"]))

    def rule(self, line: FisLine) -> str:
        match = _RULE.fullmatch(line.value)
        asked, said = (_whole(match[key]) for key in ("asked", "said")) if match else ([], [])
        if match is None or (len(asked), len(said)) != (len(self.order["input"]), len(self.order["output"])):
            self.findings.lost(line.place, "this rule can't be read", "it reads: 1 2, 1 (1) : 1")
            return ""
        inputs, outputs = self.propositions("input", asked), self.propositions("output", said)
        if inputs is None or outputs is None or not outputs:
            self.findings.lost(line.place, "this rule names a term that is not there")
            return ""
        join = " and " if match["join"] == "1" else " or "
        everything = f"{self.known(*self.order['input'][0])} is any"
        weight = _numbers(match["weight"])[0]
        return self.written(join.join(inputs) or everything, " and ".join(outputs), weight, line)

    def written(self, asked: str, said: str, weight: float, line: FisLine) -> str:
        def spot(_: RuleWord) -> Place:
            return line.place

        suffix = "" if weight == 1.0 else f" with {written(weight) if isfinite(weight) else weight}"
        return self.draft.rule(f"if {asked} then {said}{suffix}", line.place, spot)

    def propositions(self, side: str, numbers: list[float]) -> list[str] | None:
        """`variable is [not] term` for each number that is not 0; None where one is no term."""
        found = []
        for (name, terms), number in zip(self.order[side], numbers, strict=True):
            if number != int(number) or abs(number) > len(terms) or (number and not terms[int(abs(number)) - 1]):
                return None
            if number:
                negated = "not " if number < 0 else ""
                found.append(f"{self.known(name, terms)} is {negated}{terms[int(abs(number)) - 1]}")
        return found

    def known(self, name: str, terms: list[str]) -> str:
        """Our name of a variable; the draft has it, and its terms, as the file's too: MATLAB's may hold blanks."""
        ours = self.draft.names[name]
        if name not in self.shown:
            self.shown.add(name)
            self.draft.names.setdefault(ours, ours)
            self.draft.terms[ours] = {term: term for term in terms if term}
        return ours


def _numbers(text: str) -> list[float]:
    return [_number(word) for word in text.replace(",", " ").split()]


def _whole(text: str) -> list[float]:
    return [0.5 if value != value or abs(value) > 1e6 else value for value in _numbers(text)]


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return nan
