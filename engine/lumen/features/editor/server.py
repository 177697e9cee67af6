"""The language server, with an answer for each row of `editor_requests` and `editor_commands`."""

import logging
import sys
from collections.abc import Callable
from typing import Any

from pygls.exceptions import JsonRpcContentModified, JsonRpcInvalidParams

from lumen.feature import Feature, rows
from lumen.features.editor.language_server import LanguageServer
from lumen.project.broken_features import blamed, resolved

# Reasons to refuse a request, such as a name that is taken or a text that has changed: an answer, not a fault of
# the server.

_REFUSALS = (JsonRpcInvalidParams, JsonRpcContentModified)


class RefusalFilter(logging.Filter):
    """Keeps refusals out of the log, where pygls writes a traceback of every exception."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Return True if the record is anything but a refusal."""
        return not (record.exc_info and isinstance(record.exc_info[1], _REFUSALS))


def quiet() -> None:
    """Log only errors of pygls, and no refusals."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("pygls.protocol.json_rpc").addFilter(RefusalFilter())


SWITCH_INTERVAL = 0.001
"""The interval of Python's switches between threads, the longest delay of an answer by a check [s]."""

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
    """Serve an editor on standard input and output until it ends the session."""
    quiet()
    sys.setswitchinterval(SWITCH_INTERVAL)
    server().start_io()
