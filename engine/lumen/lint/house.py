"""Several robots in one house: whether their names and places differ enough."""

from itertools import combinations
from math import hypot

from lumen.language.diagnostics import ERROR, WARNING, Code
from lumen.language.routing_keys import DEFAULT_KEYS
from lumen.project.draft import ProjectDraft

CLASHING_NAMES = Code("clashing-names", "robot", ERROR, "two robots of a house would share a key or a folder")
SAME_PLACE = Code("same-place", "robot", WARNING, "two robots start too close to each other")

ROOM = 0.5
"""The minimum distance between two robots at which their arms do not touch [m]."""


def check(draft: ProjectDraft) -> None:
    """Report robots with clashing names, or that start too close to each other."""
    settings, report = draft.settings, draft.main
    if settings is None or report is None or not settings.told_apart:
        return
    keys: dict[str, str] = {}
    for name in settings.robots:
        for key in DEFAULT_KEYS.values():
            other = keys.setdefault(key.replace("{robot}", name), name)
            if other != name:
                message = f"`{name}` and `{other}` would both use `{key.replace('{robot}', name)}`"
                report(CLASHING_NAMES, ("robots", name), message, "rename one of them", key=True)
                break
        if name == settings.house:
            hint = "write another `house:`, or rename the robot"
            report(CLASHING_NAMES, ("robots", name), f"`{name}` is also the name of the house", hint, key=True)
    for one, two in combinations(settings.robots.values(), 2):
        if one.name.casefold() == two.name.casefold():
            message = (
                f"`{two.name}` and `{one.name}` differ only in capital letters: on some disks they would share a folder"
            )
            report(CLASHING_NAMES, ("robots", two.name), message, "rename one of them", key=True)
        if (apart := hypot(one.at.x - two.at.x, one.at.y - two.at.y)) < ROOM:
            message = f"`{two.name}` starts {apart:.2f} m from `{one.name}`: their arms could touch"
            hint = f"write `at: {{x: 0, y: 1}}` beside its `model`, at least {ROOM:g} m from the other robot"
            report(SAME_PLACE, ("robots", two.name), message, hint, key=True)
