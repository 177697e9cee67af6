"""The rules for the console: PINs protect it from other machines, no file contains a PIN, and proxies are addresses."""

import re

from lumen.features.console.proxies import network_of
from lumen.features.console.settings import ConsoleSettings
from lumen.language.addresses import loopback
from lumen.language.diagnostics import ERROR, Code
from lumen.lint.routes import PASSWORD_IN_FILE
from lumen.project.draft import ProjectDraft

OPEN_CONSOLE = Code("open-console", "robot", ERROR, "other computers can reach the console, and it has no PINs")
PROXY_ADDRESS = Code("proxy-address", "robot", ERROR, "a trusted proxy of the console is not an address")
_VARIABLE = re.compile(r"\$[A-Za-z_][A-Za-z0-9_]*")


def check(draft: ProjectDraft) -> None:
    """Report a console that others can use without a PIN, PINs in files, and proxies that are not addresses."""
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
    for number, proxy in enumerate(console.proxies):
        try:
            network_of(proxy)
        except ValueError:
            hint = "write the address from which the proxy connects, such as 127.0.0.1, or a network such as 10.0.0.0/8"
            report(PROXY_ADDRESS, ("console", "proxies", number), f"`{proxy}` is not an address", hint)
    if console.pins:
        return
    pins = "write `pins: {operator: $LUMEN_PIN_OPERATOR}`"
    if not loopback(console.host):
        hint = f"{pins}, or delete `host`, so that only this computer can reach it"
        message = f"anyone who can reach {console.host} can control the robot"
        report(OPEN_CONSOLE, ("console", "host"), message, hint)
    elif console.proxies:
        hint = f"{pins}, or delete `proxies`, so that only this computer can reach it"
        report(OPEN_CONSOLE, ("console", "proxies"), "anyone who can reach the proxy can control the robot", hint)
