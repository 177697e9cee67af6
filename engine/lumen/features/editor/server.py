"""The language server, with an answer for each row of `editor_requests` and `editor_commands`."""

import logging
import sys
from collections.abc import Callable
from typing import Any

from pygls.exceptions import JsonRpcContentModified, JsonRpcInvalidParams

from lumen.feature import Feature, rows
from lumen.features.editor.language_server import LanguageServer
from lumen.project.broken_features import blamed, resolved

# Requests that are turned down with a reason, as a new name that is taken or a text that is another by now: an answer,
# and no fault of the server.

_REFUSALS = (JsonRpcInvalidParams, JsonRpcContentModified)


class RefusalFilter(logging.Filter):
    """Keeps refusals out of the log, into which the protocol's library writes a traceback of whatever is raised."""

    def filter(self, record: logging.LogRecord) -> bool:
        return not (record.exc_info and isinstance(record.exc_info[1], _REFUSALS))


def quiet() -> None:
    """Log what went wrong, and nothing else."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("pygls.protocol.json_rpc").addFilter(RefusalFilter())


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
