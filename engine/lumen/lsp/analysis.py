"""A project as an editor sees it: the files on disk, those being edited laid over them, and what is known of all."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

from lumen.language.diagnostics import Diagnostic
from lumen.loading.document import Document
from lumen.loading.draft import ProjectDraft
from lumen.loading.packaged import MAIN_FILE
from lumen.loading.project import draft
from lumen.loading.yaml_reader import parse
from lumen.lsp.grammar import kind_of
from lumen.lsp.index import NameIndex
from lumen.rules import check_files


class Analysis:
    """What can be said of these files; each part is worked out when it is first asked for. Nothing here raises."""

    def __init__(self, root: Path, files: Mapping[str, bytes]) -> None:
        self.root, self.files = root, dict(sorted(files.items()))

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything wrong, as `lumen lint` says it."""
        return tuple(check_files(self.root, self.files)[1])

    @cached_property
    def draft(self) -> ProjectDraft:
        """What could be built."""
        return draft(self.files)

    @cached_property
    def documents(self) -> Mapping[str, Document]:
        """The files that can be read, with nothing taken out of them."""
        read = {file: parse(file, content)[0] for file, content in self.files.items() if kind_of(file)}
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

    def changed(self, file: str, text: str) -> "Analysis":
        """The same with another text in one file."""
        return Analysis(self.root, {**self.files, file: text.encode("utf-8", "surrogatepass")})
