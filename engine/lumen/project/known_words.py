"""The phrases, answers and lists that a behaviour can name: its own, and those of its words files."""

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from lumen.expressions.own_functions import KnownFunctions
from lumen.language.diagnostics import ERROR, Code, NodePath, Place, Related, did_you_mean
from lumen.language.machines import Answer
from lumen.language.words import Words
from lumen.project.built_file import BuiltFile
from lumen.project.common_words import COMMON
from lumen.project.document_report import DocumentReport
from lumen.project.project_folders import WORDS_FOLDER
from lumen.project.words import anyhow, tables
from lumen.talk.speech import TABLES, WORD_LISTS

UNKNOWN_WORDS = Code("unknown-words", "references", ERROR, "the named words file is not in behaviors/words/")
DUPLICATE_WORDS = Code(
    "duplicate-words", "references", ERROR, "a name is defined in two words files, or in a words file and the behaviour"
)

WordFiles = Mapping[str, BuiltFile[Words]]
"""The words files that can be read, by name."""


class KnownWords(NamedTuple):
    """The tables that a behaviour can use."""

    tables: Mapping[str, Mapping[str, Any]]
    """The tables by their keys (`phrases`, `answers`, `lists`), each from name to content."""
    files: tuple[str, ...]
    """The names of the files under `words`."""
    borrowed: Mapping[tuple[str, str], str]
    """The words file that defines each (key, name) which the behaviour does not define itself."""
    whole: bool
    """False if one of the files can't be read, so that an unknown name may be defined there."""
    anyhow: frozenset[str] = frozenset()
    """The names of phrases that match even if negated."""
    supplied: Any = None
    """The part of Lumen's own words that the behaviour can use, as data; None if it uses none."""
    offered: frozenset[str] = frozenset()
    """The names in Lumen's own words that the behaviour could use if it listed `common` under `words`."""
    functions: KnownFunctions = MappingProxyType({})
    """The functions of the project."""


def known_words(
    data: Mapping[str, Any],
    report: DocumentReport,
    files: WordFiles,
    names: Collection[str],
    languages: Collection[str] = (),
    *,
    shipped: bool = False,
    hears: bool = False,
) -> KnownWords:
    """Return all words that a behaviour can name; a missing file and a name that is defined twice are reported.

    `names` are those of all words files, including unreadable ones. `shipped` is true if the words file `common` comes
    with Lumen. In that case `common` adds only names that are not defined elsewhere, in the project's `languages`.
    `hears` is true if the behaviour has `hears`; the behaviour then uses the word lists of `common` even if it does not
    name that file.
    """
    return _Gatherer(data, report, files, names, languages, shipped).gather(hears)


class _Gatherer:
    def __init__(
        self,
        data: Mapping[str, Any],
        report: DocumentReport,
        files: WordFiles,
        names: Collection[str],
        languages: Collection[str],
        shipped: bool,
    ) -> None:
        self.data, self.report, self.files, self.names = data, report, files, names
        self.languages, self.shipped = languages, shipped
        self.tables: dict[str, dict[str, Any]] = tables(data)
        self.anyhow = anyhow(data)
        self.borrowed: dict[tuple[str, str], str] = {}

    def gather(self, hears: bool) -> KnownWords:
        written = self.data.get("words") or ()
        rows = [written] if isinstance(written, str) else list(dict.fromkeys(written))
        for i, name in enumerate(rows):
            where: NodePath = ("words",) if isinstance(written, str) else ("words", i)
            if name == COMMON and self.shipped:
                continue
            if name in self.files:
                self.take(name, self.files[name])
            elif name not in self.names:
                hint = did_you_mean(name.removesuffix(".yaml"), self.names, f"{WORDS_FOLDER}/ has")
                self.report(UNKNOWN_WORDS, where, f"there is no words file `{name}`", hint, cause=f"words {name}")
        whole = all(name in self.files and self.files[name].built for name in rows)
        supplied, offered = None, frozenset[str]()
        if self.shipped and (COMMON in rows or hears) and (common := COMMON in self.files and self.files[COMMON].built):
            supplied = self.supply(common, everything=COMMON in rows)
            offered = frozenset((*common.phrases, *common.answers)).difference(*self.tables.values())
        return KnownWords(self.tables, tuple(rows), self.borrowed, whole, self.anyhow, supplied, offered)

    def supply(self, common: Words, *, everything: bool) -> Any:
        """Add Lumen's own words under names that are still free; return the added part."""
        added = []
        for key in ("phrases", "answers"):
            for name, content in getattr(common, key).items():
                if name in self.tables[key] or not (everything or name in WORD_LISTS or name in TABLES):
                    continue
                self.tables[key][name] = mine = self.in_languages(content)
                self.borrowed[key, name] = COMMON
                plain = [[row.phrases, row.value] for row in mine] if key == "answers" else mine
                added.append([key, name, plain])
                self.anyhow |= common.anyhow & {name}
        return added

    def in_languages(self, content: Any) -> Any:
        """Return phrases, or rows of answers, in the languages of the project.

        If these are not known, all languages are included.
        """
        if isinstance(content, Mapping):
            return {language: texts for language, texts in content.items() if language in (self.languages or content)}
        rows = [Answer(self.in_languages(row.phrases), row.value) for row in content]
        return tuple(row for row in rows if row.phrases)

    def take(self, name: str, file: BuiltFile[Words]) -> None:
        """Add the tables of a file; report names that are already defined."""
        self.report.lost |= file.report.lost
        self.anyhow |= file.built.anyhow if file.built else frozenset()
        for key, table in self.tables.items():
            for entry, content in getattr(file.built, key, {}).items():
                if entry in table:
                    self.twice(key, entry, file)
                else:
                    table[entry], self.borrowed[key, entry] = content, name

    def twice(self, key: str, entry: str, file: BuiltFile[Words]) -> None:
        """Report a name that is defined both in a file and in this behaviour or an earlier file."""
        other = self.borrowed.get((key, entry))
        first = self.place(self.files[other].report if other else self.report, key, entry)
        second = self.place(file.report, key, entry)
        message = f"the {key} `{entry}` are defined twice: in {first.file} and in {second.file}"
        related = Related(second, "they are defined again here")
        hint = "rename one of them, or combine them"
        self.report.diagnostics.append(DUPLICATE_WORDS.at(first, message, hint, (related,)))

    def place(self, report: DocumentReport, key: str, entry: str) -> Place:
        return report.document.place((key, entry), key=True)
