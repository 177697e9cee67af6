"""Reads an engine in FuzzyLite Language as the data of a controller file.

In FuzzyLite 6 to 8 (fuzzylite.com), an engine consists of a head, input variables, output variables and rule blocks.
"""

import re
from math import inf, isfinite, nan
from typing import Any

from lumen.features.formats_fuzzy.fll.controller_draft import ControllerDraft, operators, ranged
from lumen.features.formats_fuzzy.fll.fll_lines import FllLine, FllLineReader, FllPart
from lumen.features.formats_fuzzy.fll.fuzzylite_names import ACTIVATED, METHODS, NORMS, SHAPES, plain
from lumen.features.formats_fuzzy.fll.infix_formulas import read_formula
from lumen.language.controllers import ACTIVATIONS, S_NORMS, T_NORMS, WEIGHTED_DEFUZZIFIERS
from lumen.language.diagnostics import Diagnostic, Place
from lumen.project.formats.conversion_findings import ConversionFindings, broken, decoded
from lumen.project.formats.known import FormatTable, Known
from lumen.project.rule_parser import RuleWord

_SIDES = {"InputVariable": "inputs", "OutputVariable": "outputs"}
_VARIABLE = frozenset(("description", "enabled", "range", "lock-range", "term"))
KNOWN: FormatTable = {
    "Engine": Known(frozenset(("description",)), meaningless={"Engine": "the controller has the name of the file"}),
    "InputVariable": Known(_VARIABLE),
    "OutputVariable": Known(_VARIABLE | {"lock-previous", "default", "defuzzifier", "aggregation"}),
    "RuleBlock": Known(
        read=frozenset(("enabled", "conjunction", "disjunction", "implication", "activation", "rule")),
        lost={"description": "write a comment"},
        meaningless={"RuleBlock": "a single block, or one without rules, needs no name"},
    ),
}
"""The keys of each kind of part in an engine that are read, lost or meaningless."""

_FLAGS = ("enabled", "lock-range", "lock-previous")
_USUAL = {"conjunction": "minimum", "disjunction": "maximum", "implication": "minimum"}


def read_fll(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a controller file, and findings.

    Raises ForeignFileError if the file has no variables, or if no output or rule is left.
    """
    text, findings = decoded(file, content), ConversionFindings()
    return _FllReader(file, findings).engine(text), findings.diagnostics


class _FllReader(FllLineReader):
    """Reads one FuzzyLite file into a controller `draft`."""

    def __init__(self, file: str, findings: ConversionFindings) -> None:
        super().__init__(file, findings)
        self.draft = ControllerDraft(file, findings)

    def engine(self, text: str) -> dict[str, Any]:
        parts = list(self.parts(text))
        if not any(part.head.key in _SIDES for part in parts):
            message = "this is not a FuzzyLite engine: it has no variables"
            raise broken(Place(self.file), "not-a-controller", message)
        for part in parts:
            self.known(part)
            if part.head.key in _SIDES:
                self.variable(part)
            elif part.head.key == "Engine":
                self.head(part)
        for part in parts:
            if part.head.key == "RuleBlock":
                self.block(part)
        return self.draft.result()

    def head(self, part: FllPart) -> None:
        for line in part.lines:
            if line.key == "description":
                self.draft.data["description"] = line.value or self.draft.data["description"]

    def known(self, part: FllPart) -> None:
        """Report a part's unknown and repeated keys, and flags that are neither `true` nor `false`."""
        kind = {"Engine": "an engine", "RuleBlock": "a rule block"}.get(part.head.key, "a variable")
        seen = set[str]()
        for line in part.lines:
            for _, hint in () if line.key == "description" else KNOWN[part.head.key].losses([line.key]):
                self.lost(line, f"{kind} has no `{line.key}`", hint)
            if line.key in seen and line.key not in ("term", "rule"):
                self.lost(line, f"`{line.key}` is set twice: the last value is used")
            if line.key in _FLAGS and line.value not in ("true", "false"):
                self.lost(line, f"`{line.value}` is neither `true` nor `false`", "write true or false")
            seen.add(line.key)

    def variable(self, part: FllPart) -> None:
        side, name = _SIDES[part.head.key], part.head.value
        said = {line.key: line for line in part.lines}
        spec = self.draft.variable(side, name, self.place(part.head))
        if (line := said.get("description")) and line.value:
            spec["description"] = line.value
        if (line := said.get("enabled")) and line.value == "false":
            self.lost(line, f"`{name}` is switched off; in Lumen it is always on")
        self.range(side, name, spec, said.get("range"), part.head)
        if (line := said.get("lock-range")) and line.value == "true":
            spec["lock-range"] = True
        if side == "outputs":
            self.output(spec, said)
        for line in part.lines:
            if line.key == "term":
                self.term(side, name, spec, line)

    def range(self, side: str, name: str, spec: dict[str, Any], line: FllLine | None, head: FllLine) -> None:
        ends = [_number(word) for word in line.value.split()] if line else []
        if line is None or len(ends) != 2 or not ends[0] < ends[1]:
            self.lost(line or head, f"the range of `{name}` is empty", "write: range: 0.0 1.0")
            ends = [0.0, 1.0]
        if side == "outputs" and not all(map(isfinite, ends)):
            self.lost(line or head, f"the range of the output `{name}` is infinite", "write two finite numbers")
            ends = [0.0, 1.0]
        spec["range"] = ranged(*ends)

    def output(self, spec: dict[str, Any], said: dict[str, FllLine]) -> None:
        line = said.get("default")
        if line and isfinite(default := _number(line.value)):
            spec["default"] = plain(default)
        elif line and line.value not in ("nan", ""):
            self.lost(line, f"`{line.value}` is not a number")
        if (line := said.get("lock-previous")) and line.value == "true":
            spec["lock-previous"] = True
        method = self.defuzzifier(spec, said.get("defuzzifier"))
        usual = "unbounded-sum" if method in WEIGHTED_DEFUZZIFIERS else "maximum"
        aggregation = self.norm(said.get("aggregation"), S_NORMS)
        spec.update(operators({"aggregation": aggregation}, {"aggregation": usual}))

    def defuzzifier(self, spec: dict[str, Any], line: FllLine | None) -> str:
        words = line.value.split() if line else []
        if line is None or not words or words[0] not in METHODS:
            if line and words != ["none"]:
                self.lost(line, f"unknown defuzzifier `{line.value}`", f"FuzzyLite has {', '.join(METHODS)}")
            return "centroid"
        method = METHODS[words[0]]
        if method != "centroid":
            spec["defuzzifier"] = method
        for word in words[1:]:
            if _WHOLE.fullmatch(word) and 10 <= int(word) <= 100_000 and method not in WEIGHTED_DEFUZZIFIERS:
                spec.update({} if int(word) == 1000 else {"resolution": int(word)})
            elif word == "Tsukamoto" and method in WEIGHTED_DEFUZZIFIERS:
                continue  # Lumen's terms imply it
            elif word not in ("Automatic", "TakagiSugeno") or method not in WEIGHTED_DEFUZZIFIERS:
                self.lost(line, f"a defuzzifier can't have `{word}`")
        return method

    def term(self, side: str, variable: str, spec: dict[str, Any], line: FllLine) -> None:
        words = line.value.split(maxsplit=2)
        if len(words) < 2 or words[1] not in SHAPES:
            what = f"unknown shape `{words[1]}`" if len(words) > 1 else "write `term: NAME SHAPE PARAMETERS`"
            self.lost(line, f"a term of `{variable}` is left out: {what}")
            return
        kind = SHAPES[words[1]]
        values: Any = [_number(word) for word in words[2].split()] if len(words) > 2 and kind != "function" else []
        if kind == "function":
            at = line.value.find(words[2], len(words[0]) + len(words[1])) if len(words) > 2 else 0
            values = self.formula(words[2] if len(words) > 2 else "", line, at)
            if not values:
                return
        elif kind == "discrete" and len(values) % 2:
            self.draft.term(variable, spec, words[0], kind, values[:-1], self.place(line))
            if values[-1] != 1.0 and words[0] in self.draft.own_terms(spec):
                spec["terms"][self.draft.own_terms(spec)[words[0]]]["height"] = plain(values[-1])
            return
        self.draft.term(variable, spec, words[0], kind, values, self.place(line))

    def formula(self, text: str, line: FllLine, at: int) -> str:
        found = read_formula(text, self.draft.names)
        if isinstance(found, str):
            return found
        self.findings.lost(self.place(line, at + found.offset, 1), f"this formula is left out: {found.message}")
        return ""

    def norm(self, line: FllLine | None, wanted: tuple[str, ...]) -> str | None:
        if line is None or line.value in ("none", ""):
            return None
        if NORMS.get(line.value) in wanted:
            return NORMS[line.value]
        self.lost(line, f"unknown norm `{line.value}` for {line.key}")
        return None

    def block(self, part: FllPart) -> None:
        said = {line.key: line for line in part.lines}
        if (line := said.get("enabled")) and line.value == "false":
            self.findings.changed(self.place(line), "a rule block that is switched off is left out")
            return
        if (line := said.get("description")) and line.value:
            self.findings.changed(self.place(line), "the description of a rule block is left out", "write a comment")
        norms = {
            "conjunction": self.norm(said.get("conjunction"), T_NORMS),
            "disjunction": self.norm(said.get("disjunction"), S_NORMS),
            "implication": self.norm(said.get("implication"), T_NORMS),
            "activation": self.activation(said.get("activation")),
        }
        rules = [self.rule(line) for line in part.lines if line.key == "rule"]
        self.draft.blocks.append(
            {"name": part.head.value, "operators": operators(norms, _USUAL), "rules": [rule for rule in rules if rule]}
        )

    def activation(self, line: FllLine | None) -> dict[str, Any] | None:
        words = line.value.split() if line else []
        if line is None or words in ([], ["none"], ["General"]):
            return None
        method = ACTIVATED.get(words[0], "")
        settings: dict[str, Any] = {"method": method}
        try:
            if method == "threshold" and len(words) > 1:
                settings |= {"comparison": words[1], "threshold": plain(float(words[2]))}
            elif len(words) > 1:
                settings["rules"] = int(words[1])
                settings |= {"threshold": plain(float(words[2]))} if len(words) > 2 else {}
        except (ValueError, IndexError, OverflowError):
            method = ""
        if not method or not set(settings) - {"method"} <= set(ACTIVATIONS[method]):
            self.lost(line, f"unknown activation `{line.value}`", f"FuzzyLite has {', '.join(ACTIVATED)}")
            return None
        return {key: value for key, value in settings.items() if value != _PLAIN_SETTINGS.get(key)}

    def rule(self, line: FllLine) -> str:
        def spot(word: RuleWord) -> Place:
            return self.place(line, min(word.offset, len(line.value)), max(len(word.text), 1))

        return self.draft.rule(line.value, self.place(line), spot)


_WHOLE = re.compile(r"[0-9]{1,6}")
_PLAIN_SETTINGS = {"rules": 1, "threshold": 0, "comparison": ">="}


def _number(word: str) -> float:
    """Return a word as a number, or NaN if it is invalid."""
    if word in ("inf", "+inf", "-inf"):
        return -inf if word[0] == "-" else inf
    try:
        return float(word) if "_" not in word else nan
    except ValueError:
        return nan
