"""The requests of operators to a running exhibition: a row for each, used by senders and by the part that answers.

A request is a message on `lumen.{robot}.operator.request` with a `reply_to`: docs/deployment.md describes the answers.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

TEXT: Mapping[str, Any] = {"type": "string"}
MAX_NAME = 100
"""The maximum length of the name of an event or a person [characters]."""


@dataclass(frozen=True, slots=True)
class OperatorRequest:
    """A kind of request, with the body `{"ask": ask, "by": PERSON, …fields}`. Calling it with fields returns a body."""

    ask: str
    fields: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """The JSON Schema of each field but `ask` and `by`."""
    needs: tuple[str, ...] = ()
    """The fields that may not be left out."""
    example: str = ""
    """The text after `"ask": …` in the list that answers an invalid request; empty if it is not in the list."""
    fault: str = ""
    """The reason given for the refusal of an invalid request of this name; empty for the list of valid requests."""

    def __call__(self, **fields: Any) -> dict[str, Any]:
        return {"ask": self.ask, **fields}

    @property
    def schema(self) -> dict[str, Any]:
        """The JSON Schema (2020-12) of the request's body."""
        return {
            "type": "object",
            "properties": {"ask": {"const": self.ask}, **self.fields},
            "required": ["ask", *self.needs],
        }

    @property
    def shown(self) -> str:
        """The request as the list of valid requests shows it."""
        return f'`{{"ask": "{self.ask}"{self.example and f", {self.example}"}}}`'


STATUS = OperatorRequest("status")
NOW = OperatorRequest("now")
EVENT = OperatorRequest(
    "event",
    {"event": {"type": "string", "minLength": 1, "maxLength": MAX_NAME}, "data": {}},
    ("event",),
    '"event": …',
    "`event` must be the name of an event",
)
PRESS = OperatorRequest("press", {"button": TEXT}, ("button",), '"button": …', "`button` must be the label of a button")
APPROVE = OperatorRequest("approve", {"id": TEXT, "go": {"type": "boolean"}}, ("id", "go"), '"id": …, "go": true')
AUTONOMY = OperatorRequest("autonomy", {"level": {"enum": ["ask", "alone"]}}, ("level",), '"level": "ask"')
MODEL = OperatorRequest("model", {"on": {"type": "boolean"}}, ("on",), '"on": false')
GOTO = OperatorRequest("goto", {"state": TEXT, "only": {}}, ("state",), '"state": …')
MARK = OperatorRequest("mark", {"text": {}})
FORK = OperatorRequest("fork", {"position": {}, "at": {}, "event": {}, "bundle": {}}, example='"position": …')
_PAST = {"what": TEXT, "at": {"type": ["string", "null"]}}
WHY = OperatorRequest("why", _PAST, example='"what": …', fault="`what` and `at` must be strings")
WHY_NOT = OperatorRequest("why-not", _PAST, fault=WHY.fault)
NOTE = OperatorRequest("note", {"text": TEXT}, ("text",))
JOURNAL = OperatorRequest(
    "journal",
    {"from": {"type": "integer"}},
    fault="`from` must be a whole number: the position of an entry",
)

REQUESTS = (
    STATUS, NOW, EVENT, PRESS, APPROVE, AUTONOMY, MODEL, GOTO, MARK, FORK, WHY, WHY_NOT, NOTE, JOURNAL,
)  # fmt: skip
UNLISTED = (WHY_NOT, NOTE, JOURNAL)
"""Requests that the answer to an invalid request does not list."""
