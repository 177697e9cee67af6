"""A project as an editor sees it: the files on disk, those being edited laid over them, and what is known of all."""

from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path

from lumen.language.diagnostics import Diagnostic, gathered
from lumen.loading.document import Document
from lumen.loading.draft import ProjectDraft
from lumen.loading.packaged import MAIN_FILE
from lumen.loading.project import draft
from lumen.loading.yaml_reader import parse
from lumen.lsp.broken_files import BrokenFile, Known, broken_files, follows, signature
from lumen.lsp.grammar import kind_of
from lumen.lsp.index import NameIndex
from lumen.rules import check_files


class Analysis:
    """What can be said of these files; each part is worked out when it is first asked for. Nothing here raises.

    `before` is the same project some keys ago: what could be read of a file then stands for one that can't be read now.
    """

    def __init__(self, root: Path, files: Mapping[str, bytes], before: "Analysis | None" = None) -> None:
        self.root, self.files = root, dict(sorted(files.items()))
        self._before = dict(before.readable) if before else {}
        self._last_index = before.known_index if before else None
        self._known: Known = before.known if before else frozenset()

    @cached_property
    def broken(self) -> Mapping[str, BrokenFile]:
        """The files that are no YAML, and what of each can be read."""
        return broken_files(self.files, self._before)

    @cached_property
    def readable(self) -> Mapping[str, bytes]:
        """The files, each as far as it can be read."""
        return {**self.files, **{file: each.readable for file, each in self.broken.items()}}

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything wrong, as `lumen lint` says it; of a file that is no YAML also what is wrong elsewhere in it."""
        return self._diagnostics(lambda: None)

    def check(self, between: Callable[[], None]) -> None:
        """Work the diagnostics out; what `between` raises from time to time ends that, and nothing is kept."""
        if "diagnostics" not in self.__dict__:
            self.__dict__["diagnostics"] = self._diagnostics(between)

    @property
    def known(self) -> Known:
        """What was found when all files could last be read, as far as that was worked out."""
        found = self.__dict__.get("diagnostics")
        return self._known if found is None or self.broken else frozenset(map(signature, found))

    @property
    def known_index(self) -> NameIndex | None:
        """The index of these files, or of those some keys ago, where one was worked out."""
        found: NameIndex | None = self.__dict__.get("index", self._last_index)
        return found

    def names(self, file: str) -> NameIndex:
        """The names to propose in a file: those of some keys ago, which are there at once, if it was there by then."""
        last = self.known_index
        return last if last is not None and file in last.documents else self.index

    def _diagnostics(self, between: Callable[[], None]) -> tuple[Diagnostic, ...]:
        found = tuple(check_files(self.root, self.readable, between)[1])
        if not self.broken:
            return found
        said = [d for each in self.broken.values() for d in each.diagnostics]
        return tuple(gathered([*said, *(d for d in found if not follows(d, self.broken, self._known))]))

    @cached_property
    def draft(self) -> ProjectDraft:
        """What could be built."""
        return draft(self.readable)

    @cached_property
    def settings(self) -> ProjectDraft:
        """What could be built of lumen.yaml and the schemas of messages alone, which takes no time."""
        return draft({f: content for f, content in self.readable.items() if kind_of(f) in ("lumen", "message")})

    @cached_property
    def documents(self) -> Mapping[str, Document]:
        """The files that can be read, with nothing taken out of them."""
        read = {file: parse(file, content)[0] for file, content in self.readable.items() if kind_of(file)}
        return {file: document for file, document in read.items() if document}

    @cached_property
    def index(self) -> NameIndex:
        """Every name, and what it means."""
        main = self.documents[MAIN_FILE].data if MAIN_FILE in self.documents else None
        named = main.get("behavior") if isinstance(main, dict) else ""
        return NameIndex(self.documents, frozenset(self.files), named if isinstance(named, str) else "")

    def text(self, file: str) -> str:
        """The text of a file, empty where there is none."""
        return self.files.get(file, b"").decode("utf-8-sig", "replace")

    def readable_text(self, file: str) -> str:
        """The text of a file as far as it can be read."""
        return self.readable.get(file, b"").decode("utf-8-sig", "replace")

    def changed(self, file: str, text: str) -> "Analysis":
        """The same with another text in one file."""
        return Analysis(self.root, {**self.files, file: text.encode("utf-8", "surrogatepass")}, self)
