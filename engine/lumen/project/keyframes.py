"""Convert the list under `keyframes:` from plain data to one flat motion, with its blocks unrolled."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from lumen.language.added_verbs import arguments_of, durations_of
from lumen.language.commands import Do
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean, has_errors
from lumen.language.durations import duration_hint
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition, skill_cue
from lumen.motion.choreography import at_speed, joined, mirrored, placed
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.document_report import DocumentReport
from lumen.project.poses import PoseReader
from lumen.project.units import BAD_DURATION, seconds

UNKNOWN_MOTION = Code("unknown-motion", "references", ERROR, "the named motion is not in motions/")
HANDLES_WITHOUT_KEY = Code("handles-without-key", "motions", ERROR, "a joint has handles but no angle in this keyframe")
MIXED_KEYFRAME = Code("mixed-keyframe", "motions", ERROR, "a keyframe is both a block and a pose")
MOTION_CYCLE = Code("motion-cycle", "motions", ERROR, "a motion plays itself, directly or through another")
NO_TEMPO = Code("no-tempo", "motions", ERROR, "a motion has beats but no tempo")
NO_TIME = Code("no-time", "motions", ERROR, "a keyframe has no time")
TIME_NOT_INCREASING = Code("time-not-increasing", "motions", ERROR, "a keyframe comes before the one above it")
TOO_MANY_KEYS = Code("too-many-keys", "motions", ERROR, "a motion has too many keys to be played")
TWO_TIMES = Code("two-times", "motions", ERROR, "a keyframe has both a time and a beat")
ZERO_DURATION = Code("zero-duration", "motions", ERROR, "a motion has no length")


MAX_MOTION_KEYS = 200_000
"""The maximum number of keys and cues after unrolling: an hour of dancing with every joint on every beat."""

_CUES = ("say", "sound", "leds", "hold")
KEYFRAME_KEYS = (
    *("at", "beat", "posture", "pose", "roles", "joints", "hands", "interpolation", "handles", "keyframes", "play"),
    *("repeat", "speed", "mirror", *_CUES),
)
"""The keys of a keyframe or block that have a meaning of their own; a skill of such a name can't be begun here."""
_SOON = 1e-9


@dataclass(frozen=True)
class KeyframeReader:
    """Reads the keyframes of one file."""

    report: DocumentReport
    name: str
    poses: PoseReader
    beat: float | None
    """The length of a beat [s], None if the file has no tempo."""
    motions: Mapping[str, MotionDefinition]
    """The motions that `play` may name."""
    broken: Collection[str] = ()
    """Names of motions whose faults were reported in their own files."""
    verbs: OwnVerbs = NO_VERBS
    """The skills that a keyframe may begin."""

    def read(self, items: list[Any], path: NodePath, interpolation: Interpolation) -> MotionDefinition:
        """Return the motion of a list of keyframes and blocks, with times from the beginning of the list [s].

        Items with a faulty time are reported and left out.
        """
        parts: list[tuple[float, MotionDefinition]] = []
        now, moved, count = 0.0, 0.0, 0
        for i, item in enumerate(items):
            here = (*path, i)
            begin = self._moment(item, here)
            if "keyframes" in item or "play" in item:
                begin = now if begin is None else begin
                part = self._block(item, here, interpolation)
            elif begin is None:
                self._no_time(item, here)
                continue
            else:
                part = self._keyframe(item, here, interpolation)
            if begin < now - _SOON or (part.tracks and not part.duration and begin <= moved + _SOON):
                self._too_early(item, here, begin, now)
                continue
            count += _size(part)
            if count > MAX_MOTION_KEYS:
                self._too_many(here)
                break
            parts.append((begin, part))
            now = begin + part.duration
            moved = now if part.tracks else moved
        return joined(parts, now)

    def _keyframe(self, item: Mapping[str, Any], here: NodePath, interpolation: Interpolation) -> MotionDefinition:
        """Return one keyframe as a motion without length: its keys and cues are at time 0.

        Handles without an angle, and keys that are allowed only in a block, are reported.
        """
        how = Interpolation(item.get("interpolation", interpolation))
        handles = self.poses.handles(item, here)
        tracks = {
            joint: (Keyframe(0.0, angle, how, *handles.get(joint, ((0.0, 0.0), (0.0, 0.0))), where),)
            for joint, (angle, where) in self.poses.read(item, here).items()
        }
        for joint in handles.keys() - tracks.keys():
            hint = f"give `{joint}` an angle under `joints`, or delete its handles"
            self.report(
                HANDLES_WITHOUT_KEY,
                (*here, "handles", joint),
                f"`{joint}` has handles here, but no angle",
                hint=hint,
                key=True,
            )
        for word in ("repeat", "speed"):
            if word in item:
                hint = f"put the joints into a block: write them as a list under `keyframes:`, beside `{word}`"
                self.report(MIXED_KEYFRAME, (*here, word), f"`{word}` is allowed only in a block", hint=hint, key=True)
        cues = [Cue(0.0, kind, item[kind], (*here, kind)) for kind in _CUES if kind in item]
        cues += [self._skill(name, item[name], (*here, name)) for name in self._skills_in(item)]
        part = MotionDefinition("", 0.0, tracks, tuple(cues))
        return mirrored(part, self.poses.mirror) if item.get("mirror") is True else part

    def _skills_in(self, item: Mapping[str, Any]) -> list[str]:
        """Return the keys of a keyframe that are skills."""
        return [name for name in item if name not in KEYFRAME_KEYS and name in self.verbs.all]

    def _skill(self, name: str, data: Any, where: NodePath) -> Cue:
        """Return the cue that begins a skill; durations that can't be read are reported.

        Texts are used as they are, because motions have no expressions.
        """
        row = self.verbs.all[name]
        arguments = arguments_of(row, data)
        for argument in durations_of(row):
            text = arguments.get(argument)
            if isinstance(text, str) and seconds(text) is None:
                place = (*where, argument) if isinstance(data, Mapping) else where
                self.report(BAD_DURATION, place, f"`{text}` is not a duration", hint=duration_hint(text))
        return skill_cue(Do(name, arguments), where)

    def _block(self, item: Mapping[str, Any], here: NodePath, interpolation: Interpolation) -> MotionDefinition:
        """Return the motion of a block, or another motion, repeated, scaled and mirrored as the item specifies.

        Keys that are not allowed beside `keyframes` or `play` are reported.
        """
        for word in (
            "joints",
            "roles",
            "hands",
            "posture",
            "pose",
            "handles",
            *_CUES,
            *self._skills_in(item),
            *(("play",) if "keyframes" in item else ()),
        ):
            if word in item:
                hint = "put it into a separate keyframe with its own time"
                what = "`keyframes`" if "keyframes" in item else "`play`"
                self.report(
                    MIXED_KEYFRAME, (*here, word), f"`{word}` is not allowed beside {what}", hint=hint, key=True
                )
        if "play" in item:
            part = self._played(item["play"], here)
        else:
            how = Interpolation(item.get("interpolation", interpolation))
            part = self.read(item["keyframes"], (*here, "keyframes"), how)
        if "speed" in item and self.poses.number(item["speed"], (*here, "speed")):
            part = at_speed(part, item["speed"])
        return self._repeated(part, item.get("repeat", 1), item.get("mirror", False), here)

    def _played(self, name: str, here: NodePath) -> MotionDefinition:
        path = (*here, "play")
        if name in self.motions:
            return placed(self.motions[name], path)
        if name == self.name:
            self.report(MOTION_CYCLE, path, f"`{name}` plays itself", hint="play another motion, or use `repeat`")
        elif name not in self.broken:
            hint = did_you_mean(name, {*self.motions, *self.broken}, "motions/ has")
            self.report(UNKNOWN_MOTION, path, f"there is no motion `{name}`", hint=hint)
        return MotionDefinition(name, 0.0, {})

    def _repeated(self, part: MotionDefinition, times: int, mirror: bool | str, here: NodePath) -> MotionDefinition:
        if times > 1 and part.duration <= 0.0:
            if has_errors(self.report.diagnostics):
                return part  # the part with a length is broken and was reported
            hint = "give its last keyframe a time above 0: that is the length of one repetition"
            self.report(ZERO_DURATION, here, "a repeated block needs a length", hint=hint)
            return part
        if _size(part) * times > MAX_MOTION_KEYS:
            self._too_many(here)
            return part
        other = mirrored(part, self.poses.mirror) if mirror else part
        rounds = [other if mirror is True or (mirror and i % 2) else part for i in range(times)]
        return joined(((i * part.duration, round) for i, round in enumerate(rounds)), part.duration * times)

    def _moment(self, item: Mapping[str, Any], here: NodePath) -> float | None:
        """Return when an item begins, from the beginning of its list [s]; None if it has no usable time.

        Two times, and a `beat` without a `tempo`, are reported.
        """
        if "at" in item and "beat" in item:
            hint = "keep one of them"
            self.report(TWO_TIMES, (*here, "beat"), "a keyframe has `at` or `beat`, not both", hint=hint, key=True)
        if "at" in item:
            return seconds(item["at"])
        if "beat" not in item:
            return None
        if self.beat is None:
            if ("tempo",) in self.report.pruned:
                return None
            hint = "write `tempo: 120` (beats per minute) at the top, or use `at`"
            cause = f"{self.report.document.file} no-tempo"
            message = "`beat` needs the motion's tempo"
            self.report(NO_TEMPO, (*here, "beat"), message, hint=hint, key=True, cause=cause)
            return None
        return item["beat"] * self.beat if self.poses.number(item["beat"], (*here, "beat")) else None

    def _no_time(self, item: Mapping[str, Any], here: NodePath) -> None:
        gone = {(*here, key) for key in ("at", "beat", "keyframes", "play")}
        if "at" not in item and "beat" not in item and not self.report.pruned & gone:
            hint = "write `at: 1.5s`" if self.beat is None else "write `beat: 4` or `at: 1.5s`"
            self.report(NO_TIME, here, "this keyframe has no time", hint=hint)

    def _too_early(self, item: Mapping[str, Any], here: NodePath, begin: float, now: float) -> None:
        path = (*here, "at") if "at" in item else (*here, "beat") if "beat" in item else here
        if begin <= 0.0:
            message, hint = "this keyframe leaves the joints no time to get there", "begin at 0.5s or later"
        else:
            beats = f" (beat {now / self.beat:g})" if self.beat and "beat" in item else ""
            message = f"this keyframe is at {begin:g} s, but the one before it lasts until {now:g} s{beats}"
            hint = "write increasing times, counted from the beginning of the list"
        cause = f"{self.report.document.file} {here[:-1]} until {now}"
        self.report(TIME_NOT_INCREASING, path, message, hint=hint, cause=cause)

    def _too_many(self, here: NodePath) -> None:
        hint = "use fewer keyframes, joints or repetitions"
        self.report(TOO_MANY_KEYS, here, f"the motion would have more than {MAX_MOTION_KEYS:,} keys", hint=hint)


def _size(part: MotionDefinition) -> int:
    return sum(len(keys) for keys in part.tracks.values()) + len(part.cues)
