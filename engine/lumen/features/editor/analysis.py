"""The analysis of a project as an editor shows it: its files on disk with the unsaved texts."""

from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from lumen.features.editor.broken_files import BrokenFile, KnownFindings, broken_files, follows, signature
from lumen.features.editor.index import NameIndex
from lumen.language.diagnostics import Diagnostic, gathered
from lumen.lint import check_files
from lumen.project.building import draft
from lumen.project.common_words import COMMON, COMMON_FILE, common_words, is_shipped
from lumen.project.document import Document
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import MAIN_FILE, kind_of
from lumen.project.yaml_reader import parse


class Judgement(NamedTuple):
    """A project's findings, and its files that are invalid YAML, by name."""

    diagnostics: tuple[Diagnostic, ...]
    broken: Mapping[str, BrokenFile]


class Analysis:
    """The analysis of a project's files. Each result is computed when first needed; faulty files raise no errors.

    `files` are the contents by path relative to `root`. `before` is an earlier analysis of the same project: if a file
    that is now invalid YAML can't be repaired, its last readable version replaces it. The analysis includes the words
    that come with Lumen. A pickled analysis contains only the files, and earlier versions and findings.
    """

    def __init__(self, root: Path, files: Mapping[str, bytes], before: "Analysis | None" = None) -> None:
        shipped = is_shipped(files, COMMON) and not (root / COMMON_FILE).is_file()
        self.root = root
        self.files = {file: files[file] for file in sorted(files) if not (shipped and file == COMMON_FILE)}
        self._before: Mapping[str, bytes] = before.__dict__.get("readable", before._before) if before else {}
        self._last_index = before.known_index if before else None
        self._known: KnownFindings = before.known if before else frozenset()

    def __getstate__(self) -> dict[str, Any]:
        return {
            "root": self.root,
            "files": self.files,
            "_before": self._before,
            "_last_index": None,
            "_known": self._known,
        }

    @cached_property
    def broken(self) -> Mapping[str, BrokenFile]:
        """The files that are invalid YAML, by name, with their readable replacements."""
        return broken_files(self.files, self._before)

    @cached_property
    def readable(self) -> Mapping[str, bytes]:
        """The contents of all files by name; invalid YAML is replaced by a readable version, if there is one."""
        return {**self.files, **{file: each.readable for file, each in self.broken.items()}}

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All findings, as from `lumen lint`; for an invalid YAML file also the findings in its readable part."""
        return self.judged(lambda: None).diagnostics

    def judged(self, between: Callable[[], None]) -> Judgement:
        """Return the findings. The check calls `between` repeatedly, which can raise an error to end the check."""
        found = tuple(check_files(self.root, self.readable, between)[1])
        if self.broken:
            said = [d for each in self.broken.values() for d in each.diagnostics]
            found = tuple(gathered([*said, *(d for d in found if not follows(d, self.broken, self._known))]))
        return Judgement(found, self.broken)

    def accept(self, judgement: Judgement) -> None:
        """Store findings about these files that another process has computed."""
        self.__dict__.update(judgement._asdict())

    def prepare(self) -> None:
        """Compute the draft and the uses of names, which an editor will soon need."""
        _ = self.draft, self.index.uses

    @property
    def known(self) -> KnownFindings:
        """The signatures of the last findings that were computed with all files readable; empty if there are none."""
        found = self.__dict__.get("diagnostics")
        return self._known if found is None or self.broken else frozenset(map(signature, found))

    @property
    def known_index(self) -> NameIndex | None:
        """The index of these files, or an earlier one; None if none was computed."""
        found: NameIndex | None = self.__dict__.get("index", self._last_index)
        return found

    def names(self, file: str) -> NameIndex:
        """Return the index of names for proposals in a file.

        An earlier index that includes the file is preferred, because it is available immediately.
        """
        last = self.known_index
        return last if last is not None and file in last.documents else self.index

    @cached_property
    def draft(self) -> ProjectDraft:
        """The parts of the project that could be built despite its errors."""
        return draft(self.readable)

    @cached_property
    def settings(self) -> ProjectDraft:
        """The parts that could be built from lumen.yaml and the messages' schemas alone; faster than `draft`."""
        files = {f: content for f, content in self.files.items() if kind_of(f) in ("lumen", "message")}
        return draft({**files, **{f: each.readable for f, each in broken_files(files, self._before).items()}})

    @cached_property
    def documents(self) -> Mapping[str, Document]:
        """The parsed readable files by name, with Lumen's own words unless the project replaces them."""
        files = {COMMON_FILE: common_words(), **self.readable}
        read = {file: parse(file, content)[0] for file, content in files.items() if kind_of(file)}
        return {file: document for file, document in read.items() if document}

    @cached_property
    def index(self) -> NameIndex:
        """The index of the names in all documents."""
        main = self.documents[MAIN_FILE].data if MAIN_FILE in self.documents else None
        named = main.get("behavior") if isinstance(main, dict) else ""
        return NameIndex(self.documents, frozenset(self.files), named if isinstance(named, str) else "")

    def text(self, file: str) -> str:
        """Return the text of a file, empty if it does not exist."""
        return self.files.get(file, b"").decode("utf-8-sig", "replace")

    def readable_text(self, file: str) -> str:
        """Return the text of a file or of its readable replacement, empty if the file does not exist."""
        return self.readable.get(file, b"").decode("utf-8-sig", "replace")

    def changed(self, file: str, text: str) -> "Analysis":
        """Return a later analysis in which one file has a new text."""
        return Analysis(self.root, {**self.files, file: text.encode("utf-8", "surrogatepass")}, self)
