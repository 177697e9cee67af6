"""The lenses' commands for editors without a terminal, which run a process and show the end of its output."""

import asyncio
import sys
from pathlib import Path

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.ranges import path_of

MAX_TOLD = 2_000
"""The maximum length of the shown end of a process's output [characters]."""


async def run_story(server: LanguageServer, root: str, name: str) -> bool:
    """Run a story of the project at the URI `root` and show the result; return True if it passed."""
    return await _performed(server, root, "test", name)


async def play_motion(server: LanguageServer, root: str, name: str) -> bool:
    """Play a motion on the simulated robot and show the result; return True if it succeeded."""
    return await _performed(server, root, "play", name)


def show_places(server: LanguageServer, uri: str, position: lsp.Position, places: list[lsp.Location]) -> None:
    """Do nothing: some editors list the places themselves; in others the lens's title shows their number."""


async def _performed(server: LanguageServer, root: str, verb: str, name: str) -> bool:
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "lumen", verb, "--", name),
        cwd=Path(path_of(root)),
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )
    said, _ = await process.communicate()
    text = said.decode("utf-8", "replace").strip()[-MAX_TOLD:]
    well = process.returncode == 0
    kind = lsp.MessageType.Info if well else lsp.MessageType.Error
    server.window_show_message(lsp.ShowMessageParams(kind, text or f"lumen {verb} {name}: {process.returncode}"))
    return well
