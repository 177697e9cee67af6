"""A stand-in for social media, which writes each post as a line of a file."""

import json
import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Self

from lumen.errors import ModuleError
from lumen.language.iso_time import iso_time
from lumen.language.modules import SOCIAL
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.ports import Bus, Message, MessageHandler
from lumen.project.json_lines import forget_lines
from lumen.run.module import Module
from lumen.upkeep.own_folders import private_folder

POSTS_FILE = "posts.jsonl"
MAX_FILE_BYTES = 10_000_000
"""The file size [bytes] above which no post is written until the file is moved away."""


class Social(Module):
    """Accepts posts from `lumen.NAO.social.expression`, and confirms them on `.perception`.

    Each post is written to `file` as a line of JSON; None keeps nothing. A real module would publish the posts instead.
    """

    name = SOCIAL

    @classmethod
    def make(cls, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Self:
        """Make the module with its file in `folder`, or without a file if `folder` is None."""
        return cls(project, bus, tell, folder and folder / POSTS_FILE)

    def __init__(self, project: Project, bus: Bus, tell: Callable[[str], None], file: Path | None) -> None:
        super().__init__(project, bus, tell)
        self._file = file

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the message handlers by route."""
        return {"social_expression": self._post, "forgotten": self._forget}

    def _post(self, message: Message) -> None:
        match message.body:
            case {"text": str(text)} if text.strip():
                pass
            case _:
                raise ModuleError(f"a message on {message.key} needs a `text`: nothing was posted")
        date = iso_time(time.time(), "seconds", offset=True)
        self._write(json.dumps({"date": date, **message.body}, ensure_ascii=False))
        self.publish("social_perception", {"kind": "posted", "text": text, "date": date})
        self.well()

    def _forget(self, message: Message) -> None:
        """Delete the posts that name a forgotten person."""
        match message.body:
            case {"name": str(name)} if self._file:
                forget_lines(self._file, PersonName(name))

    def _write(self, line: str) -> None:
        if self._file is None:
            return
        try:
            private_folder(self._file.parent)
            with open(os.open(self._file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600), "ab") as file:
                if file.tell() > MAX_FILE_BYTES:
                    raise ModuleError(f"{self._file} is full: move it away so that new posts can be kept")
                file.write(line.encode("utf-8", "replace") + b"\n")
        except OSError as error:
            raise ModuleError(f"{self._file} cannot be written: {error.strerror}") from None
