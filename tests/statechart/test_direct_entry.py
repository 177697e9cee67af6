"""Entering a state at a person's request."""

from typing import Any

import pytest

from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.statechart import Machine, initial, step
from lumen.statechart.direct_entry import entered_directly
from tests.tables import for_each

TOUR: dict[str, Any] = {
    "type": "parallel",
    "context": {"left": 0},
    "states": {
        "guide": {
            "initial": "idle",
            "states": {
                "idle": {"on": {"face": "talking"}},
                "talking": {
                    "id": "talking",
                    "exit": {"assign": {"left": "context.left + 1"}},
                    "states": {"greet": {"after": {"5s": "offer"}}, "offer": {"id": "offer"}, "bye": None},
                },
                "back": {"type": "history", "history": "deep", "target": "idle"},
            },
        },
        "touch": {"states": {"free": {"on": {"touched": "held"}}, "held": {"id": "held"}, "bye": None}},
    },
}
MACHINE = Machine.from_dict(TOUR, "tour")
START = initial(MACHINE).snapshot
TALKING = step(MACHINE, START, Event("face", at=1.0)).snapshot
HELD = step(MACHINE, TALKING, Event("touched", at=2.0)).snapshot


def go(name: str, snapshot: Any = HELD) -> Any:
    return entered_directly(MACHINE, snapshot, name, Event("operator.goto", {"by": "ada"}, 3.0))


@for_each(
    ("name", "exited", "entered"),
    [
        ("offer", ("guide.talking.greet",), ("offer",)),
        ("guide.talking.offer", ("guide.talking.greet",), ("offer",)),
        ("idle", ("guide.talking.greet", "talking"), ("guide.idle",)),
        ("talking", ("guide.talking.greet", "talking"), ("talking", "guide.talking.greet")),
        ("greet", ("guide.talking.greet",), ("guide.talking.greet",)),
        ("free", ("held",), ("touch.free",)),
        ("touch", ("held",), ("touch.free",)),
        ("back", ("guide.talking.greet", "talking"), ("guide.idle",)),
    ],
)
def test_only_what_excludes_the_state_is_left(name: str, exited: tuple[str, ...], entered: tuple[str, ...]) -> None:
    taken = go(name)
    assert (taken.exited, taken.entered) == (exited, entered)
    assert taken.snapshot.at == 3.0
    beside = "touch.free" if name in ("free", "touch") else "held"
    assert beside in taken.snapshot.configuration


def test_what_is_left_does_its_exit_and_what_is_entered_sets_its_timers() -> None:
    taken = go("idle")
    assert (taken.snapshot.context, taken.snapshot.timers) == ({"left": 1}, ())
    [timer] = go("greet", taken.snapshot).snapshot.timers
    assert timer.due == 8.0
    assert step(MACHINE, HELD, Event("nothing")).snapshot.context == {"left": 0}


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("ofer", "there is no state `ofer`: did you mean `offer`?"),
        ("bye", "`bye` is ambiguous: choose one of `guide.talking.bye`, `touch.bye`"),
        ("", "there is no state ``"),
    ],
)
def test_a_name_that_is_none_is_told(name: str, says: str) -> None:
    with pytest.raises(UsageError, match=says):
        go(name)


def test_a_machine_at_its_end_stays_there() -> None:
    over = Machine.from_dict({"states": {"a": None, "b": {"type": "final"}}, "initial": "b"}, "over")
    with pytest.raises(UsageError, match="`over` has ended: no state can be entered now"):
        entered_directly(over, initial(over).snapshot, "a", Event("operator.goto"))


@pytest.mark.parametrize("name", ["ask", "game/ask"])
def test_a_state_of_an_invoked_behaviour_is_entered_by_itself_alone(name: str) -> None:
    quiz = {"initial": "ask", "states": {"ask": {"after": {"5s": "over"}}, "over": {"type": "final"}}}
    host: dict[str, Any] = {"states": {"playing": {"invoke": {"id": "game", "behavior": "quiz"}}}}
    machine = Machine.from_dict(host, "host", {"quiz": quiz})
    with pytest.raises(UsageError, match=r"`ask` is a state of `quiz`, which `playing` invokes, .*: enter `playing`"):
        entered_directly(machine, initial(machine).snapshot, name, Event("operator.goto", at=1.0))
