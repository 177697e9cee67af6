"""The paths about what was, and what would be: why, why not, days, entries, files, and a fork."""

import asyncio
from collections.abc import Callable
from datetime import date
from pathlib import Path
from time import monotonic
from typing import Any

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from lumen.app.answering import WHY, WHY_NOT
from lumen.app.recalling import answer_from_journal
from lumen.app.replaying.journals import chosen
from lumen.app.replaying.kept_bundles import KeptBundles
from lumen.app.replaying.other_files import against
from lumen.console.day import Day
from lumen.console.day_csv import day_csv
from lumen.console.journal_source import JournalSource
from lumen.console.known_robot import KnownRobot
from lumen.console.people import Role
from lumen.console.requests import NO_STORE, DeniedError, Reception, as_json
from lumen.errors import BusError, LumenError
from lumen.loading.files import read_files
from lumen.rules import check_files

QUESTION_TIMEOUT = 20.0
"""How long an exhibition may take for a question about the past [s]."""
WORK_TIMEOUT = 60.0
"""How long what is computed here may take [s]."""
REPLAY_TIME = 10.0
"""How long visits are played with the saved files [s]; the others are said to be unknown."""
MAX_QUESTION = 500


class Past:
    """Answers from what exhibitions tell, and from the journal of the project in `root`."""

    def __init__(self, reception: Reception, root: Path) -> None:
        self._reception, self._root = reception, root
        self._watch = reception.watch
        self._source = JournalSource(reception.watch, root)
        self._working = asyncio.Semaphore(2)
        self.routes = [
            Route("/api/why", self._why),
            Route("/api/why-not", self._why_not),
            Route("/api/fork", self._fork, methods=["POST"]),
            Route("/api/day", self._day),
            Route("/api/day.csv", self._csv),
            Route("/api/entries", self._entries),
            Route("/api/files", self._files),
        ]

    async def _why(self, request: Request) -> Response:
        return await self._explained(request, WHY)

    async def _why_not(self, request: Request) -> Response:
        return await self._explained(request, WHY_NOT)

    async def _explained(self, request: Request, question: str) -> Response:
        view = self._asked(request, Role.SHOW)
        what = request.query_params.get("what", "")[:MAX_QUESTION]
        at = request.query_params.get("at") or None
        said = await self._ask(view, {"ask": question, "what": what, **({"at": at} if at else {})})
        if said.get("kept") == "later" and self._is_ours(view):
            said = await self._computed(answer_from_journal, str(self._root), question, what, at, "it was too long ago")
        if said.get("verdict") == "refused":
            raise DeniedError(404, str(said.get("reason")))
        return as_json(said)

    async def _fork(self, request: Request) -> Response:
        self._reception.person(request, Role.OPERATOR)
        data = await self._reception.posted(request)
        view = self._reception.robot(data.get("robot"))
        asked: dict[str, Any] = {key: data[key] for key in ("at", "position", "event", "bundle") if key in data}
        said = await self._ask(view, {"ask": "fork", **asked})
        if said.get("verdict") == "refused" or "would" not in said:
            reason = said.get("reason") if said.get("verdict") == "refused" else None
            raise DeniedError(400, str(reason or "this exhibition's Lumen does not know that: it is an older one"))
        return as_json(said)

    async def _day(self, request: Request) -> Response:
        return as_json((await self._day_asked(request)).to_json())

    async def _csv(self, request: Request) -> Response:
        day = await self._day_asked(request)
        name = f'attachment; filename="lumen-{day.day.isoformat()}.csv"'
        return Response(day_csv(day), headers={**NO_STORE, "Content-Disposition": name}, media_type="text/csv")

    async def _day_asked(self, request: Request) -> Day:
        view, text = self._asked(request, Role.OPERATOR), request.query_params.get("date", "")
        try:
            wanted = date.fromisoformat(text) if text else None
        except ValueError:
            raise DeniedError(400, "`date` is a day such as 2026-11-23") from None
        found: Day | None = await self._computed(self._source.local_day, wanted) if self._is_ours(view) else None
        if found is not None:
            return found
        try:
            return await self._source.remote_day(view.robot, wanted)
        except BusError as error:
            raise DeniedError(503, f"the exhibition does not tell its day: {error}") from None

    async def _entries(self, request: Request) -> Response:
        view = self._asked(request, Role.OPERATOR)
        first, last = (request.query_params.get(name, "") for name in ("from", "to"))
        if not (first.isdigit() and last.isdigit() and len(first + last) < 36):
            raise DeniedError(400, "`from` and `to` are positions of entries: whole numbers")
        try:
            found = await self._source.entries(view, int(first), int(last))
        except BusError as error:
            raise DeniedError(503, f"the exhibition does not tell its entries: {error}") from None
        data = b'{"entries":[' + b",".join(entry.data for entry in found) + b"]}"
        return Response(data, headers=NO_STORE, media_type="application/json")

    async def _files(self, request: Request) -> Response:
        view = self._asked(request, Role.OPERATOR)
        said: dict[str, Any] = dict(view.files)
        last = said.get("last")
        changed = bool(said.get("staged")) or bool(said.get("waiting"))
        changed = changed or (isinstance(last, dict) and last.get("verdict") in ("refused", "dry run"))
        if self._is_ours(view) and changed:
            said["replay"] = await self._computed(self._replay)
        return as_json(said)

    def _replay(self) -> dict[str, Any] | None:
        """What the files on the disk would have done in the visits that are kept; None where that can't be said."""
        project = check_files(self._root, read_files(self._root))[0]
        if project is None:
            return None
        try:
            entries = chosen(self._root, None, all=True).entries()
            return against(entries, KeptBundles(self._root), project, deadline=monotonic() + REPLAY_TIME).to_json()
        except LumenError:
            return None

    def _asked(self, request: Request, needs: Role) -> KnownRobot:
        self._reception.person(request, needs)
        return self._reception.robot(request.query_params.get("robot"))

    def _is_ours(self, view: KnownRobot) -> bool:
        """Whether it is the robot of the project whose folder we know."""
        reached = self._watch.link.reached
        return reached is not None and reached.robot == view.robot

    async def _ask(self, view: KnownRobot, body: dict[str, Any]) -> dict[str, Any]:
        key = self._watch.keys.of(view.robot).operator
        try:
            said = await self._watch.exchanges.ask(key, body, QUESTION_TIMEOUT)
        except BusError as error:
            raise DeniedError(503, f"the exhibition does not answer: {error}") from None
        if not isinstance(said, dict):
            raise DeniedError(503, "the exhibition answers nothing that can be shown")
        return said

    async def _computed(self, work: Callable[..., Any], *arguments: Any) -> Any:
        """What is computed on a thread, two at a time; one that nobody waits for any more counts until it is done."""
        try:
            async with asyncio.timeout(WORK_TIMEOUT):
                await self._working.acquire()
                thread = asyncio.get_running_loop().run_in_executor(None, work, *arguments)
                thread.add_done_callback(lambda _: self._working.release())
                return await asyncio.shield(thread)
        except TimeoutError:
            raise DeniedError(503, f"that takes longer than {WORK_TIMEOUT:g} s: ask `lumen` on the terminal") from None
        except LumenError as error:
            raise DeniedError(404, str(error)) from None
