"""The table of operator requests: each is described, and refused by its schema alone."""

import re
from typing import Any

import pytest

from lumen.language.operator_requests import APPROVE, REQUESTS, UNLISTED, WHY, OperatorRequest
from lumen.run.decisions import RequestChecks
from tests import ROOT

PAGE = (ROOT / "docs/deployment.md").read_text()
RIGHT: dict[str, dict[str, Any]] = {
    "event": {"event": "next"},
    "press": {"button": "Next"},
    "approve": {"id": "a1", "go": True},
    "autonomy": {"level": "alone"},
    "model": {"on": False},
    "goto": {"state": "offer"},
    "note": {"text": "held its head"},
}
WRONG: dict[str, dict[str, Any]] = {
    "event": {"event": ""},
    "press": {"button": 3},
    "approve": {"id": "a1", "go": "yes"},
    "autonomy": {"level": "often"},
    "model": {"on": 1},
    "goto": {"state": None},
    "note": {},
    "why": {"what": 4},
    "why-not": {"at": 4},
    "journal": {"from": "0"},
}


@pytest.mark.parametrize("request_", REQUESTS, ids=lambda row: row.ask)
def test_a_request_is_known_with_its_fields_and_no_others(request_: OperatorRequest) -> None:
    checks = RequestChecks()
    assert checks.valid(request_(by="Aisyah", **RIGHT.get(request_.ask, {}))) is request_
    assert RIGHT.keys() & {request_.ask} == ({request_.ask} if request_.needs else set())
    if request_.ask in WRONG:
        assert checks.valid(request_(**WRONG[request_.ask])) is None
        assert checks.fault(request_(**WRONG[request_.ask]))
    assert re.search(rf'"ask":\s+"{request_.ask}"', PAGE)


@pytest.mark.parametrize("body", [None, [], "status", {}, {"ask": None}, {"ask": ["status"]}, {"ask": "stats"}])
def test_what_is_no_request_is_answered_with_all_that_are(body: Any) -> None:
    checks = RequestChecks()
    assert checks.valid(body) is None
    assert all(row.shown in checks.fault(body) for row in REQUESTS if row not in UNLISTED)
    assert '`{"ask": "approve", "id": …, "go": true}`' in checks.fault(body)


def test_a_schema_names_what_a_request_needs() -> None:
    assert APPROVE.schema["required"] == ["ask", "id", "go"]
    assert WHY.schema["properties"]["at"] == {"type": ["string", "null"]}
