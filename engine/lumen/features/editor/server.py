"""The language server, with an answer for each row of `editor_requests` and `editor_commands`."""

import logging
import sys
from collections.abc import Callable
from typing import Any

from lumen.feature import Feature, rows
from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.refusals import quiet
from lumen.project.broken_features import blamed, resolved

SWITCH_INTERVAL = 0.001
"""The longest time that a check may keep an answer waiting [s]."""

_log = logging.getLogger(__name__)


def server() -> LanguageServer:
    """Return a server that has not been started yet. A faulty row of an installed package is left out and logged."""
    made = LanguageServer()
    for feature, (method, row) in rows("editor_requests"):
        _register(feature, row.answer, made.feature, method, *filter(None, [row.options]))
    for feature, (name, answer) in rows("editor_commands"):
        _register(feature, answer, made.command, name)
    return made


def _register(feature: Feature, answer: str, register: Callable[..., Any], name: str, *options: str) -> None:
    try:
        register(name, *(resolved(feature, each) for each in options))(resolved(feature, answer))
    except Exception as error:
        _log.error("the editor's `%s` is not answered: %s", name, blamed(feature, answer, error))


def serve() -> None:
    """Answer an editor on standard input and output until it says goodbye."""
    quiet()
    sys.setswitchinterval(SWITCH_INTERVAL)
    server().start_io()
