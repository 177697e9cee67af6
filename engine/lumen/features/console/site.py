"""The console's paths: pages, events, commands, and sign-in."""

import re
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import orjson
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from lumen.errors import UsageError
from lumen.features.console.access import COOKIE, MAX_NAME, SESSION_TIME, Access, TooFastError
from lumen.features.console.commands import Commands, PageCommand
from lumen.features.console.fleet_pages import FleetPages
from lumen.features.console.jobs import Jobs
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.orders import NEEDS, REST
from lumen.features.console.past import Past
from lumen.features.console.people import Person, Role
from lumen.features.console.prepared_sentences import PreparedSentences
from lumen.features.console.requests import ALL, NO_STORE, DeniedError, Reception, address_of, as_json, say_why_not
from lumen.features.console.sentences import Sentences
from lumen.features.console.sights import STREAM, Sights
from lumen.features.console.streams import Listener, Streams, positions_in
from lumen.features.console.watch import Watch
from lumen.language.iso_time import iso_time
from lumen.project.project_folders import FLEET_FILE

PAGES = Path(__file__).parent / "pages"
MAX_STREAMS = 300
"""The maximum number of streams that all pages together may have open."""
_ID = re.compile(r"[A-Za-z0-9._:-]{1,100}")


class Site:
    """The console's site for the robots of a watch and the project in `root`; `app` is the ASGI application."""

    def __init__(self, watch: Watch, access: Access, root: Path) -> None:
        self.watch, self.access, self._root = watch, access, root
        self.streams, self.reception = Streams(watch), Reception(watch, access)
        self.commands = Commands(watch, self.streams)
        jobs = Jobs(root)
        self.sights, past = Sights(self.reception, jobs), Past(self.reception, jobs)
        self.app = Starlette(
            routes=[
                Route("/", self._shell),
                Route("/robot/{robot}", self._shell),
                Route("/robot/{robot}/{page}", self._shell),
                Route("/fleet", self._shell),
                Route("/api/now", self._now),
                Route("/api/events", self._events),
                Route("/api/commands", self._command, methods=["POST"]),
                Route("/api/session", self._session, methods=["POST", "DELETE"]),
                *past.routes,
                *FleetPages(self.reception).routes,
                *self.sights.routes,
                *Sentences(self.reception, jobs, past).routes,
                *PreparedSentences(self.reception, root).routes,
                Mount("/pages", StaticFiles(directory=PAGES)),
            ],
            exception_handlers={HTTPException: say_why_not, DeniedError: say_why_not, Exception: say_why_not},
            lifespan=self._living,
        )

    def close(self) -> None:
        """End all streams."""
        self.streams.close()
        self.sights.close()

    @asynccontextmanager
    async def _living(self, _: Starlette) -> AsyncIterator[None]:
        self.watch.start()
        yield
        await self.watch.close()

    async def _shell(self, request: Request) -> Response:
        return FileResponse(PAGES / "shell.html")

    async def _now(self, request: Request) -> Response:
        person = self.reception.person(request)
        full = person.role > Role.NOBODY
        robots = [view.to_json(full=full) for _, view in sorted(self.watch.robots.items())]
        told = {
            "role": person.role.word,
            "name": person.name,
            "time": iso_time(time.time()),
            "bus": self.watch.link.trouble,
        }
        return as_json({"robots": robots, **told, "fleet": (self._root / FLEET_FILE).is_file()})

    async def _events(self, request: Request) -> Response:
        full = self.reception.person(request).role > Role.NOBODY
        robot = request.query_params.get("robot", "")
        after = request.headers.get("last-event-id") or request.query_params.get("after", "")
        if self.watch.lookers >= MAX_STREAMS:
            raise DeniedError(503, f"{MAX_STREAMS} pages are open already: close some")
        who = Listener(robot, positions_in(after, robot), full, "once" in request.query_params)
        return StreamingResponse(self.streams.events(who), media_type=STREAM, headers=NO_STORE)

    async def _command(self, request: Request) -> Response:
        data = await self.reception.posted(request)
        id, name = data.get("id"), data.get("command")
        if not isinstance(name, str) or name not in NEEDS:
            raise DeniedError(400, f"`command` must be one of {', '.join(NEEDS)}")
        rests = name == REST
        person = self.reception.resting(request) if rests else self.reception.person(request, NEEDS[name])
        if not isinstance(id, str) or not _ID.fullmatch(id):
            raise DeniedError(400, "`id` must be 1 to 100 letters, digits or . _ : -; use a new one for each command")
        robot = self._meant(data.get("robot"), rests=rests)
        if person.role == Role.SHOW and name == "event":
            _check_button(self.reception.robot(robot), data)
        try:
            command = self.commands.send(id, robot, name, data, person)
        except UsageError as error:
            raise DeniedError(400, str(error)) from None
        await command.sent.wait()
        headers = {"Lumen-State": "unsent" if command.state == "unsent" else "sent", **NO_STORE}
        return StreamingResponse(_outcome(command), media_type="application/json", headers=headers)

    def _meant(self, robot: object, *, rests: bool) -> str:
        """Return the addressed robot's name, or ALL. Only a command to rest can address ALL or an unknown robot."""
        known = self.watch.link.reached is not None and self.watch.robots
        if rests and (robot == ALL or (not known and isinstance(robot, str) and robot)):
            return str(robot)
        if rests and not robot:
            return ALL
        return self.reception.robot(robot).robot

    async def _session(self, request: Request) -> Response:
        encrypted = request.url.scheme == "https"  # a cookie set over HTTPS must never be sent unencrypted
        if request.method == "DELETE":
            self.access.end(request.cookies.get(COOKIE, ""))
            gone = as_json({"role": self.reception.person(request).role.word if not self.access.pins else "nobody"})
            gone.delete_cookie(COOKIE, httponly=True, samesite="strict", secure=encrypted)
            return gone
        data = await self.reception.posted(request)
        pin, name = data.get("pin"), data.get("name") or ""
        if not isinstance(pin, str) or not isinstance(name, str) or len(name) > MAX_NAME:
            raise DeniedError(400, f"`pin` must be a string, and `name` a string of at most {MAX_NAME} characters")
        self.reception.person(request)
        try:
            role = self.access.role(address_of(request), pin) if self.access.pins else Role.AUTHOR
        except TooFastError as error:
            raise DeniedError(429, str(error), **{"Retry-After": str(error.wait)}) from None
        if not role:
            raise DeniedError(401, "no role has this PIN")
        shown = "".join(sign for sign in name if sign.isprintable()).strip()
        answer = as_json({"role": role.word, "name": shown})
        cookie = self.access.sign(Person(role, shown))
        lasts = int(SESSION_TIME)
        answer.set_cookie(COOKIE, cookie, max_age=lasts, httponly=True, samesite="strict", secure=encrypted)
        return answer


def _check_button(view: KnownRobot, data: dict[str, object]) -> None:
    """Raise DeniedError unless a button of the active states sends this event."""
    buttons = view.said.get("buttons")
    for button in buttons if isinstance(buttons, list) else ():
        if button.get("event") == data.get("event") and (button.get("data") or {}) == (data.get("data") or {}):
            return
    raise DeniedError(403, "the role `show` may only press the buttons on the page: sign in as operator")


async def _outcome(command: PageCommand) -> AsyncIterator[bytes]:
    await command.over.wait()
    yield orjson.dumps(command.to_json())
