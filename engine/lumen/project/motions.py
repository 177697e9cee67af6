"""Build a motion from the plain data of a motion file, `motions/NAME.yaml`."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import fields
from functools import partial
from graphlib import CycleError, TopologicalSorter
from typing import Any

from lumen.language.diagnostics import NodePath, has_errors
from lumen.language.motions import Interpolation, MotionDefinition
from lumen.language.robots import Body
from lumen.motion.choreography import at_speed, mirrored, returning, trailing
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.built_file import unless_too_deep
from lumen.project.document_report import DocumentReport
from lumen.project.keyframes import MOTION_CYCLE, TOO_MANY_KEYS, ZERO_DURATION, KeyframeReader
from lumen.project.poses import PoseReader
from lumen.project.units import joint_units, seconds

DEFAULT_POSTURE = "Stand"
"""The posture in which a motion begins if its file does not name one."""

MAX_KEYFRAMES = 20_000
"""The maximum length of a list of keyframes; the schema has the same limit, but checks every keyframe first."""


def build_motion(
    data: Any,
    report: DocumentReport,
    *,
    name: str,
    body: Body,
    motions: Mapping[str, MotionDefinition] | None = None,
    broken: Collection[str] = (),
    verbs: OwnVerbs = NO_VERBS,
) -> MotionDefinition | None:
    """Return the motion that the data of `motions/NAME.yaml` describes; None if it has no length or can't be built.

    `motions` are those that it may `play`, built before it. `broken` are names of motions whose absence is not
    reported, because their own files have faults. `verbs` are the skills that it may begin.
    """
    if not isinstance(data, Mapping) or not data.get("keyframes"):
        return None
    if report.broken(("units",)):
        return None
    poses = PoseReader(report, body, joint_units(data))
    poses.define(data.get("poses") or {}, ("poses",))
    tempo = data.get("tempo")
    beat = 60.0 / tempo if tempo and poses.number(tempo, ("tempo",)) else None
    reader = KeyframeReader(report, name, poses, beat, motions or {}, broken, verbs)
    how = Interpolation(data.get("interpolation", Interpolation.MINIMUM_JERK))
    part = reader.read(data["keyframes"], ("keyframes",), how)
    poses.roles.tell_left_out("this motion")
    if part.duration <= 0.0:
        if not has_errors(report.diagnostics):
            hint = "give its last keyframe a time above 0"
            report(ZERO_DURATION, ("keyframes",), "the motion has no length", hint=hint, key=True)
        return None
    return _finished(part, data, poses, name)


def build_motions(
    files: Mapping[str, tuple[Any, DocumentReport]],
    body: Body,
    verbs: OwnVerbs = NO_VERBS,
) -> dict[str, MotionDefinition]:
    """Return every motion of a project that can be built, from the data and the report of each by its name.

    Motions are built after those that they play; if they form a circle, the play that closes it is reported.
    """
    plays = {name: dict(_played(data)) for name, (data, _) in files.items()}
    order, circles = _order({name: [p for p in played if p in files and p != name] for name, played in plays.items()})
    for name, other in circles:
        message = f"`{name}` plays `{other}`, which plays `{name}`"
        files[name][1](MOTION_CYCLE, plays[name][other], message, hint="make one of them play another motion")
    built: dict[str, MotionDefinition] = {}
    for name in order:
        data, report = files[name]
        known = None if files.keys() >= plays[name].keys() else [*files]  # they are in the hint for an unknown motion
        given = (body, verbs, {played: (built.get(played), played in files) for played in plays[name]}, known)
        build = partial(
            build_motion, data, report, name=name, body=body, motions=built, broken=files.keys(), verbs=verbs
        )
        motion = report.memoize(("motion", report.document.file), given, partial(unless_too_deep, report, build))
        if motion is not None:
            built[name] = motion
    return {name: built[name] for name in files if name in built}


def countable(data: Any, report: DocumentReport) -> bool:
    """Return True if the data has at most `MAX_KEYFRAMES` keyframes; report it if there are more."""
    if not isinstance(data, Mapping) or not isinstance(data.get("keyframes"), list):
        return True
    if len(data["keyframes"]) <= MAX_KEYFRAMES:
        return True
    hint = f"write at most {MAX_KEYFRAMES:,}; use blocks with `repeat`, or several motions"
    report(
        TOO_MANY_KEYS,
        ("keyframes",),
        f"{len(data['keyframes']):,} keyframes are too many for one list",
        hint=hint,
        key=True,
    )
    return False


def _finished(part: MotionDefinition, data: Mapping[str, Any], poses: PoseReader, name: str) -> MotionDefinition:
    """Return the whole motion, with trailing joints, speed, mirroring, return to its end posture, and origin."""
    part = trailing(part, poses.lags(data.get("trails") or {}, ("trails",)))
    if "speed" in data and poses.number(data["speed"], ("speed",)):
        part = at_speed(part, data["speed"])
    part = mirrored(part, poses.mirror) if data.get("mirror") else part
    start = data.get("start", DEFAULT_POSTURE if DEFAULT_POSTURE in poses.body.postures else None)
    end = data.get("end", start)
    origin = (poses.posture(start, ("start",)) if start else None) or {}
    home = origin if end == start else (poses.posture(end, ("end",)) if end else None) or {}
    part = returning(part, home, seconds(data.get("return")) or 1.0, ("end",) if "end" in data else ("keyframes",))
    values = {f.name: getattr(part, f.name) for f in fields(MotionDefinition)}
    values |= {"name": name, "start": start or "", "end": end or ""}
    values["origin"] = {joint: origin[joint] for joint in part.tracks if joint in origin}
    return MotionDefinition(**values)


def _played(data: Any) -> Iterator[tuple[str, NodePath]]:
    """Yield the name of every motion that a file plays, with its path."""
    waiting: list[tuple[Any, NodePath]] = [(data, ())]
    while waiting:
        item, path = waiting.pop()
        if isinstance(item, Mapping):
            if isinstance(item.get("play"), str):
                yield item["play"], (*path, "play")
            if isinstance(item.get("keyframes"), list):
                waiting.extend((child, (*path, "keyframes", i)) for i, child in enumerate(item["keyframes"]))


def _order(plays: dict[str, list[str]]) -> tuple[list[str], list[tuple[str, str]]]:
    """Return the names, each after those that it plays, and the pairs that were removed because they close a circle."""
    circles: list[tuple[str, str]] = []
    while True:
        try:
            return list(TopologicalSorter(plays).static_order()), circles
        except CycleError as error:
            played, player = error.args[1][:2]  # each name in the list is played by the next
            plays[player].remove(played)
            circles.append((player, played))
