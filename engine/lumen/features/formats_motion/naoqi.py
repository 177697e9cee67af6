"""Reads keyframes from Python for NAOqi, exported by Choregraphe or written by hand, without running it.

ALMotion has `angleInterpolationBezier(names, times, keys)`, with keys `[angle, [type, dt, da], [type, dt, da]]`, and
`angleInterpolation(names, angles, times, isAbsolute)`. Times are in [s], angles in [rad]. Statements are followed in
order, and the file's functions at their calls. If the file calls nothing, each function that moves joints, or returns
the lists for a motion, is a separate motion.
"""

import ast
import re
import warnings

from lumen.features.formats_motion.naoqi_script import MAX_STEPS, ScriptReading, TooManyStepsError
from lumen.features.formats_motion.statements import FunctionNode, OwnFunctions, lists_of
from lumen.language.diagnostics import Place, did_you_mean
from lumen.project.formats.conversion_findings import ConversionFindings, broken, decoded
from lumen.project.formats.joint_curves import JointCurves, MotionFile

MAX_ROUNDS = 1_000
"""The most iterations of a loop that are followed."""

_OLD = (
    (re.compile(r"^([ \t]*except[ \t]+[\w.]+),[ \t]*(\w+)[ \t]*:", re.MULTILINE), r"\1 as \2:"),
    (re.compile(r"^([ \t]*)print\b(?![ \t]*\().*", re.MULTILINE), r"\1pass"),
)
"""Patterns for constructs of Python 2, with their replacements for Python 3."""


def read_naoqi(file: MotionFile, findings: ConversionFindings) -> JointCurves:
    """Return the curves that the file, or its function `file.timeline`, passes to ALMotion.

    Raises ForeignFileError if there are none, or if the script is invalid, ambiguous or too long.
    """
    tree = _tree(file.name, decoded(file.name, file.content))
    for rounds in (MAX_ROUNDS, 0):
        found = ConversionFindings()
        try:
            curves = _read(file.name, tree, found, file.timeline, rounds)
        except TooManyStepsError as error:
            if rounds:
                continue
            message = f"the script takes more than {MAX_STEPS:,} steps: its functions may call each other without end"
            raise broken(error.place, "too-large", message) from None
        break
    findings.include(found)
    return curves


def _read(file: str, tree: ast.Module, findings: ConversionFindings, timeline: str, rounds: int) -> JointCurves:
    """Return the curves; a loop with more than `rounds` iterations is followed once."""
    own = OwnFunctions(tree)
    reading = ScriptReading(file, findings, tree, own, rounds)
    function = _chosen(file, tree, own, findings, timeline)
    if function is None:
        reading.run(tree.body)
    else:
        reading.follows_calls = False
        reading.run(tree.body)
        reading.follows_calls = True
        reading.enter(function, {})
    body = function.body if function else tree.body
    if not reading.called and (lists := lists_of(body)) and set(lists) <= reading.last.keys():
        reading.play(body[-1], *(reading.last[name] for name in lists))
        reading.used.update(lists)
    reading.tell_changes()
    if not reading.called:
        hint = "call angleInterpolation or angleInterpolationBezier with literal lists"
        raise broken(Place(file), "not-a-motion", "the file has no keyframes for ALMotion", hint)
    return reading.curves


def _chosen(
    file: str, tree: ast.Module, own: OwnFunctions, findings: ConversionFindings, name: str
) -> FunctionNode | None:
    """Return the function that contains the motion, or None if the module's own statements do.

    Raises ForeignFileError if the function does not exist or is ambiguous.
    """
    gestures = {name: function for name, function in own.all.items() if own.is_gesture(function.body)}
    if name:
        if name not in gestures:
            hint = did_you_mean(name, gestures, "it has")
            raise broken(Place(file), "not-a-motion", f"no function `{name}` moves a joint", hint)
        return gestures[name]
    called = own.reached(tree.body)
    if own.is_gesture(tree.body):
        for other, function in gestures.items():
            if other not in called:
                place = Place(file, function.lineno, function.col_offset + 1)
                message = f"the function `{other}` is left out: the file does not call it"
                findings.changed(place, message, f"to import only this function, pass --timeline {other}")
        return None
    within = {inner for each in gestures for inner in own.reached(gestures[each].body) - {each}}
    roots = [each for each in gestures if each not in within] or list(gestures)
    if len(roots) > 1:
        names = ", ".join(f"`{root}`" for root in roots)
        hint = "choose one: --timeline NAME"
        raise broken(Place(file), "not-a-motion", f"the file has several functions that are motions: {names}", hint)
    return gestures[roots[0]] if roots else None


def _tree(file: str, text: str) -> ast.Module:
    """Return the file's syntax tree; Python 2's `print` and `except` are accepted, since exports contain them.

    Raises ForeignFileError if the file is otherwise invalid.
    """
    for pattern, now in _OLD:
        text = pattern.sub(now, text)
    try:
        with warnings.catch_warnings(action="ignore"):  # about odd numbers and escapes
            return ast.parse(text)
    except SyntaxError as error:
        line, column = error.lineno or 1, error.offset or 1
        place = Place(file, line, column, line, column + 1)
        raise broken(place, "not-a-motion", f"this is not Python: {error.msg}") from None
    except (ValueError, RecursionError, MemoryError):
        raise broken(Place(file), "not-a-motion", "the file can't be read as Python") from None
