"""`lumen lsp`: what an editor asks about a project's files, answered over standard input and output."""

import argparse

from lumen.errors import UsageError


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--stdio", action="store_true", help="as every editor says; there is no other way")


def run(options: argparse.Namespace) -> int:
    """0 when the editor has said goodbye. Raises UsageError where the protocol's library is not installed."""
    try:
        from lumen.lsp.server import serve  # pygls takes 0.6 s
    except ModuleNotFoundError as error:
        if error.name not in ("pygls", "lsprotocol", "attrs", "cattrs"):
            raise
        raise UsageError("the language server needs pygls: pip install 'lumen-robot[lsp]'") from None
    serve()
    return 0
