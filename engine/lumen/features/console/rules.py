"""The console: nobody can use it from elsewhere without a PIN, and no PIN stands in a file."""

import re

from lumen.features.console.settings import ConsoleSettings
from lumen.language.addresses import loopback
from lumen.language.diagnostics import ERROR, Code
from lumen.lint.routes import PASSWORD_IN_FILE
from lumen.project.draft import ProjectDraft

OPEN_CONSOLE = Code("open-console", "robot", ERROR, "other computers can reach the console, and it has no PINs")
_VARIABLE = re.compile(r"\$[A-Za-z_][A-Za-z0-9_]*")


def check(draft: ProjectDraft) -> None:
    """Report a console that anybody could steer the robot from."""
    settings, report = draft.settings, draft.main
    if settings is None or report is None:
        return
    console = settings.section(ConsoleSettings)
    if not console.wanted:
        return
    for role, pin in console.pins.items():
        if not _VARIABLE.fullmatch(pin):
            hint = f"write `{role}: $LUMEN_PIN_{role.upper()}`, and put the PIN into that environment variable"
            where = ("console", "pins", role)
            report(PASSWORD_IN_FILE, where, "a PIN is in a file that others can read", hint)
    if not console.pins and not loopback(console.host):
        hint = (
            "write `pins: {operator: $LUMEN_PIN_OPERATOR}`, or delete `host`, so that only this computer can reach it"
        )
        message = f"anyone who can reach {console.host} can control the robot"
        report(OPEN_CONSOLE, ("console", "host"), message, hint)
