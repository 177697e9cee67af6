"""Ways out of a state: a way marked closed does not fire, and if nothing fires, no way was surely open."""

from collections import Counter
from contextlib import suppress
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.insight.explaining.outlook import WayOut, ways_out
from lumen.insight.explaining.tracing import retaken
from lumen.language.events import Event
from lumen.statechart import Machine, initial, step
from tests.explaining.running import inputs, live, timed
from tests.statechart.oracle.generating import EVENTS, Data, machine_data

QUICK = settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


def ways(machine: Machine, *events: Event) -> list[WayOut]:
    snapshot = initial(machine).snapshot
    for event in events:
        snapshot = step(machine, snapshot, event).snapshot
    return list(ways_out(machine, snapshot, snapshot.at))


def selects(way: WayOut, event: str) -> bool:
    wanted = way.transition.event
    return wanted in ("*", event) or event.startswith(wanted.removesuffix(".*") + ".")


def test_what_is_closed_is_not_taken() -> None:
    """More than ten cases of each kind are met; fewer would show nothing."""
    tally: Counter[str] = Counter()

    @QUICK
    @given(machine_data(), inputs, st.sampled_from([None, {"k": 1}, {"k": 3}]))
    def tried(data: Data, happenings: list[Any], brought: Any) -> None:
        tally.update(_tried(data, happenings, brought))

    tried()
    assert min(tally["taken"], tally["not taken"], tally["closed"]) > 10


def _tried(data: Data, happenings: list[Any], brought: Any) -> Counter[str]:
    """Send each event to the last states of a run; return how often it was taken, and its ways closed."""
    tally: Counter[str] = Counter()
    machine, events = Machine.from_dict(data), timed(happenings)
    for one in live(machine, events, events[-1].at)[-4:]:
        snapshot = one.step.snapshot
        known = [way for way in ways_out(machine, snapshot, snapshot.at) if not way.owner]
        for name in EVENTS:
            with suppress(LumenError):
                taken = retaken(machine, snapshot, Event(name, brought, snapshot.at)).microsteps[:1]
                first = [t for microstep in taken if not microstep.moment.owner for t in microstep.transitions]
                named = [way for way in known if way.transition.event and selects(way, name)]
                assert not [way for way in named if not way.open and any(way.transition is t for t in first)]
                sure = [way for way in named if way.open and (way.guard is None or way.guard.holds)]
                assert first or not [way for way in sure if not way.transition.timed]
                tally["taken" if first else "not taken"] += 1
                tally["closed"] += sum(not way.open for way in named)
    return tally


def test_why_is_said_in_words() -> None:
    machine = Machine.from_dict(
        {
            "context": {"n": 1, "who": "Ada"},
            "on": {"go": {}},
            "states": {
                "a": {
                    "on": {
                        "go": "b",
                        "more": [{"target": "b", "guard": "context.n > 3 && event.data.k == 1"}, {"target": "b"}],
                        "said": {"target": "b", "guard": "context.n == 1 && event.data.k == 1"},
                        "told": {"target": "b", "guard": "context.n == 1"},
                        "asked": {"target": "b", "guard": "context.n > 3 && context.n > context.who"},
                        "shown": {"target": "b", "guard": "false && context.n > context.who"},
                    },
                    "after": {"5s": "b"},
                    "always": {"target": "b", "guard": "context.n > 8"},
                },
                "b": {},
            },
        }
    )
    told = {(w.transition.awaited_time or w.transition.event, w.open): w for w in ways(machine)}
    assert told["more", False].why == "context.n > 3 is false: context.n is 1"
    assert told["more", True].why == "when more comes"
    assert told["asked", False].why == "context.n > 3 is false: context.n is 1", "only the first part that is false"
    assert told["shown", False].why == "false is false"
    assert told["said", True].guard
    assert told["said", True].guard.holds is None
    assert told["said", True].guard.values == {"context.n": 1}
    assert told["told", True].guard
    assert told["told", True].guard.holds is True
    assert told["after 5 s", True].why == "in 5 s"
    assert told["after 5 s", True].due == 5.0
    assert told["", False].why == "context.n > 8 is false: context.n is 1"
    outer = next(w for w in ways(machine) if w.transition.source == "" and w.transition.event == "go")
    assert (outer.open, outer.why) == (False, "a → b, on go goes first")
    assert all(w.open for w in ways(machine, Event("go")) if w.transition.event == "go")


def test_a_machine_that_is_over_has_no_way_out() -> None:
    machine = Machine.from_dict({"states": {"a": {"on": {"go": "b"}}, "b": {"type": "final"}}})
    assert ways(machine)
    assert not ways(machine, Event("go"))
