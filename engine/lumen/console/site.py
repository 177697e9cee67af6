"""The console's paths: pages, what happens, and commands."""

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import orjson
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from lumen.console.commands import ALL, SENT, Commands, PageCommand
from lumen.console.gate import json_object, refused
from lumen.console.known_robot import iso_now
from lumen.console.orders import NEEDS
from lumen.console.people import Person, Role
from lumen.console.streams import Listener, Streams, positions_in
from lumen.console.watch import Watch
from lumen.errors import UsageError

PAGES = Path(__file__).parent / "pages"
STREAM = "text/event-stream"
_ID = re.compile(r"[A-Za-z0-9._:-]{1,100}")


class Site:
    """Answers requests from a watch; `app` is what serves them."""

    def __init__(self, watch: Watch) -> None:
        self.watch, self.streams = watch, Streams(watch)
        self.commands = Commands(watch, self.streams)
        self.app = Starlette(
            routes=[
                Route("/", self._shell),
                Route("/robot/{robot}", self._shell),
                Route("/robot/{robot}/{page}", self._shell),
                Route("/api/now", self._now),
                Route("/api/events", self._events),
                Route("/api/commands", self._command, methods=["POST"]),
                Mount("/pages", StaticFiles(directory=PAGES)),
            ],
            exception_handlers={HTTPException: _http_error, Exception: _our_error},
            lifespan=self._living,
        )

    @asynccontextmanager
    async def _living(self, _: Starlette) -> AsyncIterator[None]:
        self.watch.start()
        yield
        await self.watch.close()

    def person(self, request: Request) -> Person:
        """Who asks."""
        return Person(Role.AUTHOR)

    async def _shell(self, request: Request) -> Response:
        return FileResponse(PAGES / "shell.html")

    async def _now(self, request: Request) -> Response:
        person = self.person(request)
        full = person.role > Role.NOBODY
        robots = [view.to_json(full=full) for _, view in sorted(self.watch.robots.items())]
        return _json({"robots": robots, "role": person.role.word, "time": iso_now(), "bus": self.watch.link.trouble})

    async def _events(self, request: Request) -> Response:
        robot = request.query_params.get("robot", "")
        after = request.headers.get("last-event-id") or request.query_params.get("after", "")
        who = Listener(robot, positions_in(after, robot), self.person(request).role > Role.NOBODY)
        return StreamingResponse(self.streams.events(who), media_type=STREAM, headers={"Cache-Control": "no-store"})

    async def _command(self, request: Request) -> Response:
        try:
            data = json_object(await request.body())
            id, robot, name = (data.get(key) for key in ("id", "robot", "command"))
            if not isinstance(id, str) or not _ID.fullmatch(id):
                raise UsageError("`id` is 1 to 100 letters, digits or . _ : -, the same where it is the same command")
            if not isinstance(name, str) or name not in NEEDS:
                raise UsageError(f"`command` is one of {', '.join(NEEDS)}")
            person = self.person(request)
            if person.role < NEEDS[name]:
                return refused(403, f"`{name}` is for the role {NEEDS[name].word}: sign in with its PIN")
            command = self.commands.send(id, self._robot(robot, name), name, data, person)
        except (UsageError, ValueError) as error:
            return refused(400, str(error))
        await command.sent.wait()
        headers = {"Lumen-State": SENT if command.state != "unsent" else "unsent", "Cache-Control": "no-store"}
        return StreamingResponse(_outcome(command), media_type="application/json", headers=headers)

    def _robot(self, name: object, command: str) -> str:
        """The robot that is meant; where there is one only it need not be named. Raises UsageError."""
        known = sorted(self.watch.robots)
        if not name and len(known) == 1:
            return known[0]
        if name == ALL and command == "rest":
            return ALL
        if not isinstance(name, str) or (name not in known and known):
            raise UsageError(f"`robot` is one of {', '.join(known) or 'none that is known yet'}")
        return name


async def _outcome(command: PageCommand) -> AsyncIterator[bytes]:
    await command.over.wait()
    yield orjson.dumps(command.to_json())


def _json(data: Any, status: int = 200) -> Response:
    headers = {"Cache-Control": "no-store"}
    return Response(orjson.dumps(data), status, headers=headers, media_type="application/json")


async def _http_error(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    reason = {404: "there is nothing under that path", 405: "that path does not take this method"}
    return refused(error.status_code, reason.get(error.status_code, str(error.detail)))


async def _our_error(request: Request, error: Exception) -> Response:
    return refused(500, "the console failed on that; its terminal says more")
