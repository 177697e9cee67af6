"""Sentences that operators keep for the robot to say, shared by all browsers that show the project.

They are stored as `prepared_sentences.json` in the project's state folder. They are not in lumen.yaml, because
operators add them during the day, and only an author can make a changed file active.
"""

from pathlib import Path
from typing import Any, NamedTuple

import orjson
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from lumen.errors import UsageError
from lumen.features.console.people import Role
from lumen.features.console.requests import DeniedError, Reception, as_json
from lumen.project.home import home_of
from lumen.run.new_passage import check_language, one_line
from lumen.upkeep.own_folders import private_folder, write_private

PREPARED_FILE = "prepared_sentences.json"
MAX_SENTENCES = 100
MAX_BYTES = 1 << 20
"""The maximum size of the file [bytes]; a larger one counts as broken."""


class PreparedSentence(NamedTuple):
    """A text, and the code of the language in which the robot says it."""

    text: str
    language: str


class PreparedSentences:
    """The prepared sentences of the project in `root`, and their path `/api/prepared`."""

    def __init__(self, reception: Reception, root: Path) -> None:
        self._reception, self._file = reception, home_of(root) / PREPARED_FILE
        self.routes = [Route("/api/prepared", self._listed), Route("/api/prepared", self._changed, methods=["POST"])]

    def all(self) -> list[PreparedSentence]:
        """Return the kept sentences in their order; an empty list if the file is missing.

        Raises UsageError if it is broken or can't be read.
        """
        try:
            if self._file.stat().st_size > MAX_BYTES:
                raise ValueError
            return [
                PreparedSentence(str(one["text"]), str(one["language"]))
                for one in orjson.loads(self._file.read_bytes())
            ]
        except FileNotFoundError:
            return []
        except (ValueError, TypeError, KeyError):
            raise UsageError(f"{self._file} is broken: delete it, and keep the sentences again") from None
        except OSError as error:
            raise UsageError(f"{self._file} can't be read: {error.strerror}") from None

    def keep(self, sentence: PreparedSentence) -> list[PreparedSentence]:
        """Add a sentence at the end, unless it is kept already; return all.

        Raises UsageError if the sentence is invalid, `MAX_SENTENCES` are kept, or the file can't be read or written.
        """
        check_language(sentence.language)
        one, before = PreparedSentence(one_line(sentence.text, "text"), sentence.language), self.all()
        if one in before:
            return before
        if len(before) >= MAX_SENTENCES:
            raise UsageError(f"{MAX_SENTENCES} sentences are kept already: remove one first")
        return self._write([*before, one])

    def remove(self, sentence: PreparedSentence) -> list[PreparedSentence]:
        """Remove a sentence if it is kept, and return the others.

        Raises UsageError if the file can't be read or written.
        """
        return self._write([one for one in self.all() if one != sentence])

    def _write(self, sentences: list[PreparedSentence]) -> list[PreparedSentence]:
        try:
            private_folder(self._file.parent)
            write_private(self._file, orjson.dumps([one._asdict() for one in sentences], option=orjson.OPT_INDENT_2))
        except OSError as error:
            raise UsageError(f"{self._file} can't be written: {error.strerror}") from None
        return sentences

    async def _listed(self, request: Request) -> Response:
        self._reception.person(request, Role.OPERATOR)
        try:
            return _as_answer(self.all())
        except UsageError as error:
            raise DeniedError(500, str(error)) from None

    async def _changed(self, request: Request) -> Response:
        self._reception.person(request, Role.OPERATOR)
        data: dict[str, Any] = await self._reception.posted(request)
        if not isinstance(keep := data.get("keep"), bool):
            raise DeniedError(400, "`keep` must be true or false")
        sentence = PreparedSentence(str(data.get("text", "")), str(data.get("language", "")))
        try:
            return _as_answer(self.keep(sentence) if keep else self.remove(sentence))
        except UsageError as error:
            raise DeniedError(400, str(error)) from None


def _as_answer(sentences: list[PreparedSentence]) -> Response:
    return as_json({"prepared": [one._asdict() for one in sentences]})
