"""The performer of `spray`."""

from lumen.errors import RobotFailedError
from lumen.language.durations import seconds
from lumen.ports import SkillCall
from lumen_sprayer.settings import Sprayer


def perform(call: SkillCall) -> None:
    """Open the nozzle until the time is over or the call is cancelled.

    Raises RobotFailedError for a text that is no duration, and for a nozzle that lumen.yaml does not list.
    """
    duration, nozzle = seconds(call.arguments["duration"]), call.arguments["nozzle"]
    if duration is None:
        raise RobotFailedError(f"`{call.arguments['duration']}` is no duration")
    if nozzle not in call.section(Sprayer).nozzles:
        raise RobotFailedError(f"there is no nozzle `{nozzle}`")
    # Open the nozzle of your device here …
    call.wait(duration)
    # … and close it here.
