"""The paths for a fleet: the houses' status, and decisions on a rollout, sent to the centre on the console's bus."""

from typing import Any

from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from lumen.errors import BusError
from lumen.features.console.people import Role
from lumen.features.console.requests import DeniedError, Reception, as_json
from lumen.language.fleet_keys import ORDER

ANSWER_TIMEOUT = 5.0
"""The time limit for a centre's answer [s]."""
DECISIONS = ("pause", "go", "abort")


class FleetPages:
    """Forwards requests to the fleet's centre, and returns its answers."""

    def __init__(self, reception: Reception) -> None:
        self._reception = reception
        self.routes = [
            Route("/api/fleet", self._fleet),
            Route("/api/fleet", self._decide, methods=["POST"]),
        ]

    async def _fleet(self, request: Request) -> Response:
        self._reception.person(request, Role.OPERATOR)
        return as_json(await self._asked({"ask": "status"}))

    async def _decide(self, request: Request) -> Response:
        person = self._reception.person(request, Role.OPERATOR)
        data = await self._reception.posted(request)
        decision = data.get("decision")
        if decision not in DECISIONS:
            raise DeniedError(400, f"`decision` must be one of {', '.join(DECISIONS)}")
        return as_json(await self._asked({"ask": decision, "by": person.name or person.role.word}))

    async def _asked(self, body: dict[str, Any]) -> dict[str, Any]:
        try:
            said = await self._reception.watch.exchanges.request(ORDER, body, ANSWER_TIMEOUT)
        except BusError:
            raise DeniedError(503, "no fleet centre answers on this bus: start one with `lumen fleet serve`") from None
        if not isinstance(said, dict):
            raise DeniedError(503, "the centre sent an answer that cannot be shown")
        if not said.get("ok"):
            raise DeniedError(409, str(said.get("reason")))
        return said
