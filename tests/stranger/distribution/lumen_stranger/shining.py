"""The performer of `shine`."""

from lumen.errors import RobotFailedError
from lumen.ports import SkillCall
from lumen_stranger.lamp import Lamp


def perform(call: SkillCall) -> dict[str, float]:
    """Switch the lamp to a scene; return how bright that is. Raises RobotFailedError if lumen.yaml lacks the scene."""
    scenes = call.section(Lamp).scenes
    if call.arguments["scene"] not in scenes:
        raise RobotFailedError(f"the lamp has no scene `{call.arguments['scene']}`")
    return {"brightness": scenes[call.arguments["scene"]]}
