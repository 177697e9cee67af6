"""The signature of the function whose call contains the cursor in an expression."""

import inspect
import re
from typing import NamedTuple

from lumen.expressions.function_table import fault_of, functions
from lumen.feature import resolve, table
from lumen.features.editor.analysis import Analysis
from lumen.language.functions import FunctionDefinition
from lumen.language.text_lines import lines_of

_OPEN = re.compile(r"(\w+)\s*\($")
_TEXT = re.compile(r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\"")


class FunctionSignature(NamedTuple):
    """The signature of a called function."""

    name: str
    parameters: tuple[str, ...]
    active: int
    """The index of the parameter that is being written."""
    documentation: str
    """A description of the function and of its result."""

    @property
    def label(self) -> str:
        """The signature as text."""
        return f"{self.name}({', '.join(self.parameters)})"


def signature(analysis: Analysis, file: str, line: int, column: int) -> FunctionSignature | None:
    """Return the signature of the innermost call open at a line and column, counted from 1; None if there is none."""
    lines = lines_of(analysis.text(file))
    head = lines[line - 1][: column - 1] if line <= len(lines) else ""
    head = _TEXT.sub(lambda found: "_" * len(found[0]), re.sub(r"'[^']*$", "_", head) if head.count("'") % 2 else head)
    depth = commas = 0
    for at in range(len(head) - 1, -1, -1):
        sign = head[at]
        if sign in ")]}":
            depth += 1
        elif sign in "([{" and depth:
            depth -= 1
        elif sign == "," and not depth:
            commas += 1
        elif sign == "(" and (called := _OPEN.search(head[: at + 1])) and called[1] in functions():
            return _of(called[1], commas)
        elif sign == "(" and called and called[1] in analysis.draft.functions:
            return _of_project(analysis, analysis.draft.functions[called[1]], commas)
        elif sign in "([{":
            commas = 0
    return None


def _of_project(analysis: Analysis, function: FunctionDefinition, active: int) -> FunctionSignature:
    """Return the signature of one of the project's functions, described in the project's first language."""
    settings = analysis.draft.settings
    shown = tuple(f"{name}: {' or '.join(kinds)}" for name, kinds in function.parameters.items())
    gives = " or ".join(function.returns) if len(function.returns) < 4 else "anything"
    says = function.described(settings.languages[0] if settings and settings.languages else "")
    return FunctionSignature(function.name, shown, active, f"{says} Returns {gives}.".strip())


def _of(name: str, active: int) -> FunctionSignature:
    function = functions()[name]
    call = (lambda: None) if fault_of(name) else resolve(table("functions")[name].call)
    named = list(inspect.signature(call).parameters)[1 if function.scoped else 0 :]
    kinds = [" or ".join(sorted(kinds)) if len(kinds) < 4 else "anything" for kinds in function.parameters]
    shown = tuple(f"{parameter}: {kind}" for parameter, kind in zip(named, kinds, strict=False))
    says = (inspect.getdoc(call) or "").partition("\n\n")[0]
    gives = " or ".join(sorted(function.returns)) if len(function.returns) < 4 else "anything"
    return FunctionSignature(name, shown, active, f"{says} Returns {gives}.".strip())
