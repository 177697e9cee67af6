"""A project as an editor sees it: the files on disk, those being edited laid over them, and what is known of all."""

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
    """What is to be said of a project: everything wrong, and of files that are no YAML what can be read."""

    diagnostics: tuple[Diagnostic, ...]
    broken: Mapping[str, BrokenFile]


class Analysis:
    """What can be said of these files; each part is worked out when it is first asked for. Nothing here raises.

    `before` is the same project some keys ago: what could be read of a file then stands for one that can't be read now.
    The words that come with Lumen are none of the files, and known all the same.
    To another process it travels without what was worked out of it.
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
        """The files that are no YAML, and what of each can be read."""
        return broken_files(self.files, self._before)

    @cached_property
    def readable(self) -> Mapping[str, bytes]:
        """The files, each as far as it can be read."""
        return {**self.files, **{file: each.readable for file, each in self.broken.items()}}

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything wrong, as `lumen lint` says it; of a file that is no YAML also what is wrong elsewhere in it."""
        return self.judged(lambda: None).diagnostics

    def judged(self, between: Callable[[], None]) -> Judgement:
        """What is to be said; what `between` raises from time to time ends that."""
        found = tuple(check_files(self.root, self.readable, between)[1])
        if self.broken:
            said = [d for each in self.broken.values() for d in each.diagnostics]
            found = tuple(gathered([*said, *(d for d in found if not follows(d, self.broken, self._known))]))
        return Judgement(found, self.broken)

    def accept(self, judgement: Judgement) -> None:
        """Take over what was said of these very files elsewhere."""
        self.__dict__.update(judgement._asdict())

    def prepare(self) -> None:
        """Work out what an editor is going to ask for."""
        _ = self.draft, self.index.uses

    @property
    def known(self) -> KnownFindings:
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

    @cached_property
    def draft(self) -> ProjectDraft:
        """What could be built."""
        return draft(self.readable)

    @cached_property
    def settings(self) -> ProjectDraft:
        """What could be built of lumen.yaml and the schemas of messages alone, which takes no time."""
        files = {f: content for f, content in self.files.items() if kind_of(f) in ("lumen", "message")}
        return draft({**files, **{f: each.readable for f, each in broken_files(files, self._before).items()}})

    @cached_property
    def documents(self) -> Mapping[str, Document]:
        """The files that can be read, with nothing taken out of them, and Lumen's own words unless replaced."""
        files = {COMMON_FILE: common_words(), **self.readable}
        read = {file: parse(file, content)[0] for file, content in files.items() if kind_of(file)}
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
