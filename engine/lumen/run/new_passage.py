"""An unanswered question that becomes a passage: a file in knowledge/, loaded like any saved file."""

import os
import re
import unicodedata
from collections.abc import Mapping
from pathlib import Path

import yaml

from lumen.errors import UsageError
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.language.language_tags import is_language_tag

MAX_TEXT = 1_000
"""The greatest length of a question or an answer [characters]."""
MAX_NAME = 40
"""The greatest length of a file's name before its number [characters]."""
MAX_SAME = 100
"""The greatest number of files with the same name before their numbers."""
HEADER = "# yaml-language-server: $schema=../schemas/knowledge.schema.json\n\n"


def write_passage(
    root: Path, question: str, answer: str, language: str, also: Mapping[str, tuple[str, str]] | None = None
) -> Path:
    """Write a passage for a question and its answer; return its file, relative to the project's folder.

    `also` has the question and the answer in other languages. No file is overwritten. Raises UsageError if a question,
    answer or language is invalid, or the folder can't be written.
    """
    pairs = {language: (question, answer), **(also or {})}
    questions, answers = dict[str, list[str]](), dict[str, str]()
    for code, (asked, answered) in pairs.items():
        check_language(code)
        questions[code], answers[code] = [one_line(asked, "question")], one_line(answered, "answer")
    question = questions[language][0]
    data = {"questions": questions, "answer": answers}
    text = HEADER + yaml.safe_dump(data, allow_unicode=True, sort_keys=False, width=110)
    folder = root / KNOWLEDGE_FOLDER
    try:
        folder.mkdir(exist_ok=True)
        if folder.is_symlink():
            raise UsageError(f"{KNOWLEDGE_FOLDER}/ is a symbolic link: replace it with a folder")
        for name in _names(question):
            file = folder / f"{name}.yaml"
            if not file.with_suffix(".md").exists() and create_file(file, text):
                return file.relative_to(root)
    except OSError as error:
        raise UsageError(f"{KNOWLEDGE_FOLDER}/ can't be written: {error.strerror}") from None
    raise UsageError(f"{MAX_SAME} passages already have this name: rename some of them")


def check_language(language: str) -> None:
    """Raise UsageError if a text is not a language code."""
    if not is_language_tag(language):
        raise UsageError("`language` must be a code such as `en`")


def one_line(text: str, what: str) -> str:
    """Return a text on one line, without control characters. Raises UsageError if it is empty or too long.

    Invisible characters that format text stay: Persian and Hindi need those that join letters or keep them apart.
    """
    kept = (sign if sign.isprintable() or unicodedata.category(sign) == "Cf" else " " for sign in text)
    line = " ".join("".join(kept).split())
    if not any(sign.isalnum() for sign in line) or len(line) > MAX_TEXT:
        raise UsageError(f"`{what}` must be a string of 1 to {MAX_TEXT} characters")
    return line


def _names(question: str) -> list[str]:
    plain = unicodedata.normalize("NFKD", question.casefold()).encode("ascii", "ignore").decode()
    name = "-".join(re.findall(r"[a-z0-9]+", plain))[:MAX_NAME].strip("-") or "question"
    return [name, *(f"{name}-{number}" for number in range(2, MAX_SAME + 1))]


def create_file(file: Path, text: str) -> bool:
    """Write a new file; return False if it exists.

    If writing fails, no part of the file is left, and OSError is raised.
    """
    try:
        held = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
    except FileExistsError:
        return False
    try:
        with open(held, "w", encoding="utf-8") as opened:
            opened.write(text)
    except OSError:
        file.unlink(missing_ok=True)
        raise
    return True
