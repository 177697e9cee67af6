"""The robot's idle life beneath its commands: small movements of the joints that nothing else moves.

Commands are not affected: its offsets are added to the targets of joints, and withdrawn when a command begins.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from math import inf

from lumen.language.body_parts import ARMS, BODY, HEAD, LEGS, part_of
from lumen.language.commands import Say
from lumen.language.gestures import WordTime
from lumen.language.life import STILL_STYLE, LifeStyle
from lumen.language.robots import Body
from lumen.language.roles import HEAD_ROLES
from lumen.motion.life import (
    SPEED_SHARE,
    Attention,
    aside,
    eyes_closed,
    glance,
    look_towards,
    nod,
    settle,
    sway,
)
from lumen.motion.life.movements import TOUCHED
from lumen.ports import Live
from lumen.robot.gesture_player import GesturePlayer
from lumen.robot.joint_offsets import approach

LIFE_PERIOD = 0.04
"""The time between two computations of the joints' targets [s]; joints move evenly in between."""

SETTLING = 0.25
"""The time constant with which joints follow a movement that begins or ends abruptly [s]."""

LED_FOR = 1.0
"""After an aim, the head stays under external control for this long [s]."""

ANSWER_PAUSE = 1.0
"""A text counts as an answer after this much silence [s]."""

HEARD_TURN, HEARD_NOD = 1.0, 0.3
"""The largest turn and nod towards a sound [rad]."""


class LifeLayer:
    """The offset of each joint from the target of the commands [rad; hands 0..1].

    The offsets depend only on the seed, and on the times and calls since the beginning. The state is the style, the
    last cause of attention, the time of the last aim of the head, the last text and its time, the time at which each
    part became free, and the present offsets of the joints. `offsets` has the last values; any thread may read it.
    """

    def __init__(self, body: Body, seed: int = 0) -> None:
        self.style: LifeStyle = STILL_STYLE
        self._seed, self._part = seed, part_of(body)
        self._turns = {role: turn for role, turn in body.roles.head.items() if role in HEAD_ROLES}
        self._speeds = {joint.name: SPEED_SHARE * joint.speed for joint in body.joints.values()}
        self._attention: Attention | None = None
        self._led_at = -LED_FOR
        self._answers, self._answered_at, self._said_until = 0, -inf, -inf
        self._free_since: dict[str, float] = {}
        self._wanted: Mapping[str, float] = {}
        self._computed: tuple[float, object] = (-LIFE_PERIOD, None)
        self._offsets: dict[str, float] = {}
        self.offsets: Mapping[str, float] = {}
        self.speech = GesturePlayer(body, seed)

    def live(self, command: Live) -> None:
        """Use the style and the gestures of this command from now on."""
        self.style, self.speech.library = command.style, command.gestures

    def touched(self, sensor: str, now: float) -> None:
        """Look towards a sensor that was touched at `now` [s], if the style has attention; ignore unknown sensors."""
        if sensor in TOUCHED:
            self._attention = Attention(*TOUCHED[sensor], now)

    def heard(self, yaw: float, pitch: float, now: float) -> None:
        """Look towards a sound at `yaw` to the left and `pitch` below the direction of the head's commands [rad].

        While the robot speaks, it ignores sounds: it would hear itself.
        """
        if now >= self._said_until:
            before = self._attention or Attention(0.0, 0.0, -inf)
            yaw, pitch = max(-HEARD_TURN, min(HEARD_TURN, yaw)), max(-HEARD_NOD, min(HEARD_NOD, pitch))
            self._attention = before.again(yaw, pitch, self.style.attention, now)

    def heard_by_head(self, yaw: float, pitch: float, now: float) -> None:
        """Do what `heard` does, relative to the measured direction of the head: its microphones turn with it."""
        turned = {
            role: self._turns[role].sign * self._offsets.get(self._turns[role].joint, 0.0)
            for role in HEAD_ROLES
            if role in self._turns
        }
        self.heard(yaw + turned.get("yaw", 0.0), pitch + turned.get("pitch", 0.0), now)

    def say(self, said: Say, duration: float, now: float, words: Sequence[WordTime] = ()) -> None:
        """Record that a text of `duration` [s] begins; `words` has the time at which each word begins, if known."""
        if now >= self._said_until + ANSWER_PAUSE:
            self._answers, self._answered_at = self._answers + 1, now
        self._said_until = now + duration
        self.speech.say(said, duration, now, words)

    def hush(self, now: float) -> None:
        """Record that the speech has ended."""
        self._said_until = min(self._said_until, now)
        self.speech.hush(now)

    def led(self, joints: Collection[str], now: float) -> None:
        """Record an external aim of these joints; one of the head keeps life from moving the head for LED_FOR [s]."""
        if any(turn.joint in joints for turn in self._turns.values()):
            self._led_at = now

    def leading(self, now: float) -> bool:
        """Return True while an external aim controls the head at `now` [s]."""
        return now < self._led_at + LED_FOR

    def still(self) -> None:
        """Drop all offsets, because the motors are off."""
        self._offsets.clear()
        self.offsets = {}
        self._free_since.clear()
        self.speech.still()

    def advance(
        self, now: float, dt: float, free: Collection[str], vigour: Callable[[str], float]
    ) -> Mapping[str, float]:
        """Return the offsets at `now` [s], `dt` [s] after the last ones; see `wanted`."""
        computed, found = self._computed
        if now >= computed + LIFE_PERIOD or found != (free, self.style):
            self._wanted, self._computed = self.wanted(now, free, vigour), (now, (free, self.style))
        approach(self._offsets, self._wanted, self._speeds, dt, SETTLING)
        free = {HEAD, ARMS} & set(free) if LEGS in free else set()
        gestures = self.speech.advance(now, dt, free)
        whole = self._offsets.keys() | gestures.keys()
        self.offsets = {j: self._offsets.get(j, 0.0) + gestures.get(j, 0.0) for j in whole}
        return self.offsets

    def wanted(self, now: float, free: Collection[str], vigour: Callable[[str], float]) -> dict[str, float]:
        """Return the goals of the offsets at `now` [s], to which `advance` moves them smoothly.

        `free` are the parts of the body that nothing else moves; `vigour` returns how lively each may be (0 to 1). Arms
        and legs move only if the legs are free, too: a robot that walks or sits down needs all of its balance.
        """
        alive = {part for part in free if part == HEAD or LEGS in free}
        found = {j: angle for j, angle in sway(self.style, self._seed, now).items() if self._part.get(j) in alive}
        self._free_since = {part: self._free_since.get(part, now) for part in alive}
        for joint, angle in self._settled(now):
            found[joint] = found.get(joint, 0.0) + angle
        if HEAD in alive:
            for role, angle in zip(HEAD_ROLES, self._head(now), strict=True):
                if turn := self._turns.get(role):
                    found[turn.joint] = found.get(turn.joint, 0.0) + turn.sign * angle
        levels = {part: vigour(part) for part in (HEAD, ARMS, LEGS, BODY) if part in alive}
        return {joint: angle * levels[self._part[joint]] for joint, angle in found.items()}

    def eyes(self, now: float) -> str:
        """Return the colour of the eyes at `now` [s]: `off` during a blink, empty if they stay as they are."""
        blinks, colours = self.style.blinks, self.style.eyes
        if blinks and eyes_closed(blinks, self._seed, now):
            return "off"
        if any(self._aside(now)):
            return colours.thinking
        return colours.speaking if now < self._said_until else colours.silent

    def _settled(self, now: float) -> Iterator[tuple[str, float]]:
        """Yield how far each joint has sunk since its part became free [rad]."""
        settles = self.style.settles
        for part, since in self._free_since.items() if settles else ():
            sunk = settle(settles, now - since) if settles else {}
            yield from ((joint, angle) for joint, angle in sunk.items() if self._part.get(joint) == part)

    def _aside(self, now: float) -> tuple[float, float]:
        """Return how far the head turns and tilts away before an answer [rad]."""
        asides, since = self.style.asides, now - self._answered_at
        return aside(asides, self._seed, self._answers, since) if asides else (0.0, 0.0)

    def _head(self, now: float) -> tuple[float, float]:
        """Return the turn and tilt of the head [rad]; the head nods only while the robot does not speak."""
        style = self.style
        down = nod(style.nods, self._seed, now) if style.nods and now >= self._said_until else 0.0
        yaw, pitch = self._aside(now)
        if not (yaw or pitch):
            yaw, pitch = look_towards(self._attention, style.attention, now)
        if style.glances and not (yaw or pitch):
            yaw, pitch = glance(style.glances, self._seed, now)
        return yaw, pitch + down
