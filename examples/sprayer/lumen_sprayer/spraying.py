"""The performer of `spray`."""

from lumen.errors import RobotFailedError
from lumen.language.durations import seconds
from lumen.ports import SkillCall


def perform(call: SkillCall) -> None:
    """Open the nozzle until the time is over or the call is cancelled. Raises RobotFailedError without a duration."""
    duration = seconds(call.arguments["duration"])
    if duration is None:
        raise RobotFailedError(f"`{call.arguments['duration']}` is no duration")
    # Open the nozzle of your device here …
    call.wait(duration)
    # … and close it here.
