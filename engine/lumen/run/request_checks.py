"""The check of operators' requests against the table of requests, with advice on invalid ones."""

from typing import Any

from lumen.bus.checking import SchemaCheck
from lumen.language.operator_requests import REQUESTS, UNLISTED, OperatorRequest


class RequestChecks:
    """A checker of bodies by the schemas of all requests; a schema is compiled for its first request."""

    def __init__(self) -> None:
        self._rows = {row.ask: (row, SchemaCheck(row.schema)) for row in REQUESTS}

    def valid(self, body: Any) -> OperatorRequest | None:
        """Return the request that a body is; None if it is no request, or a field is missing or wrong."""
        row, check = self._found(body)
        return row if check and check.fits(body) else None

    def fault(self, body: Any) -> str:
        """Return why a body that is not `valid` is refused."""
        row, _ = self._found(body)
        if row and row.fault:
            return row.fault
        *shown, last = [each.shown for each in REQUESTS if each not in UNLISTED]
        return f"the request is not valid: send {', '.join(shown)}, or {last}"

    def _found(self, body: Any) -> tuple[OperatorRequest | None, SchemaCheck | None]:
        ask = body.get("ask") if isinstance(body, dict) else None
        return self._rows.get(ask, (None, None)) if isinstance(ask, str) else (None, None)
