"""The smallest change of an event or of the context that makes a guard true: found for random guards, and it works."""

from collections import Counter
from itertools import product
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import ExpressionError
from lumen.expressions import Scope, compile_guard
from lumen.insight.explaining import RecordedStep
from lumen.insight.explaining.answers import why_not
from lumen.insight.explaining.changes import StepSituation
from lumen.language.events import Event
from lumen.statechart import Machine, initial, step
from tests.tables import for_each

CONTEXT = {"n": 3, "m": 10, "name": "Budi", "tired": False, "seen": ["a"]}
DATA = {"k": 2, "word": "hello", "sure": 0.4}
PHRASES = {"yes": {"en": ["yes", "of course"]}}

numbers = st.integers(-3, 12)
atoms = st.one_of(
    st.builds("{} {} {}".format, st.sampled_from(["context.n", "context.m", "event.data.k", "event.data.sure"]),
              st.sampled_from(["<", "<=", ">", ">=", "==", "!="]), numbers),
    st.builds("context.n + event.data.k {} {}".format, st.sampled_from(["<", ">", "=="]), numbers),
    st.builds("context.m - context.n > {}".format, numbers),
    st.builds("{} == '{}'".format, st.sampled_from(["context.name", "event.data.word"]), st.sampled_from("abc")),
    st.builds("size({}) {} {}".format, st.sampled_from(["context.name", "event.data.word"]),
              st.sampled_from([">", "<", "=="]), st.integers(0, 7)),
    st.sampled_from([
        "context.tired", "!context.tired", "context.name != ''", "event.data.word in ['x', 'y']",
        "heard(event.data.word, 'yes')", "contains(event.data.word, 'zoo')", "after(event.data.word, 'i am') != ''",
        "event.data.k % 2 == 1", "size(context.seen) > 1", "has(event.data.more)", "'b' in context.seen",
        "context.name == event.data.word",
    ]),
)  # fmt: skip
guards = st.recursive(
    atoms,
    lambda inner: (
        st.builds("({} {} {})".format, inner, st.sampled_from(["&&", "||"]), inner) | st.builds("!({})".format, inner)
    ),
    max_leaves=3,
)


def possible(machine: Machine, guard: str) -> bool:
    """Return whether any of several hundred combinations of values makes the guard true."""
    context = product(
        (-5, 3, 20), (-9, 10, 40), ("Budi", "a", "b", "c", "", "xxxxx"), (True, False), (["a"], ["a", "b"], [])
    )
    words = ("hello", "a", "b", "c", "", "x", "yes", "zoo", "i am Ani", "xxxxx")
    data = list(product((-5, 1, 2, 20), words, (0.4, -5.0, 20.0), (False, True)))
    holds = compile_guard(guard)
    for number, values in enumerate(context):
        for k, word, sure, more in data[number % 3 :: 3]:
            seen = {"k": k, "word": word, "sure": sure, **({"more": 1} if more else {})}
            try:
                scope = Scope(
                    dict(zip(CONTEXT, values, strict=True)), {"name": "e", "data": seen}, phrases=machine.phrases
                )
                if holds(scope):
                    return True
            except ExpressionError:
                continue
    return False


def check(guard: str, tally: Counter[str]) -> None:
    """Check that, for a false guard, the proposed change lets the transition fire."""
    data: Any = {"id": "m", "initial": "a", "context": CONTEXT, "phrases": PHRASES, "states": {"a": {}, "b": {}}}
    data["states"]["a"]["on"] = {"e": {"guard": guard, "target": "b"}}
    machine = Machine.from_dict(data)
    first = initial(machine)
    second = step(machine, first.snapshot, Event("e", DATA, 1.0))
    if second.entered:
        return
    (reason,) = why_not(
        [RecordedStep(machine, None, first), RecordedStep(machine, first.snapshot, second)], "b"
    ).reasons
    assert reason.because == "guard"
    assert reason.false
    if reason.change is None:
        tally["none, and there is one" if possible(machine, guard) else "none, and there is none"] += 1
        assert reason.note
        return
    changed = StepSituation(first.snapshot, second.event).edited(reason.change)
    assert changed.event
    taken = step(machine, changed.snapshot, changed.event)
    tally["a change that works" if taken.entered else "a change that does not"] += 1
    tally[f"{len(reason.change)} edits"] += 1


SPOKEN = {
    "heard(event.data.word, 'yes')": "yes",
    "heard(event.data.word, context.titles)": "Golden Boy",
    "lookup(event.data.word, 'faq') != null": "how tall are you",
    "after(event.data.word, 'i am') != ''": "i am Ani",
    "contains(event.data.word, 'zoo')": "zoo",
    "matches(event.data.word, '^zoo$')": "zoo",
}


@for_each(("guard", "word"), list(SPOKEN.items()))
def test_a_guard_about_a_text_needs_a_text_that_it_names(guard: str, word: str) -> None:
    machine = Machine.from_dict(
        {
            "initial": "a",
            "context": {"titles": ["Golden Boy"]},
            "phrases": PHRASES,
            "answers": {"faq": [{"phrases": ["how tall are you"], "value": "58 cm"}]},
            "states": {"a": {"on": {"e": {"guard": guard, "target": "b"}}}, "b": {}},
        }
    )
    first = initial(machine)
    second = step(machine, first.snapshot, Event("e", DATA, 1.0))
    (reason,) = why_not(
        [RecordedStep(machine, None, first), RecordedStep(machine, first.snapshot, second)], "b"
    ).reasons
    assert reason.change == {"event.data.word": word}


def counted(most: int) -> Counter[str]:
    tally = Counter[str]()

    @settings(max_examples=most, deadline=None, database=None, derandomize=True)
    @given(guards)
    def everyone(guard: str) -> None:
        check(guard, tally)

    everyone()
    return tally


def found(tally: Counter[str]) -> float:
    return tally["a change that works"] / (
        tally["a change that works"] + tally["a change that does not"] + tally["none, and there is one"]
    )


def test_a_few_guards() -> None:
    assert found(counted(60)) >= 0.95


@pytest.mark.soak
def test_a_thousand_guards() -> None:
    tally = counted(2_000)
    print("\n" + ", ".join(f"{count:,} {what}" for what, count in sorted(tally.items())))  # noqa: T201
    assert found(tally) >= 0.95
