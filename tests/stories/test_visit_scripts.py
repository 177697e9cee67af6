"""The faults of a robot in a recorded visit, as `robot:` of a story describes them."""

from typing import Any

from lumen.insight.replay.entries import JournalInput
from lumen.insight.replay.visits import RecordedVisit
from lumen.language.events import Event
from lumen.run.storytelling.visit_script import broken
from tests.tables import for_each

SAY, PLAY = {"Say": {"text": "Hello"}}, {"Play": {"motion": "wave"}}
Answered = tuple[dict[str, Any], str, float]


def visit(*answered: Answered) -> RecordedVisit:
    """Return a visit in which the robot answers each command as given, after a delay [s]; or never, if it is empty."""
    inputs, at = [], 0.0
    for number, (command, how, took) in enumerate(answered):
        start = {"Start": {"id": f"d{number}", "command": command}}
        inputs.append(JournalInput(2 * number, "heard", Event("knock", None, at), commands=(start,)))
        if how:
            inputs.append(JournalInput(2 * number + 1, "heard", Event(f"{how}.command.d{number}", None, at + took)))
        at += took + 1.0
    return RecordedVisit(1, 0, len(inputs), 0.0, at, None, tuple(inputs), whole=True)


@for_each(
    ("answered", "found"),
    [
        ([(SAY, "done", 2.0)], {}),
        ([(SAY, "error", 0.0), (SAY, "error", 0.0), (PLAY, "done", 1.0)], {"say": "fails"}),
        ([(SAY, "error", 0.0), (SAY, "done", 1.0)], {}),
        ([(PLAY, "cancelled", 9.0)], {"play": "hangs"}),
        ([(PLAY, "cancelled", 9.0), (PLAY, "done", 1.0)], {}),
        ([(PLAY, "", 9.0)], {"play": "hangs"}),
        ([(PLAY, "done", 1.0), (PLAY, "", 9.0)], {}),
    ],
)
def test_a_verb_that_always_failed_or_never_ended(answered: list[Answered], found: dict[str, str]) -> None:
    assert broken(visit(*answered), (), hanging=True, lasting=False) == found
    failing = {verb: how for verb, how in found.items() if how == "fails"}
    assert broken(visit(*answered), (), hanging=False, lasting=False) == failing


def test_the_shortest_time_is_how_long_it_spoke() -> None:
    spoke = visit((SAY, "done", 2.0), (SAY, "done", 3.0), (PLAY, "done", 1.0))
    assert broken(spoke, (), hanging=False, lasting=True) == {"say": 2.0}
    assert broken(visit((SAY, "error", 0.0)), (), hanging=False, lasting=True) == {"say": "fails"}
    assert broken(visit((SAY, "cancelled", 4.0)), (), hanging=False, lasting=True) == {}
