"""`lumen reload`: make a running exhibition read its files again, or show which files are active."""

import argparse
import json
from typing import Any

from lumen.cli.reach import configure_reach, reach
from lumen.run.asking import send_request
from lumen.run.reload.requests import command_key, status_key

REQUESTS = {
    "status": "show which files are active, what is staged, and how the last reload ended",
    "apply": "activate the staged files",
    "try": "activate the staged files for one visitor, then go back",
    "refuse": "discard the staged files",
    "rollback": "go back to the previous files",
    "dry-run": "only show what the saved files would change",
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen reload` to its parser."""
    configure_reach(parser)
    which = parser.add_mutually_exclusive_group()
    for verb, summary in REQUESTS.items():
        which.add_argument(f"--{verb}", dest="command", action="store_const", const=verb, help=summary)
    parser.add_argument("--now", action="store_true", help="cancel what the robot is doing instead of waiting for it")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Send the request, and print each answer until the final one, which may wait for the files to be activated.

    Return 0 if the request was fulfilled, 1 if it was refused or no final answer came.
    """
    body = {"command": options.command or "reload", "now": options.now}
    reached = reach(options)
    try:
        for answer in send_request(reached.bus, command_key(reached.robot), body, status_key(reached.robot)):
            _node(answer, options.format)
            if not isinstance(answer, dict) or answer.get("final", True):
                return int(not isinstance(answer, dict) or answer.get("verdict") == "refused")
    finally:
        reached.bus.close()
    return 1


def _node(answer: Any, format: str) -> None:
    """Print an answer: as a JSON object, or as its lines for people."""
    if format == "json" or not isinstance(answer, dict):
        shown = {key: value for key, value in answer.items() if key != "lines"} if isinstance(answer, dict) else answer
        print(json.dumps(shown, ensure_ascii=False), flush=True)
        return
    lines = answer.get("lines") or [str(answer.get("reason") or answer.get("verdict"))]
    print("\n".join(_clean(str(line)) for line in lines), flush=True)


def _clean(text: str) -> str:
    """Return a text of another program without characters that could control the terminal."""
    return "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
