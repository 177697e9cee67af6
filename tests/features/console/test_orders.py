"""The messages that the console sends for commands, and the commands that it refuses."""

from typing import Any

import pytest

from lumen.errors import UsageError
from lumen.features.console.orders import order_of, verdict_outcome
from lumen.features.console.robot_keys import RobotKeys
from tests.tables import for_each

KEYS = RobotKeys("operator", "config", "command", "stop", "image")


@for_each(
    "command, fields, body",
    [
        ("event", {"event": "touched"}, {"ask": "event", "event": "touched", "data": {}, "by": "ada"}),
        ("event", {"event": "touched", "data": None}, {"ask": "event", "event": "touched", "data": {}, "by": "ada"}),
        (
            "event",
            {"event": "face", "data": {"x": 1}},
            {"ask": "event", "event": "face", "data": {"x": 1}, "by": "ada"},
        ),
        ("model", {"on": False}, {"ask": "model", "on": False, "by": "ada"}),
        ("approve", {"approval": "a1", "go": False}, {"ask": "approve", "id": "a1", "go": False, "by": "ada"}),
    ],
)
def test_a_command_is_a_question_to_the_brain(command: str, fields: dict[str, Any], body: dict[str, Any]) -> None:
    order = order_of(command, fields, KEYS, "ada")
    assert (order.key, order.body) == ("operator", body)


@for_each(
    "command, fields, message",
    [
        ("dance", {}, "there is no command `dance`"),
        ("event", {"event": "touched", "data": ["head"]}, "`data` must be an object, or be left out"),
        ("event", {"event": "touched", "data": ""}, "`data` must be an object, or be left out"),
        ("event", {}, "`event` must be a string of 1 to 200 characters"),
        ("model", {"on": "no"}, "`on` must be true or false"),
        ("approve", {"approval": "a1", "go": "yes"}, "`go` must be true or false"),
    ],
)
def test_what_is_no_command_is_refused(command: str, fields: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        order_of(command, fields, KEYS, "ada")


def test_an_event_that_waits_for_go_is_no_failure() -> None:
    assert verdict_outcome({"verdict": "done", "taken": False, "waiting": "a1"}) == ""
    assert verdict_outcome({"verdict": "done", "taken": False}) == "nothing reacts to that event now"
