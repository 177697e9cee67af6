"""The end of a run: one order for a single robot, a house and several processes."""

from types import SimpleNamespace
from typing import Any

from lumen.cli.run_verdict import end_of
from lumen.run.parts.visitor import VisitorPart
from tests.tables import for_each


def robot(failure: str = "", *, failed: bool = False, interrupted: bool = False) -> Any:
    """Return a robot's services, as far as the end of a run depends on them."""
    visitor = SimpleNamespace(player=SimpleNamespace(failure=failure))
    node = SimpleNamespace(failed=failed or bool(failure), interrupted=interrupted)
    return SimpleNamespace(node=node, get={VisitorPart: visitor}.get)


@for_each(
    ("robots", "troubles", "end"),
    [
        ([robot()], [], ("well", "Ended", "")),
        ([robot()], ["a", "b"], ("troubled", "Ended with trouble", "a")),
        ([robot(failed=True)], ["a"], ("early", "Ended before the story was over", "a")),
        ([robot(interrupted=True)], ["a"], ("interrupted", "Ended with trouble", "a")),
        ([robot(failed=True, interrupted=True)], [], ("interrupted", "Ended before the story was over", "")),
        ([robot("wrong", interrupted=True)], ["a"], ("failed", "The story failed", "wrong")),
        ([robot(interrupted=True), robot("wrong")], [], ("failed", "The story failed", "wrong")),
    ],
)
def test_a_failed_story_comes_first_then_an_interruption(
    robots: list[Any], troubles: list[str], end: tuple[str, str, str]
) -> None:
    assert tuple(end_of(robots, troubles)) == end
