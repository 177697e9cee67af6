"""Code shared by the console's paths: a request's person, robot and data, and responses that refuse it."""

from typing import Any

import orjson
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from lumen.features.console.access import COOKIE, Access, TooFastError
from lumen.features.console.gate import json_object, refused
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.people import Person, Role
from lumen.features.console.watch import Watch
from lumen.upkeep.ratelimit import RateLimiter

NO_STORE = {"Cache-Control": "no-store"}
REQUESTS_PER_SECOND = 60.0
"""The rate limit of an address [1/s]; commands to rest are not counted."""
ALL = "*"
"""Used instead of a robot's name to address all robots."""


class DeniedError(Exception):
    """A refused request, with the response's HTTP status, its reason (a sentence) and its headers."""

    def __init__(self, status: int, reason: str, **headers: str) -> None:
        super().__init__(reason)
        self.status, self.reason, self.headers = status, reason, headers


class Reception:
    """Finds the person, the robot and the data of a request. Every method except `resting` raises DeniedError."""

    def __init__(self, watch: Watch, access: Access) -> None:
        self.watch, self.access, self._limiter = watch, access, RateLimiter()

    def person(self, request: Request, needs: Role = Role.NOBODY) -> Person:
        """Return the person who sends a request. Raises DeniedError for a role below `needs` or too many requests."""
        address = address_of(request)
        if self._limiter.wait(address, REQUESTS_PER_SECOND):
            raise DeniedError(429, "too many requests: wait a second. Rest always works", **{"Retry-After": "1"})
        try:
            person = self._known(request, address)
        except TooFastError as error:
            raise DeniedError(429, str(error), **{"Retry-After": str(error.wait)}) from None
        if person.role < needs:
            raise DeniedError(403 if person.role else 401, f"this needs the role {needs.word}: sign in with its PIN")
        return person

    def resting(self, request: Request) -> Person:
        """Return the person who makes a robot rest, identified by session only; never refuse or count the request."""
        try:
            return self._known(request, address_of(request), bearer=False)
        except TooFastError:
            return Person(Role.NOBODY)

    def robot(self, name: object) -> KnownRobot:
        """Return the robot with this name, or the only robot if the name is empty."""
        known = self.watch.robots
        if not name and len(known) == 1:
            return next(iter(known.values()))
        if not isinstance(name, str) or name not in known:
            reason = self.watch.link.trouble if not known else ""
            raise DeniedError(404, reason or f"`robot` must be one of {', '.join(sorted(known))}")
        return known[name]

    async def posted(self, request: Request) -> dict[str, Any]:
        """Return the JSON object in the body of a request."""
        try:
            return json_object(await request.body())
        except ValueError as error:
            raise DeniedError(400, str(error)) from None

    def _known(self, request: Request, address: str, *, bearer: bool = True) -> Person:
        scheme, _, pin = request.headers.get("authorization", "").partition(" ")
        wanted = pin.strip() if bearer and scheme.lower() == "bearer" else ""
        return self.access.person(address, wanted, request.cookies.get(COOKIE, ""))


def address_of(request: Request) -> str:
    return request.client.host if request.client else ""


def as_json(data: Any, status: int = 200, **headers: str) -> Response:
    return Response(orjson.dumps(data), status, headers={**NO_STORE, **headers}, media_type="application/json")


async def say_why_not(request: Request, error: Exception) -> Response:
    """Return the JSON response to an error: a refusal, an unknown path or method, or a fault of the console."""
    match error:
        case DeniedError():
            return refused(error.status, error.reason, **error.headers)
        case HTTPException(status_code=404):
            return refused(404, "there is nothing at this path")
        case HTTPException(status_code=405):
            return refused(405, "this path does not accept this method")
        case HTTPException():
            return refused(error.status_code, str(error.detail))
        case _:
            return refused(500, "the console failed: see its terminal")
