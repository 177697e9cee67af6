"""Plot a motion: the angle of each joint over time, with its keys and limits."""

from math import degrees

from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.trajectories import JointTrack, Trajectory
from lumen.project.formats.plots.sheet import PlotAxis, PlotLine, PlotMark, PlotPanel, PlotSheet

POINTS_PER_CURVE = 201
"""The number of points of a joint's curve, over the whole motion."""


def motion_sheet(motion: MotionDefinition, body: Body) -> PlotSheet:
    """Return a sheet with a panel for each joint in the body's order: angles in degrees, lengths in mm, hands 0..1."""
    tracks = sorted(Trajectory(motion).tracks, key=lambda track: _place(body, track.joint))
    title = f"Motion {motion.name}, {motion.duration:g} s"
    panels = tuple(_panel(motion, body, track) for track in tracks)
    return PlotSheet(title, panels, min(4, max(1, len(tracks))), "Dots: keys. Horizontal lines: the joint's limits.")


def _panel(motion: MotionDefinition, body: Body, track: JointTrack) -> PlotPanel:
    joint = None if track.joint in body.hands else body.joints.get(track.joint)
    slides = track.joint in body.slides
    scale = _millimetres if slides else degrees if joint else float
    xs = tuple(motion.duration * i / (POINTS_PER_CURVE - 1) for i in range(POINTS_PER_CURVE))
    curve = PlotLine(xs, tuple(scale(track.at(x)) for x in xs))
    keys = motion.tracks[track.joint]
    dots = PlotLine(tuple(key.time for key in keys), tuple(scale(key.angle) for key in keys), points=True)
    limits = (PlotMark(scale(joint.minimum), level=True), PlotMark(scale(joint.maximum), level=True)) if joint else ()
    y = PlotAxis("length [mm]" if slides else "angle [deg]") if joint else PlotAxis("open", -0.05, 1.05)
    return PlotPanel(track.joint, PlotAxis("time [s]", 0.0, motion.duration), y, (curve, dots), limits)


def _millimetres(length: float) -> float:
    return 1000 * length


def _place(body: Body, joint: str) -> tuple[int, str]:
    names = list(body.joints)
    return (names.index(joint) if joint in names else len(names), joint)
