"""Follows a NAOqi script's statements in order, and collects the curves of its calls to ALMotion."""

import ast
from collections.abc import Iterator, Mapping
from itertools import zip_longest
from typing import Any

from lumen.features.formats_motion.literals import NotWrittenOutError, value_of, written
from lumen.features.formats_motion.naoqi_calls import ALMOTION_CALLS, CALLS, CHAINS, PAUSE, WAIT, is_reading
from lumen.features.formats_motion.statements import (
    Branch,
    FunctionNode,
    OwnFunctions,
    attribute,
    changed_names,
    has_jumps,
    statements,
)
from lumen.language.counts import counted
from lumen.language.diagnostics import Place
from lumen.language.numbers import is_number
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.joint_curves import MAX_NUMBER, BezierHandle, CurvePoint

BEZIER, LINEAR = 3, 1


MAX_STEPS = 20_000
"""The most statements that are followed, since functions can call each other very often."""

MAX_PARTS = 1_000_000
"""The most syntax nodes that are followed beyond the file's own; a long list in a loop counts in each iteration."""


class TooManyStepsError(Exception):
    """A script takes more than MAX_STEPS steps or has too many parts; reading stopped at `place`."""

    def __init__(self, place: Place) -> None:
        super().__init__(str(place))
        self.place = place


class ScriptReading:
    """Follows a script, with its current variables and the curves of its calls so far."""

    def __init__(
        self, file: str, findings: ConversionFindings, tree: ast.Module, own: OwnFunctions, rounds: int
    ) -> None:
        self.file, self.findings, self.own, self.rounds = file, findings, own, rounds
        texts = [node for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        self.named = {node.value: node for node in reversed(texts)}
        self.globals: dict[str, Any] = {}
        self.values = self.last = self.globals
        self.shared: set[str] = set()
        self.sources: dict[str, set[str]] = {}
        self.used: set[str] = set()
        self.changes: list[tuple[frozenset[str], ast.stmt, Branch]] = []
        self.curves: dict[str, list[CurvePoint]] = {}
        self.begin = self.end = 0.0
        self.entered: list[str] = []
        self.returned: dict[int, Any] = {}
        self.steps = self.parts = 0
        self.most_parts = MAX_PARTS + sum(1 for _ in ast.walk(tree))
        self.sizes: dict[int, int] = {}
        self.follows_calls = True
        self.called = False

    def run(self, body: list[ast.stmt], around: Branch = Branch.ALWAYS) -> Any:
        """Follow statements in order; return the value of their `return`, None if it is missing or must be computed.

        Raises TooManyStepsError if they take too many steps.
        """
        for statement, branch in statements(body, around, self._items):
            if isinstance(statement, FunctionNode):
                continue
            self.steps += 1
            self.parts += self._size(statement)
            if self.steps > MAX_STEPS or self.parts > self.most_parts:
                raise TooManyStepsError(self._place(statement))
            if isinstance(statement, ast.ClassDef):
                self.run([inner for inner in statement.body if not isinstance(inner, FunctionNode)], branch)
                continue
            self.take(statement, branch)
            if isinstance(statement, ast.Return) and branch is Branch.ALWAYS:
                return self._value(statement.value) if statement.value else None
        return None

    def _size(self, statement: ast.stmt) -> int:
        """Return the number of syntax nodes in a statement."""
        if id(statement) not in self.sizes:
            self.sizes[id(statement)] = sum(1 for _ in ast.walk(statement))
        return self.sizes[id(statement)]

    def _items(self, loop: ast.For) -> list[ast.expr] | None:
        """Return the values of a loop's variable, one per iteration.

        Return None if they are not literal, too many, or an iteration can end early.
        """
        if has_jumps(loop):
            return None
        rounds: list[ast.expr]
        match loop.iter:
            case ast.List(elts=rounds) | ast.Tuple(elts=rounds):
                pass
            case ast.Call(func=ast.Name(id="range" | "xrange"), args=[_, *_] as args, keywords=[]):
                ends = [self._value(argument) for argument in args]
                if len(ends) > 3 or not all(_is_number(end) and end == int(end) for end in ends) or ends[2:] == [0]:
                    return None
                rounds = [ast.Constant(number) for number in range(*map(int, ends))[: self.rounds + 1]]
            case _:
                values = self._value(loop.iter)
                if not isinstance(values, list):
                    return None
                indices = range(min(len(values), self.rounds + 1))
                rounds = [ast.Subscript(loop.iter, ast.Constant(i), ast.Load()) for i in indices]
        if len(rounds) > self.rounds:
            return None
        for made in (each for each in rounds if not hasattr(each, "lineno")):
            ast.fix_missing_locations(ast.copy_location(made, loop.iter))
        return rounds

    def enter(self, function: FunctionNode, given: Mapping[str, Any], around: Branch = Branch.ALWAYS) -> Any:
        """Follow a function with its own variables; return its result, or None."""
        outer, shared = self.values, self.shared
        self.values, self.shared = {**self.globals, **self._defaults(function), **given}, set()
        self.entered.append(function.name)
        result = self.run(function.body, around)
        self.entered.pop()
        self.last = self.values
        self.values, self.shared = outer, shared
        return result

    def _defaults(self, function: FunctionNode) -> dict[str, Any]:
        """Return the defaults of a function's parameters; a parameter without one is None and hides a global."""
        given = function.args
        names = [argument.arg for argument in (*given.posonlyargs, *given.args)]
        pairs = [*zip(reversed(names), reversed(given.defaults), strict=False)]
        pairs += [(a.arg, d) for a, d in zip(given.kwonlyargs, given.kw_defaults, strict=True) if d]
        return dict.fromkeys(names) | {name: self._value(default) for name, default in pairs}

    def take(self, statement: ast.stmt, branch: Branch) -> None:
        """Follow a statement's calls and literal assignments; record uncertain changes of variables."""
        if isinstance(statement, ast.Global):
            self.shared.update(statement.names)
        changed = changed_names(statement)
        for name in changed:
            self.sources.setdefault(name, set()).update(_names(statement))
        if self.follows_calls:
            calls = [node for node in ast.walk(statement) if isinstance(node, ast.Call)]
            told = {
                id(node) for call in calls if attribute(call) in CALLS.read for a in call.args for node in ast.walk(a)
            }
            for call in sorted(calls, key=lambda node: (node.lineno, node.col_offset)):
                self._called(call, statement, branch, told=id(call) in told)
        followed = branch in (Branch.ALWAYS, Branch.IF) and self._followed(statement)
        if changed and not (followed and branch is Branch.ALWAYS):
            self.changes.append((changed, statement, branch if followed else Branch.LOOP))

    def _called(self, call: ast.Call, statement: ast.stmt, branch: Branch, *, told: bool) -> None:
        """Follow a call, or report that it is left out; `told` is True for an argument of a followed call."""
        name, shown = attribute(call), written(call).partition("\n")[0][:60]
        if name in ALMOTION_CALLS and self.own.called(call) is None:
            self.used.update(name for argument in call.args for name in _names(argument))
            self._call(call, name, branch)
        elif function := self.own.called(call):
            self._own(call, function, statement, branch)
        elif name in (PAUSE, WAIT):
            self._pause(call, name, branch)
        elif name in ("setStiffnesses", "stiffnessInterpolation") and self._is_stiff(call):
            pass  # motors in the simulation are stiff from the beginning
        elif name not in self.own.classes and not is_reading(name) and (name in CALLS.lost or not told):
            for _, hint in CALLS.losses([name]):
                self.findings.lost(self._place(call), f"`{shown}` is left out", hint)

    def _own(self, call: ast.Call, function: FunctionNode, statement: ast.stmt, branch: Branch) -> None:
        """Follow a call of the file's `function`, and store its result; report a recursive call."""
        if function.name in self.entered:
            self.findings.lost(self._place(call), f"`{function.name}` calls itself: it is imported once")
            return
        names = [argument.arg for argument in (*function.args.posonlyargs, *function.args.args)]
        if names[:1] == ["self"]:
            names = names[1:]
        handed = {**dict(zip(names, call.args, strict=False)), **{k.arg: k.value for k in call.keywords if k.arg}}
        for name, argument in handed.items():
            self.sources.setdefault(name, set()).update(_names(argument))
        before = len(self.changes)
        self.returned[id(call)] = self.enter(
            function, {name: self._value(argument) for name, argument in handed.items()}, branch
        )
        for changed, _, how in self.changes[before:]:
            outside = {name for each in changed & handed.keys() for name in _names(handed[each])}
            if outside:
                self.changes.append((frozenset(outside), statement, how))

    def _pause(self, call: ast.Call, name: str, branch: Branch) -> None:
        """Delay all later movements by a pause, or until all earlier ones have ended; report uncertain pauses."""
        if name == WAIT:
            self.begin = max(self.begin, self.end)
            return
        seconds: Any = self._value(call.args[0]) if len(call.args) == 1 else None
        if not _is_number(seconds) or seconds < 0:
            message = f"the pause `{written(call)[:60]}` is left out: its length is known only when the file runs"
            self.findings.lost(self._place(call), message, "write a number")
            return
        if branch is Branch.ELSE:
            self.findings.lost(self._place(call), "a pause in an `else` or `except` is left out")
            return
        if branch is Branch.LOOP:
            self.findings.lost(self._place(call), "this pause is in a loop: it is imported once")
        elif branch is Branch.IF:
            self.findings.changed(self._place(call), "this pause is in an `if`: it is imported without the condition")
        self.begin += float(seconds)

    def _is_stiff(self, call: ast.Call) -> bool:
        """Return whether a call sets motors to full stiffness."""
        stiffness = self._value(call.args[1]) if len(call.args) > 1 else None
        return all(part == 1 for part in (stiffness if isinstance(stiffness, list) else [stiffness]))

    def _value(self, node: ast.expr) -> Any:
        """Return the value of a literal expression or of a followed call, else None."""
        if id(node) in self.returned:
            return self.returned[id(node)]
        try:
            return value_of(node, self.values)
        except NotWrittenOutError:
            return None

    def tell_changes(self) -> None:
        """Report uncertain changes of variables that ALMotion's calls use."""
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
                    self.findings.changed(
                        self._place(statement), f"{told} in an `if`: it is imported without the condition"
                    )
                else:
                    message = f"{told}: the change is left out, since it is known only when the file runs"
                    self.findings.lost(self._place(statement), message, "write the numbers as literals")

    def _followed(self, statement: ast.stmt) -> bool:
        """Follow an assignment or an `append`; return False if the statement can't be followed."""
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
            case ast.Assign(targets=[ast.Tuple(elts=names)], value=value) if all(
                isinstance(n, ast.Name) for n in names
            ):
                values = self._value(value)
                if not isinstance(values, list) or len(values) != len(names):
                    return False
                self.values.update((name.id, one) for name, one in zip(names, values, strict=True))  # type: ignore[attr-defined]
                return True
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="append"), args=[item])) if (
                isinstance(self.values.get(name), list)
            ):
                self._append(name, item)
                return True
        return False

    def play(self, node: ast.AST, names: Any, times: Any, keys: Any) -> None:
        """Add a call's curves, which begin when earlier calls that block have ended; report mismatched lists."""
        self.called = True
        end = begin = self.begin
        joints = [joint for name in (names if isinstance(names, list) else [names]) for joint in _joints(name)]
        rows = _rows(times, keys, len(joints))
        if rows is None or not all(isinstance(joint, str) for joint in joints):
            self.findings.lost(self._place(node), "the names, times and keys of this call do not match")
            return
        for joint, (moments, angles) in zip(joints, rows, strict=True):
            curve = self.curves.setdefault(joint, [])
            if curve and curve[-1].time < begin:  # hold the angle until this call begins
                curve.append(CurvePoint(begin, curve[-1].angle, self._place(node), straight=True))
            for point in self._points(self.named.get(joint, node), joint, moments, angles):
                curve.append(point._replace(time=begin + point.time))
                end = max(end, begin + point.time)
        self.end = max(self.end, end)
        self.begin = begin if _is_posted(node) else end

    def _assign(self, name: str, value: ast.expr) -> None:
        known = self._value(value)
        for variables in (self.values, *([self.globals] if name in self.shared else [])):
            variables.pop(name, None)
            if known is not None:
                variables[name] = known

    def _append(self, name: str, item: ast.expr) -> None:
        try:
            self.values[name].append(value_of(item, self.values))
        except NotWrittenOutError as error:
            self.findings.lost(self._place(error.node), f"`{error}` is known only when the file runs", "write a number")
            self.values[name].append([])

    def _call(self, node: ast.Call, method: str, branch: Branch) -> None:
        arguments = node.args
        if not 3 <= len(arguments) <= 4:
            wanted = ", ".join(ALMOTION_CALLS[method])
            self.findings.lost(
                self._place(node), f"`{method}` has {counted(len(arguments), 'argument')}", f"it needs {wanted}"
            )
            return
        if branch is Branch.ELSE:
            self.findings.lost(self._place(node), "a call in an `else` or `except` is left out")
            return
        if branch is Branch.LOOP:
            self.findings.lost(self._place(node), "this call is in a loop: it is imported once")
        elif branch is Branch.IF:
            self.findings.changed(self._place(node), "this call is in an `if`: it is imported without the condition")
        try:
            values = dict(zip(ALMOTION_CALLS[method], (value_of(a, self.values) for a in arguments), strict=False))
            absolute = value_of(arguments[3], self.values) if len(arguments) > 3 else True
        except NotWrittenOutError as error:
            self.findings.lost(
                self._place(error.node), f"`{error}` is known only when the file runs", "write a literal value"
            )
            return
        if not absolute:
            self.findings.lost(self._place(node), "relative angles can't be imported")
            return
        self.play(node, values["names"], values["times"], values["keys"])

    def _points(self, node: ast.AST, joint: str, times: list[Any], rows: list[Any]) -> Iterator[CurvePoint]:
        left = BEZIER
        for time, row in zip_longest(times, rows):
            angle, *handles = row if isinstance(row, list) and row else [row]
            if not (_is_number(time) and _is_number(angle)):
                self.findings.lost(self._place(node), f"a key of `{joint}` has no time or no angle")
                continue
            kind, into = _handle(handles[0]) if handles else (LINEAR, (0.0, 0.0))
            leaves, out = _handle(handles[1]) if len(handles) > 1 else (kind, (0.0, 0.0))
            if kind not in (BEZIER, LINEAR) or (time != times[0] and left != kind):
                self.findings.changed(
                    self._place(node), f"`{joint}` reaches its key at {time:g} s with an unknown interpolation"
                )
            left = leaves
            yield CurvePoint(float(time), float(angle), self._place(node), kind != BEZIER, into, out)

    def _place(self, node: ast.AST) -> Place:
        line, column = getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1
        same = getattr(node, "end_lineno", line) == line
        return Place(self.file, line, column, line, getattr(node, "end_col_offset", column) + 1 if same else column + 1)


def _joints(name: Any) -> tuple[Any, ...]:
    """Return the joints of a chain, or the joint itself."""
    return CHAINS.get(name, (name,)) if isinstance(name, str) else (name,)


def _rows(times: Any, keys: Any, joints: int) -> list[tuple[list[Any], list[Any]]] | None:
    """Return each joint's times and keys from any form that ALMotion accepts; None if they do not match.

    The forms are one time for all joints, one time or angle per joint, or one list per joint. A single joint can have a
    flat list.
    """
    if times == [] or keys == []:
        return None
    if joints == 1 and isinstance(times, list) and not isinstance(times[0], list):
        return [(times, keys if isinstance(keys, list) else [keys])]
    times = times if isinstance(times, list) else [times] * joints
    keys = keys if isinstance(keys, list) else [keys]
    if not joints or len(times) != joints or len(keys) != joints:
        return None
    return [
        (t if isinstance(t, list) else [t], k if isinstance(k, list) else [k]) for t, k in zip(times, keys, strict=True)
    ]


def _is_posted(node: ast.AST) -> bool:
    """Return whether the script continues during the movement, as for `motion.post.…` or qi's `_async=True`."""
    if not isinstance(node, ast.Call):
        return False
    return ".post." in written(node.func) or any(
        k.arg == "_async" and isinstance(k.value, ast.Constant) and bool(k.value.value) for k in node.keywords
    )


def _handle(handle: Any) -> tuple[int, BezierHandle]:
    """Return a handle's type and (dt [s], da [rad]). An invalid one is LINEAR; all except BEZIER have (0, 0)."""
    if isinstance(handle, list) and len(handle) == 3 and all(_is_number(part) for part in handle):
        return int(handle[0]), ((float(handle[1]), float(handle[2])) if handle[0] == BEZIER else (0.0, 0.0))
    return LINEAR, (0.0, 0.0)


def _names(node: ast.AST) -> set[str]:
    """Return the names of the variables in an expression."""
    return {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}


def _is_number(value: Any) -> bool:
    return is_number(value) and abs(value) < MAX_NUMBER
