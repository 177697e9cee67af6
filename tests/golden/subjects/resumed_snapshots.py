"""A snapshot of each state of the tour, resumed under each policy of timers, and by a start after a crash.

For each policy: the steps at once, then states, context and timers, then the steps of the next 40 s.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import lumen
from lumen.statechart import Interpreter, Step, VirtualClock
from tests.golden.adapters import command_text, continued
from tests.golden.golden import HERE, PROJECTS
from tests.golden.texts import in_one_line, write

SUITE = "test"
SNAPSHOTS = HERE / "snapshots" / "tour.jsonl"
Policy = Literal["deadline", "remaining", "restart"]
POLICIES: tuple[Policy, ...] = ("deadline", "remaining", "restart")
AWAY = 7.25
"""The time between snapshot and start [s]."""
THEN = 40.0
"""The time that is simulated afterwards [s]."""


def record(folder: Path) -> None:
    """Write a file for each state."""
    project = lumen.load(PROJECTS / "tour")
    for line in SNAPSHOTS.read_text("utf-8").splitlines():
        frozen = json.loads(line)
        state = frozen.pop("state")
        lines = [text for policy in POLICIES for text in resumed(project, frozen, policy)]
        for away in (AWAY, 300.0):
            lines += [f"a start {away:g} s later", *continued(project, project, frozen, away, 0.5)]
        write(folder / f"{state}.txt", lines)


def resumed(project: lumen.Project, frozen: dict[str, Any], policy: Policy) -> Iterator[str]:
    """Resume a snapshot: by `deadline` on a clock that continues the old one, else on a new one."""
    begins = frozen["at"] + AWAY if policy == "deadline" else 0.0
    steps: list[Step] = []
    going = Interpreter.restore(project.machine, frozen, VirtualClock(begins), policy, observe=steps.append)
    yield policy
    yield from (line for step in steps for line in step_lines(step, begins))
    now = going.snapshot()
    yield f"  stands in {' '.join(now['configuration'])}"
    yield f"  context {in_one_line(now['context'])}"
    yield from (f"  timer {each['event']} in {each['due'] - begins:.6f} s" for each in now["timers"])
    steps.clear()
    going.clock.advance(THEN)
    yield from (line for step in steps for line in step_lines(step, begins))


def step_lines(step: Step, begins: float) -> Iterator[str]:
    """Yield the lines of a step: its time since the start [s], event, states left and entered, and commands."""
    event = step.event.name if step.event else "start"
    ways = [f"-{state}" for state in step.exited] + [f"+{state}" for state in step.entered]
    yield " ".join([f"  {step.snapshot.at - begins:.6f} {event}", *ways])
    yield from (f"    {in_one_line(command_text(command))}" for command in step.commands)
