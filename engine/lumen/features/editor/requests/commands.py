"""What the lenses do where the editor has no terminal of its own for it: a process, and what it said at the end."""

import asyncio
import sys
from pathlib import Path

from lsprotocol import types as lsp

from lumen.features.editor.language_server import LanguageServer
from lumen.features.editor.ranges import path_of

MAX_TOLD = 2_000
"""Characters of a process's last words that are shown."""


async def run_story(server: LanguageServer, root: str, name: str) -> bool:
    """Play a story, and show whether it ended well."""
    return await _performed(server, root, "test", name)


async def play_motion(server: LanguageServer, root: str, name: str) -> bool:
    """Play a motion on the simulated robot, and show what became of it."""
    return await _performed(server, root, "play", name)


def show_places(server: LanguageServer, uri: str, position: lsp.Position, places: list[lsp.Location]) -> None:
    """Nothing: editors list the places themselves, and for others the title says how many there are."""


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
