"""The language server, which keeps the open projects and publishes their findings."""

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcContentModified
from pygls.lsp import server as pygls_server

import lumen
from lumen.errors import LumenError
from lumen.features.editor.analysis import Analysis
from lumen.features.editor.judging import Judge
from lumen.features.editor.lenses import active_places
from lumen.features.editor.open_projects import OpenProjects, root_of
from lumen.features.editor.protocol import ProtocolEncoder
from lumen.features.editor.ranges import path_of
from lumen.features.editor.running import RunningExhibitions
from lumen.upkeep.threads import WatchedThread

CHECK_DELAY = 0.02
"""The pause in typing after which the project is checked [s]."""

ACTIVE = "lumen/active"
"""The notification of the active states of a running exhibition: `root`, `states`, and the `places` of their keys."""

T = TypeVar("T")


class LanguageServer(pygls_server.LanguageServer):
    """Checks the projects of open files, and answers an editor's requests about positions."""

    def __init__(self) -> None:
        # Documents are synchronised as a whole: pygls applies partial changes by lines that also end at U+2028 and
        # similar characters.
        super().__init__("lumen", lumen.__version__, text_document_sync_kind=lsp.TextDocumentSyncKind.Full)
        self.projects = OpenProjects()
        self.running = RunningExhibitions(self.projects.roots, self._moved)
        self._told: dict[Path, set[str]] = {}
        self._due: dict[Path, float] = {}
        self._judges: dict[Path, Judge] = {}
        self._checking: dict[Path, asyncio.Task[None]] = {}

    def encoder(self, analysis: Analysis) -> ProtocolEncoder:
        """Return the encoder of a project's results for this client."""
        return ProtocolEncoder(analysis, self.workspace.position_codec)

    def analyses(self) -> list[Analysis]:
        """Return the analyses of the projects with an open file."""
        return [self.projects.analysis(root) for root in self.projects.roots()]

    def active(self, root: Path) -> tuple[str, ...]:
        """Return the names of the active states of a project's running exhibition."""
        return self.running.active(root)

    def follow(self) -> None:
        """Start a thread that follows running exhibitions."""
        self._loop = asyncio.get_running_loop()
        WatchedThread("exhibitions", self.running.follow).start()

    def _moved(self, root: Path) -> None:
        self._loop.call_soon_threadsafe(self._tell_active, root)

    def _tell_active(self, root: Path) -> None:
        """Send the active states of a running exhibition to the editor, and request a refresh of the lenses."""
        analysis = self.projects.analysis(root)
        encoder = self.encoder(analysis)
        places = [encoder.location(place) for place in active_places(analysis, self.active(root))]
        body = {"root": root.absolute().as_uri(), "states": list(self.active(root)), "places": places}
        self.protocol.notify(ACTIVE, body)
        lenses = self.client_capabilities.workspace and self.client_capabilities.workspace.code_lens
        if lenses and lenses.refresh_support:
            self.workspace_code_lens_refresh(None)

    def file(self, uri: str) -> tuple[Analysis, str] | None:
        """Return the project and file of a document; None if the document belongs to no project."""
        try:
            return self.projects.at(Path(path_of(uri)))
        except LumenError:
            return None

    def at(self, uri: str, position: lsp.Position) -> tuple[Analysis, str, int, int] | None:
        """Return the project, file, line and column, from 1, of a position; None if the file belongs to no project."""
        if (found := self.file(uri)) is None:
            return None
        analysis, file = found
        line, column = self.encoder(analysis).ranges(file).place(position)
        return analysis, file, line, column

    def asked(self, params: Any, answer: Callable[[Analysis, str, int, int], T]) -> T | None:
        """Return the result of `answer` for the requested position; None if the file belongs to no project."""
        found = self.at(params.text_document.uri, params.position)
        return answer(*found) if found else None

    def written(self, uri: str, *, at_once: bool = False) -> None:
        """Store the new text of an open file, and check its project after a pause in typing, or now if `at_once`."""
        path = Path(path_of(uri))
        self.projects.write(path, self.workspace.get_text_document(uri).source)
        if root := root_of(path):
            self._told.setdefault(root, set()).add(path.relative_to(root).as_posix())
        self.check(path, at_once=at_once)

    def check(self, path: Path, *, at_once: bool = False) -> None:
        """Check a file's project after a pause in typing, or now if `at_once`; a check in progress is restarted."""
        if (root := root_of(path)) is None:
            return
        self.judge(root).outdated()
        self._due[root] = asyncio.get_running_loop().time() + (0 if at_once else CHECK_DELAY)
        if root not in self._checking or self._checking[root].done():
            self._checking[root] = asyncio.ensure_future(self._check(root))

    def judge(self, root: Path) -> Judge:
        """Return the judge of the project in that folder."""
        return self._judges.setdefault(root, Judge())

    def close(self) -> None:
        """End the thread that follows exhibitions, and the judges' processes."""
        self.running.close()
        for judge in self._judges.values():
            judge.close()

    async def settled(self, uri: str) -> tuple[Analysis, str] | None:
        """Return the project and file of a document after its project has been checked; None if it belongs to none.

        Raises JsonRpcContentModified if the document, or another of its project, changes meanwhile, so that the editor
        repeats the request.
        """
        root, asked = root_of(Path(path_of(uri))), self._version(uri)
        while (task := self._checking.get(root) if root else None) and not task.done():
            await asyncio.wait((task,))
            if self._version(uri) != asked:
                raise JsonRpcContentModified
        if found := self.file(uri):
            await asyncio.get_running_loop().run_in_executor(None, found[0].prepare)
            if (task := self._checking.get(root) if root else None) and not task.done():
                raise JsonRpcContentModified
        return found

    def _version(self, uri: str) -> int | None:
        document = self.workspace.text_documents.get(uri)
        return document.version if document else None

    async def _check(self, root: Path) -> None:
        loop = asyncio.get_running_loop()
        while (due := self._due.get(root)) is not None:
            if (wait := due - loop.time()) > 0:
                await asyncio.sleep(wait)
                continue
            del self._due[root]
            analysis = self.projects.analysis(root)
            if (found := await self.judge(root).judge(analysis)) and root not in self._due:
                analysis.accept(found)
                self._tell(root, analysis)
                await loop.run_in_executor(None, analysis.prepare)

    def _tell(self, root: Path, analysis: Analysis) -> None:
        """Publish the findings file by file.

        Open files without findings, and files that no longer have any, receive an empty list.
        """
        encoder, found = self.encoder(analysis), dict[str, list[lsp.Diagnostic]]()
        for diagnostic in analysis.diagnostics:
            found.setdefault(diagnostic.place.file, []).append(encoder.diagnostic(diagnostic))
        for file in sorted(self._told.get(root, set()) | found.keys()):
            uri = encoder.uri(file)
            self.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(uri, found.get(file, []), version=self._version(uri))
            )
        self._told[root] = set(found)
