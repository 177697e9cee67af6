"""Keyframes that Choregraphe exports as Python: read, never run.

NAOqi's ALMotion: `angleInterpolationBezier(names, times, keys)`, each key `[angle, [type, dt, da], [type, dt, da]]`,
and `angleInterpolation(names, angles, times, isAbsolute)`; times in [s], angles in [rad].
"""

import ast
import re
from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

from lumen.formats.conversion_findings import ConversionFindings, broken
from lumen.formats.gestures.joint_curves import BezierHandle, CurvePoint, JointCurves
from lumen.formats.gestures.literals import MAX_NUMBER, NotWrittenOutError, value_of, written
from lumen.formats.gestures.statements import Branch, changed_names, functions_of, statements
from lumen.language.diagnostics import Place

ALMOTION_CALLS = {
    "angleInterpolationBezier": ("names", "times", "keys"),
    "angleInterpolation": ("names", "keys", "times"),
}
BEZIER, LINEAR = 3, 1

_OLD = (
    (re.compile(r"^([ \t]*except[ \t]+[\w.]+),[ \t]*(\w+)[ \t]*:", re.MULTILINE), r"\1 as \2:"),
    (re.compile(r"^([ \t]*)print\b(?![ \t]*\().*", re.MULTILINE), r"\1pass"),
)
"""What Python 2 wrote otherwise, and how it is read."""


def read_naoqi(file: str, text: str, findings: ConversionFindings) -> JointCurves:
    """The curves that the file hands to ALMotion. Raises ForeignFileError where it hands it none."""
    tree = _tree(file, text)
    reading = _Reading(file, findings, tree)
    for statement, branch in statements(tree):
        reading.take(statement, branch)
    reading.tell_changes()
    if not reading.called and {"names", "times", "keys"} <= reading.values.keys():
        reading.play(tree.body[-1], *(reading.values[name] for name in ("names", "times", "keys")))
    if not reading.called:
        hint = "it should call angleInterpolation or angleInterpolationBezier with lists that are written out"
        raise broken(Place(file), "not-a-motion", "no keyframes for ALMotion stand in it", hint)
    return reading.curves


def _tree(file: str, text: str) -> ast.Module:
    """The file's syntax tree; two statements of Python 2 that every export has are let pass."""
    for pattern, now in _OLD:
        text = pattern.sub(now, text)
    try:
        return ast.parse(text)
    except SyntaxError as error:
        line, column = error.lineno or 1, error.offset or 1
        place = Place(file, line, column, line, column + 1)
        raise broken(place, "not-a-motion", f"this is not Python: {error.msg}") from None
    except (ValueError, RecursionError, MemoryError):
        raise broken(Place(file), "not-a-motion", "this is not Python that can be read") from None


class _Reading:
    """The variables so far, and the curves of the calls."""

    def __init__(self, file: str, findings: ConversionFindings, tree: ast.Module) -> None:
        self.file, self.findings = file, findings
        texts = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        self.named = {node.value: node for node in reversed(texts)}
        self.functions = functions_of(tree)
        self.values: dict[str, Any] = {}
        self.sources: dict[str, set[str]] = {}
        self.used: set[str] = {"names", "times", "keys"}
        self.changes: list[tuple[frozenset[str], ast.stmt, Branch]] = []
        self.curves: dict[str, list[CurvePoint]] = {}
        self.begin = 0.0
        self.called = False

    def take(self, statement: ast.stmt, branch: Branch) -> None:
        """Follow what is written out; remember what changes a variable in another way."""
        changed = changed_names(statement, self.functions)
        for name in changed:
            self.sources.setdefault(name, set()).update(_names(statement))
        calls = sorted(
            (node for node in ast.walk(statement) if isinstance(node, ast.Call)),
            key=lambda node: (node.lineno, node.col_offset),
        )
        followed = branch in (Branch.ALWAYS, Branch.IF) and self._followed(statement)
        if changed and not (followed and branch is Branch.ALWAYS):
            self.changes.append((changed, statement, branch if followed else Branch.LOOP))
        for call in calls:
            match call:
                case ast.Call(func=ast.Attribute(attr=method), args=arguments) if (
                    method in ALMOTION_CALLS and len(arguments) >= 3
                ):
                    self.used.update(name for argument in arguments for name in _names(argument))
                    self._call(call, method, arguments, branch)

    def tell_changes(self) -> None:
        """Report what changes a variable that a call uses, and can't be known without running the file."""
        used, waiting = set(), list(self.used)
        while waiting:
            name = waiting.pop()
            if name not in used:
                used.add(name)
                waiting += self.sources.get(name, ())
        for names, statement, branch in self.changes:
            if found := sorted(names & used):
                shown = written(statement).partition("\n")[0][:60]
                told = f"`{shown}` changes `{found[0]}`"
                if branch is Branch.IF:
                    self.findings.changed(self._place(statement), f"{told} in an `if`: here it always does")
                else:
                    message = f"{told} in a way that is known only when the file runs: it is left out"
                    self.findings.lost(self._place(statement), message, "write the numbers out")

    def _followed(self, statement: ast.stmt) -> bool:
        """Carry out an assignment or an `append` of what is written out; whether the statement is no more than that."""
        match statement:
            case ast.Assign(targets=targets, value=value) if all(isinstance(t, ast.Name) for t in targets):
                for target in targets:
                    self._assign(target.id, value)  # type: ignore[attr-defined]
                return True
            case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)) if len(names) == len(
                values
            ) and all(isinstance(name, ast.Name) for name in names):
                for name, value in zip(names, values, strict=True):
                    self._assign(name.id, value)  # type: ignore[attr-defined]
                return True
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="append"), args=[item])) if (
                isinstance(self.values.get(name), list)
            ):
                self._append(name, item)
                return True
        return False

    def play(self, node: ast.AST, names: Any, times: Any, keys: Any) -> None:
        """Add the curves of one call, which begins when those before it have ended."""
        self.called = True
        end = begin = self.begin
        names, times, keys = (value if isinstance(value, list) else [value] for value in (names, times, keys))
        if len(names) == 1 and times and not isinstance(times[0], list):
            times, keys = [times], [keys]
        for joint, moments, rows in zip_longest(names, times, keys):
            if not (isinstance(joint, str) and isinstance(moments, list) and isinstance(rows, list)):
                self.findings.lost(self._place(node), "names, times and keys do not fit together")
                return
            for point in self._points(self.named.get(joint, node), joint, moments, rows):
                self.curves.setdefault(joint, []).append(point._replace(time=begin + point.time))
                end = max(end, begin + point.time)
        self.begin = begin if ".post." in written(node) else end

    def _assign(self, name: str, value: ast.expr) -> None:
        try:
            self.values[name] = value_of(value, self.values)
        except NotWrittenOutError:
            self.values.pop(name, None)

    def _append(self, name: str, item: ast.expr) -> None:
        try:
            self.values[name].append(value_of(item, self.values))
        except NotWrittenOutError as error:
            self.findings.lost(self._place(error.node), f"`{error}` is known only when the file runs", "write a number")
            self.values[name].append([])

    def _call(self, node: ast.Call, method: str, arguments: list[ast.expr], branch: Branch) -> None:
        if branch is Branch.ELSE:
            self.findings.lost(self._place(node), "what an `else` does is left out")
            return
        if branch is Branch.LOOP:
            self.findings.lost(self._place(node), "this is in a loop: here the robot does it once")
        elif branch is Branch.IF:
            self.findings.changed(self._place(node), "this is in an `if`: here the robot always does it")
        try:
            values = dict(zip(ALMOTION_CALLS[method], (value_of(a, self.values) for a in arguments), strict=False))
            absolute = value_of(arguments[3], self.values) if len(arguments) > 3 else True
        except NotWrittenOutError as error:
            self.findings.lost(self._place(error.node), f"`{error}` is known only when the file runs", "write it out")
            return
        if not absolute:
            self.findings.lost(self._place(node), "angles relative to where the robot stands are not read")
            return
        self.play(node, values["names"], values["times"], values["keys"])

    def _points(self, node: ast.AST, joint: str, times: list[Any], rows: list[Any]) -> Iterator[CurvePoint]:
        for time, row in zip_longest(times, rows):
            angle, *handles = row if isinstance(row, list) and row else [row]
            if not (_is_number(time) and _is_number(angle)):
                self.findings.lost(self._place(node), f"a key of `{joint}` has no time or no angle")
                continue
            kind, into = _handle(handles[0]) if handles else (LINEAR, (0.0, 0.0))
            out = _handle(handles[1])[1] if len(handles) > 1 else (0.0, 0.0)
            if kind not in (BEZIER, LINEAR):
                self.findings.changed(
                    self._place(node), f"`{joint}` comes to {time:g} s in a way that is not known here"
                )
            yield CurvePoint(float(time), float(angle), self._place(node), kind != BEZIER, into, out)

    def _place(self, node: ast.AST) -> Place:
        line, column = getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1
        same = getattr(node, "end_lineno", line) == line
        return Place(self.file, line, column, line, getattr(node, "end_col_offset", column) + 1 if same else column + 1)


def _handle(handle: Any) -> tuple[int, BezierHandle]:
    """The type and (dt [s], da [rad]) of a handle."""
    if isinstance(handle, list) and len(handle) == 3 and all(_is_number(part) for part in handle):
        return int(handle[0]), ((float(handle[1]), float(handle[2])) if handle[0] == BEZIER else (0.0, 0.0))
    return LINEAR, (0.0, 0.0)


def _names(node: ast.AST) -> set[str]:
    """The variables that stand in it."""
    return {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < MAX_NUMBER
