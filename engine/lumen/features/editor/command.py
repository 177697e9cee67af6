"""`lumen lsp`: the language server, over standard input and output."""

import argparse


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen lsp` to the parser."""
    parser.add_argument(
        "--stdio", action="store_true", help="use standard input and output (the default, and the only way)"
    )


def run(options: argparse.Namespace) -> int:
    """Serve an editor until it ends the session; return 0."""
    from lumen.features.editor.server import serve  # importing pygls takes 0.6 s

    serve()
    return 0
