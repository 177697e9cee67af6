"""`lumen lsp`: what an editor asks about a project's files, answered over standard input and output."""

import argparse


def configure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--stdio", action="store_true", help="use standard input and output (the default, and the only way)"
    )


def run(options: argparse.Namespace) -> int:
    """0 when the editor has said goodbye."""
    from lumen.features.editor.server import serve  # pygls takes 0.6 s

    serve()
    return 0
