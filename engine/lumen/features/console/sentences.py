"""The path `/api/sentence`, which finds a sentence of the robot in the files and saves a new wording of it."""

from collections.abc import Mapping
from typing import Any

import orjson
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from lumen.features.console.entry_words import NOTE
from lumen.features.console.jobs import Jobs
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.past import Past
from lumen.features.console.people import Role
from lumen.features.console.requests import DeniedError, Reception, as_json
from lumen.insight.replay.entries import HOWS
from lumen.language.command_data import started
from lumen.language.operator_requests import WHY

SAID_BY_AN_OPERATOR = "says “"
ANSWER = "answer.command."
OPERATOR, MODEL, FILE, NOWHERE = "operator", "model", "file", "nowhere"
"""The sources of a sentence: an operator, a language model, a file of the project, or an unknown source."""


class Sentences:
    """Finds the robot's sentences in the files, and saves new wordings of them."""

    def __init__(self, reception: Reception, jobs: Jobs, past: Past) -> None:
        self._reception, self._jobs, self._past = reception, jobs, past
        self.routes = [Route("/api/sentence", self._found), Route("/api/sentence", self._reworded, methods=["POST"])]

    async def _found(self, request: Request) -> Response:
        """Return the sentence that an entry's command said, its source, and its places in the files."""
        view = self._past.own(self._past.asked(request, Role.AUTHOR))
        position, id = request.query_params.get("position", ""), request.query_params.get("id", "")
        if not position.isdigit() or len(position) > 18:
            raise DeniedError(400, "`position` must be the position of an entry: a whole number")
        entries = await self._past.between(view, int(position), int(position))
        entry: Mapping[str, Any] = orjson.loads(entries[0].data) if entries else {}
        if typed := _typed(entry):
            return as_json({"text": typed, "language": "", "source": OPERATOR, "places": []})
        said = _said(entry, id)
        if said is None:
            raise DeniedError(404, "the robot said nothing at this position")
        answer = _answer(entry)
        told: dict[str, Any] = {"text": said["text"], "language": said["language"]}
        if answer.get("source") == MODEL:
            return as_json({**told, "source": MODEL, "places": []})
        hint = {**await self._hint(view, said["id"], entry), "passage": str(answer.get("passage") or "")}
        places = orjson.loads(await self._jobs.do("sentence", self._past.home(view), told, hint))
        return as_json({**told, "source": FILE if places else NOWHERE, "places": places})

    async def _hint(self, view: KnownRobot, id: str, entry: Mapping[str, Any]) -> dict[str, Any]:
        """Return the file and the line of the action behind a command, as `lumen why` finds them; empty if unknown."""
        try:
            [first, *_] = (await self._past.explained(view, WHY, id, str(entry.get("at_time"))))["chain"]
        except (DeniedError, ValueError, KeyError):
            return {}
        return {"file": first["file"], "line": first["line"]} if first["file"] else {}

    async def _reworded(self, request: Request) -> Response:
        """Check a new wording, and save it if `write` is true and lint finds no error."""
        view, data = await self._past.posted(request)
        if not isinstance(write := data.get("write"), bool):
            raise DeniedError(400, "`write` must be true or false")
        return await self._past.written("wording", view, data, write)


def _typed(entry: Mapping[str, Any]) -> str:
    """Return the sentence that an operator typed; empty if the entry is about something else."""
    said = entry.get("said")
    note = str(said.get(NOTE, "")) if isinstance(said, Mapping) and "jump" in entry else ""
    return note[len(SAID_BY_AN_OPERATOR) : -1] if note.startswith(SAID_BY_AN_OPERATOR) else ""


def _said(entry: Mapping[str, Any], id: str) -> dict[str, str] | None:
    """Return the sentence that the entry's command `id` says, or its first one if `id` is empty; None without one."""
    for command in entry.get("commands", ()):
        if (begun := started(command)) and begun[1] == "Say" and id in ("", begun[0]):
            return {key: str(begun[2].get(key) or "") for key in ("text", "language")} | {"id": begun[0]}
    return None


def _answer(entry: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the data of an entry that is an answer to a visitor's question; empty for other entries."""
    data = entry.get("data")
    is_answer = any(str(entry.get(how, "")).startswith(ANSWER) for how in HOWS)
    return data if is_answer and isinstance(data, Mapping) else {}
