"""Reads chat completions of `/v1/chat/completions`, streamed or whole."""

import json
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from lumen.errors import ModuleError

MAX_ARGUMENTS = 5_000
"""The maximum length of a call's arguments [characters]."""
END = "[DONE]"


class Piece(NamedTuple):
    """Some text of a completion, or its regular end (`ended`); a completion that was cut off has no end."""

    text: str = ""
    ended: bool = False


class Call(NamedTuple):
    """The model's call of a tool; its arguments are JSON text or, from some servers, an object."""

    name: str
    arguments: Any


class Chat:
    """Reads one completion; `calls` are complete after its end."""

    def __init__(self) -> None:
        self._names: dict[int, str] = {}
        self._arguments: dict[int, Any] = {}

    @property
    def calls(self) -> list[Call]:
        """The calls of tools read so far, in order."""
        return [Call(name, self._arguments.get(at, "")) for at, name in sorted(self._names.items())]

    def read(self, kind: str, pieces: Iterable[bytes]) -> Iterator[Piece]:
        """Yield the text piece by piece; `kind` is the response's media type, and `pieces` is its content.

        Raises ModuleError if the content is not a chat completion.
        """
        if kind == "text/event-stream":
            for data in _events(pieces):
                if data.strip() == END:
                    yield Piece(ended=True)
                    return
                yield from self._choice(_json(data), "delta")
        else:
            yield from self._choice(_json(b"".join(pieces).decode("utf-8", "replace")), "message")

    def _choice(self, data: Any, key: str) -> Iterator[Piece]:
        choices = data.get("choices") if isinstance(data, dict) else None
        if not isinstance(choices, list):
            raise ModuleError("the language model's answer is not a chat completion")
        for choice in choices[:1]:
            said = choice.get(key) if isinstance(choice, dict) else None
            if isinstance(said, dict):
                for at, call in enumerate(said.get("tool_calls") or ()):
                    self._call(at, call)
                if isinstance(text := said.get("content"), str) and text:
                    yield Piece(text)
            if isinstance(choice, dict) and choice.get("finish_reason"):
                yield Piece(ended=True)

    def _call(self, at: int, call: Any) -> None:
        made = call.get("function") if isinstance(call, dict) else None
        if not isinstance(made, dict):
            return
        at = call["index"] if type(call.get("index")) is int else at
        if isinstance(name := made.get("name"), str) and name:
            self._names[at] = name
        arguments = made.get("arguments")
        if isinstance(arguments, str) and isinstance(before := self._arguments.get(at, ""), str):
            self._arguments[at] = (before + arguments)[: MAX_ARGUMENTS + 1]
        elif arguments is not None:
            self._arguments[at] = arguments


def _events(pieces: Iterable[bytes]) -> Iterator[str]:
    """Yield the data of server-sent events; an incomplete event at the end is ignored."""
    held, data = b"", list[str]()
    for piece in pieces:
        *lines, held = (held + piece).split(b"\n")
        for line in lines:
            text = line.rstrip(b"\r").decode("utf-8", "replace")
            if text.startswith("data:"):
                data.append(text[5:].removeprefix(" "))
            elif not text and data:
                yield "\n".join(data)
                data = []


def _json(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise ModuleError("the language model's answer is not JSON") from None
