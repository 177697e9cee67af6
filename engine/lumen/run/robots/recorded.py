"""A robot that records its commands."""

from lumen.clock.simulated import SimulatedClock
from lumen.robot.recording import RecordingRobot
from lumen.robot.skill_runner import SkillRunner
from lumen.run.setup import RobotRequest, Setup


def set_up(request: RobotRequest) -> Setup:
    """Return a robot in simulated time, with the faults and results of the story's `robot:`."""
    story = request.story
    told = (story.robot, story.results) if story else ({}, {})
    robot = RecordingRobot(request.project.body, *told, SkillRunner(lockstep=True) if request.real_skills else None)
    return Setup(robot, SimulatedClock(robot.advance, request.pace), robot)
