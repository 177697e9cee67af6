"""The performer of `blink`."""

from lumen.ports import SkillCall


def perform(call: SkillCall) -> dict[str, int]:
    """Blink; return how often that was until the call was cancelled."""
    blinked = 0
    while blinked < call.arguments["times"] and call.wait(0.5):
        blinked += 1
    return {"blinked": blinked}
