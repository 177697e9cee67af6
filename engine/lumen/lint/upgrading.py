"""Rewrites files of an older vocabulary for a newer vocabulary: a pure function from files to files."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.language.diagnostics import NodePath, Place
from lumen.language.text_lines import lines_of
from lumen.language.vocabulary import FIRST_VOCABULARY, VOCABULARY, VOCABULARY_KEY
from lumen.lint.fixes import Edit, edited
from lumen.project.document import Document
from lumen.project.project_folders import MAIN_FILE
from lumen.project.yaml_reader import parse


class Rewriting(NamedTuple):
    """A place in a file to rewrite, with the reason in words and the new text."""

    place: Place
    why: str
    text: str


Migration = Callable[[Document], Iterable[Rewriting]]
"""A change from one vocabulary to the next: a function that finds the places to rewrite in a document."""

MIGRATIONS: Mapping[int, Sequence[Migration]] = {}
"""The migrations from each vocabulary to the next, by the older number. There is one vocabulary so far."""


def upgraded(
    files: Mapping[str, bytes],
    migrations: Mapping[int, Sequence[Migration]] = MIGRATIONS,
    vocabulary: int = VOCABULARY,
) -> tuple[dict[str, bytes], list[Rewriting]]:
    """Return the files of a project in `vocabulary`, and the rewritten places, as they were before.

    lumen.yaml then has the new number. Raises UsageError if a file can't be read, if the files have a newer vocabulary,
    or if they use both the old and the new form of a word.
    """
    now, done = dict(files), list[Rewriting]()
    said = _said(_document(now, MAIN_FILE))
    if said > vocabulary:
        raise UsageError(
            f"{MAIN_FILE} is written for vocabulary {said}, but this Lumen supports {vocabulary}: install a newer Lumen"
        )
    for number in range(said, vocabulary):
        for migration in migrations.get(number, ()):
            for file in sorted(file for file in now if file.endswith(".yaml")):
                rewritings = list(dict.fromkeys(migration(_document(now, file))))
                now[file] = edited(now[file], [Edit(each.place, each.text) for each in rewritings])
                done += rewritings
    line_break = "\r\n" if b"\r\n" in now[MAIN_FILE] else "\n"
    if (last := _numbered(_document(now, MAIN_FILE), vocabulary, line_break)) is not None:
        now[MAIN_FILE] = edited(now[MAIN_FILE], [Edit(last.place, last.text)])
        done.append(last)
    return now, done


def renamed_key(files: str, path: Sequence[str], name: str) -> Migration:
    """Return a migration that renames a key in the files that match the pattern `files`, at every matching path.

    A `*` in `path` matches any single step. The migration raises UsageError if a map has both the old and the new key.
    """

    def migrate(document: Document) -> Iterator[Rewriting]:
        if not PurePosixPath(document.file).match(files):
            return
        for node, span in document.spans.items():
            if span.key and _fits(node, path):
                if (*node[:-1], name) in document.spans:
                    where = f"{document.file}:{span.key.line}"
                    raise UsageError(
                        f"{where}: `{node[-1]}` is now called `{name}`, but the file has both: delete one of them"
                    )
                yield Rewriting(span.key, f"`{node[-1]}` is now called `{name}`", name)

    return migrate


def _fits(node: NodePath, path: Sequence[str]) -> bool:
    return len(node) == len(path) and all(want in ("*", step) for step, want in zip(node, path, strict=True))


def _document(files: Mapping[str, bytes], file: str) -> Document:
    document = parse(file, files[file])[0] if file in files else None
    if document is None:
        raise UsageError(f"{file} can't be read, so nothing is rewritten: run `lumen lint` to see why")
    return document


def _said(main: Document) -> int:
    said = main.data.get(VOCABULARY_KEY, FIRST_VOCABULARY) if isinstance(main.data, Mapping) else None
    if type(said) is not int or said < FIRST_VOCABULARY:
        raise UsageError(f"the vocabulary in {MAIN_FILE} is invalid: run `lumen lint` to see why")
    return said


def _numbered(main: Document, vocabulary: int, line_break: str) -> Rewriting | None:
    """Return the rewriting that writes the number into lumen.yaml; None if it is there already.

    Raises UsageError if lumen.yaml is empty, or its first key is inside braces with other content before it.
    """
    said = main.data.get(VOCABULARY_KEY)
    if said == vocabulary:
        return None
    if said is not None:
        return Rewriting(main.place((VOCABULARY_KEY,)), f"the vocabulary is now {vocabulary}", str(vocabulary))
    first = next(iter(main.data), None)
    if first is None:
        raise UsageError(f"{MAIN_FILE} is empty: run `lumen lint` to see what is missing")
    key = main.place((first,), key=True)
    ahead = lines_of(main.text)[key.line - 1][: key.column - 1].strip("\ufeff ")
    if ahead.strip("{ "):
        raise UsageError(
            f"{MAIN_FILE} can't be rewritten automatically: write `{VOCABULARY_KEY}: {vocabulary}` as its first key"
        )
    after = ", " if ahead else line_break + " " * (key.column - 1)
    place = key._replace(end_line=key.line, end_column=key.column)
    return Rewriting(place, f"the vocabulary is now {vocabulary}", f"{VOCABULARY_KEY}: {vocabulary}{after}")
