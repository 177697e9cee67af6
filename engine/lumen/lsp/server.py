"""The language server: what it answers, by the methods of the protocol."""

import sys
from collections.abc import Callable
from typing import Any

from lsprotocol import types as lsp

from lumen.lsp import lenses
from lumen.lsp.features import annotations, changes, commands, outlines, positions, sync
from lumen.lsp.language_server import LanguageServer
from lumen.lsp.refusals import quiet

FEATURES: tuple[tuple[str, Any, Callable[..., Any]], ...] = (
    (lsp.TEXT_DOCUMENT_DID_OPEN, None, sync.opened),
    (lsp.TEXT_DOCUMENT_DID_CHANGE, None, sync.changed),
    (lsp.TEXT_DOCUMENT_DID_SAVE, None, sync.saved),
    (lsp.TEXT_DOCUMENT_DID_CLOSE, None, sync.closed),
    (lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES, None, sync.touched),
    (lsp.TEXT_DOCUMENT_COMPLETION, positions.TRIGGERS, positions.complete),
    (lsp.TEXT_DOCUMENT_HOVER, None, positions.show),
    (lsp.TEXT_DOCUMENT_DEFINITION, None, positions.define),
    (lsp.TEXT_DOCUMENT_REFERENCES, None, positions.refer),
    (lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, None, positions.highlight),
    (lsp.TEXT_DOCUMENT_PREPARE_RENAME, None, changes.prepare),
    (lsp.TEXT_DOCUMENT_RENAME, changes.RENAMING, changes.rename),
    (lsp.TEXT_DOCUMENT_CODE_ACTION, changes.REPAIRS, changes.repair),
    (lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL, None, outlines.outline),
    (lsp.WORKSPACE_SYMBOL, None, outlines.search),
    (lsp.TEXT_DOCUMENT_FOLDING_RANGE, None, outlines.fold),
    (lsp.TEXT_DOCUMENT_DOCUMENT_LINK, None, outlines.link),
    (lsp.TEXT_DOCUMENT_CODE_LENS, None, annotations.lens),
    (lsp.TEXT_DOCUMENT_INLAY_HINT, None, annotations.hint),
    (lsp.TEXT_DOCUMENT_SIGNATURE_HELP, annotations.CALLS, annotations.call),
    (lsp.INITIALIZED, None, sync.begun),
    (lsp.SHUTDOWN, None, sync.ended),
)
"""Method, options, answer."""

COMMANDS: tuple[tuple[str, Callable[..., Any]], ...] = (
    (lenses.RUN_STORY, commands.run_story),
    (lenses.PLAY_MOTION, commands.play_motion),
    (lenses.SHOW_PLACES, commands.show_places),
)
"""What the lenses call, where the editor leaves it to the server."""

SWITCH_INTERVAL = 0.001
"""How long a check may keep an answer waiting at a time [s]."""


def server() -> LanguageServer:
    """A server that has not been started yet."""
    made = LanguageServer()
    for method, options, answer in FEATURES:
        made.feature(method, options)(answer)
    for name, act in COMMANDS:
        made.command(name)(act)
    return made


def serve() -> None:
    """Answer an editor on standard input and output until it says goodbye."""
    quiet()
    sys.setswitchinterval(SWITCH_INTERVAL)
    server().start_io()
