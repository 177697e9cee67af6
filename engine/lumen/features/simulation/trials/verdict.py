"""Report problems of a simulated motion, each at its keyframe."""

from collections.abc import Callable, Collection, Iterator, Mapping
from math import degrees

from lumen.features.simulation.trials.trial import FALLING_TILT, FELL, MAX_FOOT_SLIDE, CaseResult, Outcome, TimedAmount
from lumen.language.diagnostics import Code, Diagnostic, NodePath, Places
from lumen.language.life import Sway
from lumen.language.motions import Keyframe
from lumen.language.robots import Body
from lumen.lint.on_request import COMES_LATE, FALLS, FEET_SLIDE, NOT_PLAYED, OVERLOADED, SELF_COLLISION, UNSTEADY
from lumen.ports import Live

MAX_CONTACT_TIME = 0.04
"""The longest accepted contact between two links [s]."""

MAX_FULL_TORQUE_TIME = 0.3
"""The longest accepted time of a motor at full torque without a pause [s]."""

MAX_JOINT_LAG = 0.35
"""The largest accepted distance of a joint behind the motion [rad]."""

MAX_LIVING_TILT = 5.0
"""The largest accepted lean of the torso in lifelike movements [degrees]: the shipped styles reach 0.5."""

MAX_FAILED_SHARE = 0.1
"""The largest accepted share of robots that fail a passage at the first attempt: robots retry passages."""

_FEET = {"L": "the left foot", "R": "the right foot"}
_JOINTS = (COMES_LATE, OVERLOADED)


def findings(rehearsal: CaseResult, document: Places, body: Body) -> list[Diagnostic]:
    """Return the findings about the motion of a case, which robots with this body have played.

    `document` holds the places in the motion's file.
    """
    return [*_Judge(rehearsal, document, body).judge()]


class _Judge:
    """Judges the outcomes of one case."""

    def __init__(self, rehearsal: CaseResult, document: Places, body: Body) -> None:
        self._rehearsal, self._case, self._document = rehearsal, rehearsal.case, document
        self._legs = frozenset(role.joint for leg in body.roles.legs.values() for role in leg.values())

    def judge(self) -> Iterator[Diagnostic]:
        """Yield the findings, leaving out the consequences of more serious ones."""
        tried = self._rehearsal.tried
        if not tried:
            return
        failed = [outcome for outcome in tried if not self._rehearsal.succeeded(outcome)]
        if failed:
            yield from self._failure(failed, failed[0] is self._rehearsal.outcomes[0])
        if self._case.passage:
            return
        most = max(tried, key=lambda outcome: outcome.tilt)
        if self._case.living:
            if not failed and most.tilt >= MAX_LIVING_TILT:
                message = f"the torso leans {most.tilt:.0f} deg when the robot lives like this: a push can tip it over"
                yield self._found(
                    UNSTEADY, message, "make the sways smaller or slower", self._keys(most.leaned, self._legs)
                )
            return
        if not failed and most.tilt >= FALLING_TILT:
            message = (
                f"the torso leans {most.tilt:.0f} deg when the robot {self._when()}: at 45 deg, it counts as fallen"
            )
            yield self._found(UNSTEADY, message, "make the robot lean less", self._keys(most.leaned, self._legs))
            return  # further problems are consequences of the lean
        worst = [*self._worst(SELF_COLLISION, lambda o: o.collisions, MAX_CONTACT_TIME)]
        if worst or (failed and failed[0] is self._rehearsal.outcomes[0]):
            yield from worst
            return  # further problems are consequences of the collision or fall
        slides = [*self._worst(FEET_SLIDE, lambda o: o.slid, MAX_FOOT_SLIDE)]
        yield from slides
        spared = self._legs if slides else ()
        late = [*self._worst(COMES_LATE, lambda o: o.behind, MAX_JOINT_LAG, spared)]
        yield from late or self._worst(OVERLOADED, lambda o: o.exhausted, MAX_FULL_TORQUE_TIME, spared)

    def _failure(self, failed: list[Outcome], itself: bool) -> Iterator[Diagnostic]:
        """Report a fall or an unfinished motion: of the unchanged robot (`itself`), or of variants only.

        Report nothing if an accepted share of variants fails a passage.
        """
        worst = failed[0]
        what = "falls" if worst.answer == FELL else f"does not finish: {worst.answer}"
        if worst.answer == "done":
            what = "needs another attempt"
        elif worst.answer != FELL and itself:
            message = f"the robot does not play this {self._case.way}: {worst.answer}"
            yield self._found(NOT_PLAYED, message, "", ())
            return
        if itself and worst.answer == FELL:
            message = f"the robot falls here, at {worst.at:.1f} s, when it {self._when()}"
            hint = "make the motion slower or smaller, or keep the weight over the standing foot"
            yield self._found(FALLS, message, hint, self._keys(worst.at, self._legs))
            return
        tried = len(self._rehearsal.tried)
        if len(failed) <= (MAX_FAILED_SHARE * tried if self._case.passage else 0):
            return
        message = f"{len(failed)} of {tried} slightly different robots {_plural(what)} here"
        if not self._case.passage:
            message += f" when they {self._when(plural=True)}"
        hint = "make it slower or smaller, so that it also works on robots that differ from the model"
        yield self._found(UNSTEADY, message, hint, self._keys(worst.at, self._legs))

    def _worst(
        self,
        code: Code,
        of: Callable[[Outcome], Mapping[str, TimedAmount]],
        limit: float,
        spared: Collection[str] = (),
    ) -> Iterator[Diagnostic]:
        """Report the largest amount at its time, and the other joints or links that reach `limit`; else nothing."""
        tried = self._rehearsal.tried
        beyond = [
            (moment, what)
            for outcome in tried
            for what, moment in of(outcome).items()
            if moment[1] >= limit and (code not in _JOINTS or what in self._case.motion.tracks) and what not in spared
        ]
        if not beyond:
            return
        (at, value), what = max(beyond, key=lambda found: found[0][1])
        others = sorted({other for _, other in beyond} - {what})
        robots = sum(any(m[1] >= limit for m in of(outcome).values()) for outcome in tried)
        message, hint = _words(code, what, at, value)
        message += f", also {', '.join(map(_name, others))}" if others else ""
        message += f" (with {robots} of {len(tried)} robots)" if robots < len(tried) else ""
        joints = (what,) if code in _JOINTS else self._legs if code == FEET_SLIDE else ()
        yield self._found(code, message, hint, self._keys(at, joints))

    def _when(self, *, plural: bool = False) -> str:
        """Return the robot's activity in words, such as `plays this from Stand` or `lives like this`."""
        if self._case.living:
            return "live like this" if plural else "lives like this"
        return f"{'play' if plural else 'plays'} this {self._case.way}"

    def _keys(self, at: float, joints: Collection[str]) -> NodePath:
        """Return the path of the keyframe to which the robot was moving at `at` [s], if possible of one of `joints`.

        For a style of life, return the path of the sway that moves the legs fastest, or, without legs, all joints. The
        path is empty if there is no keyframe or sway.
        """
        if isinstance(self._case.command, Live):
            sways = self._case.command.style.sways
            return max(sways, key=self._shaking).where if sways else ()
        tracks = self._case.motion.tracks
        chosen = [keys for name, keys in tracks.items() if name in joints] or list(tracks.values())
        coming = [key for keys in chosen for key in keys if key.time >= at - 1e-9]
        keys = sorted(coming or [keys[-1] for keys in chosen], key=lambda key: key.time)
        return _keyframe(keys[0]) if keys else ()

    def _shaking(self, sway: Sway) -> tuple[float, float]:
        """Return a sway's summed amplitudes per period [rad/s], of leg joints and of all joints; larger is riskier."""
        legs = sum(abs(angle) for joint, angle in sway.joints.items() if joint in self._legs)
        return legs / sway.period, sum(map(abs, sway.joints.values())) / sway.period

    def _found(self, code: Code, message: str, hint: str, path: NodePath) -> Diagnostic:
        return code.at(self._document.place(path, key=self._case.living), message, hint)


def _words(code: Code, what: str, at: float, value: float) -> tuple[str, str]:
    """Return the message and the hint of a finding about a joint, foot or pair of links."""
    if code == SELF_COLLISION:
        message = f"{what} collide here, at {at:.1f} s, for {value:.1f} s"
        return message, "move one of them around the other: add a keyframe in between, or use a wider pose"
    if code == FEET_SLIDE:
        message = f"{_name(what)} slides {100 * value:.1f} cm while it bears load, from {at:.1f} s"
        return message, "keep the soles flat and the hips between the feet, or lift the foot"
    if code == COMES_LATE:
        message = f"{_name(what)} is {degrees(value):.0f} deg behind here, at {at:.1f} s: its motor can't keep up"
        return message, "give it more time, or less weight to move"
    message = f"the motor of {_name(what)} is at its limit here, from {at:.1f} s, for {value:.1f} s"
    return message, "make the motion slower, or put less weight on the joint, so that the motor stays cool and keeps up"


def _name(what: str) -> str:
    return _FEET.get(what, what if " " in what else f"`{what}`")


def _keyframe(key: Keyframe) -> NodePath:
    """Return the path of a key's keyframe: the innermost item of a list of keyframes, or `return`."""
    last = max((i for i, step in enumerate(key.where) if step == "keyframes"), default=None)
    if last == len(key.where) - 1:
        return ("return",)
    return key.where if last is None else key.where[: last + 2]


def _plural(what: str) -> str:
    verb, _, rest = what.partition(" ")
    return f"{ {'falls': 'fall', 'needs': 'need', 'does': 'do'}[verb] } {rest}".strip()
