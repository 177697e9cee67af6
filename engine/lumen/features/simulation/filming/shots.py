"""The shots of a film's camera: the robot with its visitor, the robot's face, the whole robot, or the visitor's view.

Events choose the shot, as an editor cuts a dialogue: mostly the speaker, sometimes the listener, each long enough to
be seen.
"""

from enum import StrEnum
from math import atan2, cos, degrees, hypot, radians, sin, tan
from typing import NamedTuple

HallPoint = tuple[float, float, float]
"""A point of the hall: x, y, z [m]."""


class Shot(StrEnum):
    """The shots, by their names in film making."""

    TWO_SHOT = "two-shot"
    CLOSE_UP = "close-up"
    FULL_SHOT = "full shot"
    POINT_OF_VIEW = "point of view"


class FilmMoment(StrEnum):
    """Events that may change the shot."""

    COMES = "comes"
    LEAVES = "leaves"
    ROBOT_SPEAKS = "robot speaks"
    VISITOR_SPEAKS = "visitor speaks"
    ROBOT_MOVES = "robot moves"


class Subjects(NamedTuple):
    """The positions of the robot and the visitor, for choosing the camera's place."""

    head: HallPoint
    """The position of the robot's head in the hall [m]."""
    torso: HallPoint
    """The position of the robot's torso in the hall [m]."""
    heading: float
    """The direction that the robot faces in the hall [rad]."""
    visitor: HallPoint | None
    """The position of the visitor's face in the hall [m]; None without a visitor."""


class CameraPlace(NamedTuple):
    """The camera's position and the point at the centre of its picture [m]."""

    eye: HallPoint
    target: HallPoint


SHORTEST_SHOT, LONGEST_SHOT = 2.5, 9.0
"""A shot's minimum duration, and the time after which it changes without an event if a visitor is present [s]."""

FIELD_OF_VIEW = 36.0
"""The vertical angle of view [deg], of a long lens without visible distortion."""

HEAD_ROOM, CLOSE_DISTANCE, FULL_DISTANCE = 0.45, 0.62, 1.75
SIDE = radians(-32.0)
"""The angle from the robot's heading to a camera in front of the robot [rad], on the open side of the hall."""

_WANTED = {
    FilmMoment.COMES: (Shot.TWO_SHOT,),
    FilmMoment.LEAVES: (Shot.TWO_SHOT,),
    FilmMoment.ROBOT_SPEAKS: (Shot.CLOSE_UP, Shot.TWO_SHOT, Shot.POINT_OF_VIEW),
    FilmMoment.VISITOR_SPEAKS: (Shot.POINT_OF_VIEW, Shot.TWO_SHOT),
    FilmMoment.ROBOT_MOVES: (Shot.FULL_SHOT,),
}
"""The shots for each event, used in turn to vary the pictures of a dialogue."""

_NEEDS_VISITOR = frozenset((Shot.TWO_SHOT, Shot.POINT_OF_VIEW))


class ShotDirector:
    """Chooses shots by events; the same events at the same times [s] give the same film."""

    def __init__(self) -> None:
        self._shot, self._since = Shot.FULL_SHOT, 0.0
        self._next = Shot.FULL_SHOT
        self._times = dict.fromkeys(FilmMoment, 0)

    def happened(self, moment: FilmMoment) -> None:
        """Request this event's next shot, in place of an earlier request."""
        wanted = _WANTED[moment]
        self._next = wanted[self._times[moment] % len(wanted)]
        self._times[moment] += 1

    def shot(self, now: float, visitor: bool) -> Shot:
        """Return the shot for `now` [s]; a shot that needs a visitor ends when `visitor` is False."""
        shown = now - self._since
        if self._shot in _NEEDS_VISITOR and not visitor:
            self._cut(Shot.FULL_SHOT, now)
        elif self._next != self._shot and shown >= SHORTEST_SHOT and (visitor or self._next not in _NEEDS_VISITOR):
            self._cut(self._next, now)
        elif shown >= LONGEST_SHOT and visitor:
            self._cut(Shot.TWO_SHOT if self._shot is not Shot.TWO_SHOT else Shot.FULL_SHOT, now)
        return self._shot

    def _cut(self, shot: Shot, now: float) -> None:
        self._shot = self._next = shot
        self._since = now


def camera_place(shot: Shot, who: Subjects, aspect: float) -> CameraPlace:
    """Return the camera's place for a shot; `aspect` is the picture's width divided by its height.

    Without a visitor, a shot that needs one becomes a full shot.
    """
    if shot is Shot.CLOSE_UP:
        return CameraPlace(_beside(who, CLOSE_DISTANCE, who.head[2] + 0.02), _higher(who.head, -0.03))
    if shot is Shot.POINT_OF_VIEW and who.visitor:
        x, y, z = who.visitor
        ahead = atan2(who.head[1] - y, who.head[0] - x)
        return CameraPlace((x + 0.14 * cos(ahead), y + 0.14 * sin(ahead), z + 0.02), _higher(who.head, -0.1))
    if shot is Shot.TWO_SHOT and who.visitor:
        return _two_shot(who, who.visitor, aspect)
    return CameraPlace(_beside(who, FULL_DISTANCE, who.torso[2] + 0.3), _higher(who.torso, 0.02))


def _two_shot(who: Subjects, visitor: HallPoint, aspect: float) -> CameraPlace:
    """Return a camera place beside both subjects, far enough away to show the robot's feet and the visitor's hair."""
    dx, dy = visitor[0] - who.torso[0], visitor[1] - who.torso[1]
    apart = max(hypot(dx, dy), 0.3)
    low, high = who.torso[2] - 0.4, max(visitor[2] + 0.22, who.head[2] + 0.15)
    half = tan(radians(FIELD_OF_VIEW) / 2)
    distance = max((high - low) / 2 / half, (apart / 2 + HEAD_ROOM) / (half * aspect))
    middle = (who.torso[0] + dx / 2, who.torso[1] + dy / 2, (low + high) / 2)
    across = atan2(dy, dx) - radians(90.0)
    eye = (middle[0] + distance * cos(across), middle[1] + distance * sin(across), middle[2] + 0.12)
    return CameraPlace(eye, middle)


def _beside(who: Subjects, distance: float, height: float) -> HallPoint:
    """Return a point in front of the robot at this distance and height [m], on the side away from the visitor."""
    side = SIDE
    if who.visitor:
        towards = atan2(who.visitor[1] - who.torso[1], who.visitor[0] - who.torso[0]) - who.heading
        side = SIDE if atan2(sin(towards), cos(towards)) > -0.15 else -SIDE
    angle = who.heading + side
    return who.torso[0] + distance * cos(angle), who.torso[1] + distance * sin(angle), height


def _higher(point: HallPoint, by: float) -> HallPoint:
    return point[0], point[1], point[2] + by


def free_camera(place: CameraPlace) -> tuple[float, float, float]:
    """Return the azimuth [deg], elevation [deg] and distance [m] of MuJoCo's free camera at this place."""
    dx, dy, dz = (target - eye for eye, target in zip(place.eye, place.target, strict=True))
    flat = hypot(dx, dy)
    return degrees(atan2(dy, dx)), degrees(atan2(dz, flat)), hypot(flat, dz)
