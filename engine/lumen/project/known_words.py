"""What a behaviour knows by name: its own phrases and answers, and those of the words files that it names."""

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
    """The tables by their keys, each from name to content; `files` are those named under `words`.

    `borrowed` says of (key, name) from which of them it comes. Unless `whole`, one of them can't be read, and a name
    that is not known may be there. `anyhow` are the names of phrases that count even if negated, and `supplied` is
    what of Lumen's own words is used without being named, as data; `offered` are the names that it has beside.
    `functions` are those of the project.
    """

    tables: Mapping[str, Mapping[str, Any]]
    files: tuple[str, ...]
    borrowed: Mapping[tuple[str, str], str]
    whole: bool
    anyhow: frozenset[str] = frozenset()
    supplied: Any = None
    offered: frozenset[str] = frozenset()
    functions: KnownFunctions = MappingProxyType({})


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
    """All that a behaviour knows; a file that is not there and a name that is given twice are reported.

    `names` are all words files, those that can't be read among them. If `common` is `shipped`, of it counts what is in
    the project's `languages`, under names that nothing else has; a behaviour that `hears` uses its word lists anyhow.
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
        """Add Lumen's own words under names that nothing has yet; what was added."""
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
        """Phrases, or rows of answers, in the languages of the project; in all if they are not known."""
        if isinstance(content, Mapping):
            return {language: texts for language, texts in content.items() if language in (self.languages or content)}
        rows = [Answer(self.in_languages(row.phrases), row.value) for row in content]
        return tuple(row for row in rows if row.phrases)

    def take(self, name: str, file: BuiltFile[Words]) -> None:
        """The tables of a file, without names that are given already."""
        self.report.lost |= file.report.lost
        self.anyhow |= file.built.anyhow if file.built else frozenset()
        for key, table in self.tables.items():
            for entry, content in getattr(file.built, key, {}).items():
                if entry in table:
                    self.twice(key, entry, file)
                else:
                    table[entry], self.borrowed[key, entry] = content, name

    def twice(self, key: str, entry: str, file: BuiltFile[Words]) -> None:
        """Report a name that a file gives, and this behaviour or a file before gave."""
        other = self.borrowed.get((key, entry))
        first = self.place(self.files[other].report if other else self.report, key, entry)
        second = self.place(file.report, key, entry)
        message = f"the {key} `{entry}` are defined twice: in {first.file} and in {second.file}"
        related = Related(second, "they are defined again here")
        hint = "rename one of them, or combine them"
        self.report.diagnostics.append(DUPLICATE_WORDS.at(first, message, hint, (related,)))

    def place(self, report: DocumentReport, key: str, entry: str) -> Place:
        return report.document.place((key, entry), key=True)
