"""A copy of the shipped exhibition with a small behaviour of its own, and stories about it."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.tour.conftest import copy, project

__all__ = ["copy", "project"]

DOOR = """\
id: door
context: {opened: 0, name: ''}
events: {knock: {type: object, properties: {who: {type: string}}, required: [who]}, slam: null, spin: null}
initial: closed
states:
  closed:
    on:
      knock:
        - guard: event.data.who == 'nobody'
        - target: open
          actions: {assign: {name: event.data.who, opened: context.opened + 1}}
      slam: .never
      spin: spinning
    states: {wait: {}, never: {}}
  open:
    entry: {publish: {route: journal, body: {who: context.name, at: hour(), times: [1, 2]}}}
    do: [{say: "Hello, {{ context.name }}!"}, {play: goodbye}]
    after: {20s: closed}
  spinning:
    always: {guard: context.opened < 100, target: spun}
  spun:
    always: {guard: context.opened < 100, target: spinning}
"""


@pytest.fixture
def story(copy: Path) -> Callable[..., Path]:
    """A function that writes a story about the door, and returns the folder of its project."""
    (copy / "behaviors" / "door.yaml").write_text(DOOR, "utf-8")

    def write(steps: str, head: str = "", name: str = "knocking") -> Path:
        text = f"title: Somebody knocks\nbehavior: door\n{head}steps:\n{steps}"
        (copy / "behaviors" / "stories" / f"{name}.yaml").write_text(text, "utf-8")
        return copy

    return write
