"""A new wording of a sentence that the robot says, written into its file; all other bytes of the file stay the same."""

import copy
import json
import re
import textwrap
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

from lumen.errors import UsageError
from lumen.features.console.written_sentences import MARKDOWN, WrittenSentence, path_in, texts_of, version_of, written
from lumen.language.diagnostics import Diagnostic, NodePath, Place, Severity
from lumen.lint import check_files
from lumen.lint.fixes.edits import Edit, FileText, edited
from lumen.lint.new_language import beside
from lumen.project.building import draft
from lumen.project.files import read_files
from lumen.project.project_folders import STORIES
from lumen.project.yaml_reader import parse
from lumen.run.new_passage import check_language, one_line
from lumen.upkeep.replacing import replace_file

WIDTH = 110
"""The maximum line width of a folded text [characters]."""
MAX_STORIES = 10
_PLAIN = re.compile(r"[^\W\d_][\w ]*[\w.!]")
"""Matches a text that needs no quotes, even between brackets."""
_WORDS = frozenset(("null", "true", "false", "yes", "no", "on", "off"))
_FOLDED = re.compile(r">[-+]?\s*")


class NewWording(NamedTuple):
    """The new texts of a sentence in a file."""

    file: str
    around: NodePath
    """The path of the node that contains the sentence."""
    alternative: int | None
    version: str
    """The version of the file that the author saw."""
    texts: Mapping[str, str]
    """The new texts by language."""

    @classmethod
    def read(cls, data: Mapping[str, Any]) -> Self:
        """Return the wording that a page sent. Raises UsageError if it is malformed."""
        match data:
            case {"file": str(file), "around": list(around), "version": str(version), "texts": dict(texts), **more}:
                pass
            case _:
                raise UsageError("`file`, `around`, `version` and `texts` must be those of the sentence")
        number = more.get("alternative")
        if not all(isinstance(step, str | int) for step in around) or not isinstance(number, int | None):
            raise UsageError("`file`, `around`, `version` and `texts` must be those of the sentence")
        return cls(file, tuple(around), number, version, {str(key): str(text) for key, text in texts.items()})


def reword(root: Path, robot: str, wanted: NewWording, *, write: bool) -> dict[str, Any]:
    """Check a new wording, and save it if `write` and no error is found; return what lint and the stories report.

    Raises UsageError if the file has changed or lacks the sentence, a text is invalid, or the file can't be written.
    """
    files = read_files(root, robot)
    content = bytes(files.get(wanted.file, b""))
    if version_of(content) != wanted.version:
        raise UsageError(f"{wanted.file} has changed in the meantime: open the sentence again")
    found = draft(files)
    one = next(
        (
            one
            for one in written(found)
            if (one.file, one.around, one.alternative) == (wanted.file, wanted.around, wanted.alternative)
        ),
        None,
    )
    if one is None:
        raise UsageError(f"{wanted.file} has no such sentence: open it again")
    if wanted.file.endswith(MARKDOWN):
        raise UsageError(f"the console can't edit a text in Markdown: open {wanted.file} in an editor")
    languages = tuple(found.settings.languages) if found.settings else ()
    before = texts_of(one, languages)
    texts = _checked(before, wanted.texts)
    after = reworded(one, content, texts) if texts else content
    findings = _new_findings(root, files, {**files, wanted.file: after}) if texts else []
    faulty = any(each.severity is Severity.ERROR for each in findings)
    if write and texts and not faulty:
        _save(root / wanted.file, wanted.file, content, after)
    return {
        "file": one.file,
        "line": one.report.document.place(one.path).line,
        "version": version_of(after),
        "written": bool(write and texts and not faulty),
        "faulty": faulty,
        "findings": [each.to_json() for each in findings],
        "changes": [{"language": key, "was": before[key], "now": text} for key, text in texts.items()],
        "stories": _stories(files, [before[key] for key in texts if before[key]]),
    }


def _checked(before: Mapping[str, str], wanted: Mapping[str, str]) -> dict[str, str]:
    """Return the changed texts by language. Raises UsageError for an invalid or removed text or an unknown language."""
    found = {}
    for language, text in wanted.items():
        if language not in before:
            raise UsageError(f"the sentence has no text in `{language}` that can be edited here")
        if language:
            check_language(language)
        if not before[language] and not text.strip():
            continue
        line = one_line(text, "text")
        if line != " ".join(before[language].split()):
            found[language] = line
    return found


def reworded(one: WrittenSentence, content: bytes, texts: Mapping[str, str]) -> bytes:
    """Return the file with the new texts of a sentence, by language.

    Raises UsageError if the file's formatting does not allow it.
    """
    text, document = FileText(one.file, content), one.report.document
    expected, edits = copy.deepcopy(document.data), list[Edit]()
    for language, said in texts.items():
        path = path_in(one, language)
        if path is not None:
            edits.append(_edit(text, document.spans[path].value, said))
            _put(expected, path, said)
        else:
            last = (*one.around, [*document.find(one.around)][-1])
            edits.append(
                beside(one.report, text, one.around, last, f"{language}: {json.dumps(said, ensure_ascii=False)}")
            )
            _put(expected, (*one.around, language), said)
    after = edited(content, edits)
    read, found = parse(one.file, after)
    if found or read is None or _folded(read.data) != _folded(expected):
        line = document.place(one.path).line
        raise UsageError(f"the console can't edit this text because of how the file is written: open {one.file}:{line}")
    return after


def _edit(text: FileText, place: Place, said: str) -> Edit:
    """Return the edit that replaces a text, keeping its plain or folded style if possible; else the text is quoted."""
    first = text.line(place.line)[place.column - 1 :]
    if first[:1] not in (">", "|"):
        plain = first[:1] not in ("'", '"') and _PLAIN.fullmatch(said) and said.lower() not in _WORDS
        return Edit(place, said if plain else json.dumps(said, ensure_ascii=False))
    last = place.end_line
    while last > place.line and not text.line(last)[: place.end_column - 1 if last == place.end_line else None].strip():
        last -= 1
    whole = Place(place.file, place.line, place.column, last, len(text.line(last)) + 1)
    if not _FOLDED.fullmatch(first):
        return Edit(whole, json.dumps(said, ensure_ascii=False))
    inner = next((line for n in range(place.line + 1, last + 1) if (line := text.line(n)).strip()), "")
    indent = " " * (len(inner) - len(inner.lstrip()))
    lines = textwrap.wrap(said, WIDTH - len(indent), break_long_words=False, break_on_hyphens=False)
    return Edit(whole, "\n".join([first.strip(), *(indent + line for line in lines)]))


def _put(data: Any, path: NodePath, value: str) -> None:
    for step in path[:-1]:
        data = data[step]
    data[path[-1]] = value


def _folded(data: Any) -> Any:
    """Return the data with all whitespace in texts replaced by single blanks, because line breaks do not matter."""
    match data:
        case dict():
            return {key: _folded(value) for key, value in data.items()}
        case list():
            return [_folded(value) for value in data]
        case str():
            return " ".join(data.split())
    return data


def _new_findings(root: Path, before: Mapping[str, bytes], after: Mapping[str, bytes]) -> list[Diagnostic]:
    """Return the findings that lint reports only after the change, errors first."""

    def known(found: Iterable[Diagnostic]) -> set[tuple[str, str, str]]:
        return {(each.code, each.message, each.place.file) for each in found}

    earlier = known(check_files(root, before)[1])
    new = [each for each in check_files(root, after)[1] if not known([each]) & earlier]
    return sorted(new, key=lambda each: (each.severity is not Severity.ERROR, each.place))


def _stories(files: Mapping[str, bytes], texts: Iterable[str]) -> list[str]:
    """Return up to MAX_STORIES stories that contain an old text, because they probably expect it."""
    old = [text.encode() for text in texts]
    found = (file for file, content in files.items() if file.startswith(f"{STORIES}/"))
    return [file for file in sorted(found) if any(text in files[file] for text in old)][:MAX_STORIES]


def _save(path: Path, file: str, before: bytes, after: bytes) -> None:
    """Replace the file in one step. Raises UsageError if it has changed since it was read, or can't be written."""
    try:
        if path.is_symlink():
            raise UsageError(f"{file} is a symbolic link: open it in an editor")
        if path.read_bytes() != before:
            raise UsageError(f"{file} has changed in the meantime: open the sentence again")
        replace_file(path, after)
    except OSError as error:
        raise UsageError(f"{file} can't be written: {(error.strerror or str(error)).lower()}") from None
