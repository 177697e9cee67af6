"""The language server, with a handler for each row of `editor_requests` and `editor_commands`."""

import logging
import sys
from collections.abc import Callable
from typing import Any

from pygls.exceptions import JsonRpcContentModified, JsonRpcInvalidParams

from lumen.feature import Feature, rows
from lumen.features.editor.language_server import LanguageServer
from lumen.project.broken_features import blamed, resolved

# Refusals of a request, for example because a name is taken or a text has changed: answers, not faults of the server.

_REFUSALS = (JsonRpcInvalidParams, JsonRpcContentModified)


class RefusalFilter(logging.Filter):
    """Keeps refusals out of the log, where pygls writes a traceback of every exception."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Return False for a refusal, True for any other record."""
        return not (record.exc_info and isinstance(record.exc_info[1], _REFUSALS))


def quiet() -> None:
    """Log only errors of pygls, without refusals."""
    logging.getLogger("pygls").setLevel(logging.ERROR)
    logging.getLogger("pygls.protocol.json_rpc").addFilter(RefusalFilter())


SWITCH_INTERVAL = 0.001
"""The interval at which Python switches threads, which limits the delay of an answer by another thread [s]."""

_log = logging.getLogger(__name__)


def server() -> LanguageServer:
    """Return a new language server, not yet started. An installed package's faulty rows are logged and left out."""
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
