"""The exploration of a behaviour in its project: findings with their places, and stories that lead to them."""

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import yaml

from lumen.insight.exploration import Exploration, ExplorationFinding, PathStep, StimulusKind, explore
from lumen.language.controller_events import controller_events
from lumen.language.diagnostics import Place
from lumen.language.events import robot_events
from lumen.language.machines import MachineDefinition
from lumen.language.modules import own_module_events
from lumen.language.projects import Project
from lumen.run.coverage import Gap, described
from lumen.run.story_time import story_epoch
from lumen.run.visitor import SPEECH_ROUTE

HEAD = "# yaml-language-server: $schema=../../schemas/story.schema.json"
ROBOT_TIMEOUT = "2min"
"""The time that the story waits for a robot's command to end."""


@dataclass(frozen=True)
class ExploredFinding:
    """A finding of the exploration."""

    kind: str
    place: Place
    """The file, line and column of the finding."""
    message: str
    story: str
    """The YAML of a story that leads to the finding, as far as a story can (`story`)."""


@dataclass(frozen=True)
class Explored:
    """The result of exploring a behaviour."""

    behavior: str
    configurations: int
    """The number of configurations that were explored."""
    steps: int
    """The number of steps that were taken."""
    waiting: int
    """The number of reached configurations that were not explored, because of the bound."""
    kept: tuple[str, ...]
    """The names of the properties that hold in every reached configuration."""
    findings: tuple[ExploredFinding, ...]
    unseen: tuple[Gap, ...]
    """The states and transitions that were not reached."""
    took: float
    """The duration [s]."""
    known: bool = False
    """Whether this is the stored result of an earlier exploration."""

    @property
    def complete(self) -> bool:
        """Whether every reached configuration was explored."""
        return not self.waiting


def explored(
    project: Project, behavior: str, *, bound: int, home: str = "", tell: Callable[[int, int], None] | None = None
) -> Explored:
    """Explore a behaviour under every event that the project's routes, its robot and its own file declare.

    `bound` is the greatest number of configurations to explore, and `home` the state that must stay reachable (empty:
    the initial one). `tell` is called with the numbers of configurations that were explored and that wait.
    """
    began = time.perf_counter()
    machine = project.behaviors[behavior]
    options: dict[str, Any] = {
        "bound": bound,
        "home": home,
        "language": project.languages[0],
        "epoch": story_epoch(None, project.timezone),
        "timezone": project.timezone,
    }
    found = explore(machine, outside(project, machine), progress=tell or (lambda *_: None), **options)
    findings = tuple(
        ExploredFinding(f.kind, _place(project, behavior, f), f.message, story(project, behavior, f))
        for f in found.findings
    )
    counts = found.configurations, found.steps, found.waiting, found.kept
    return Explored(behavior, *counts, findings, tuple(_unseen(project, behavior, found)), time.perf_counter() - began)


def outside(project: Project, machine: MachineDefinition) -> Mapping[str, Any]:
    """Return the events that reach a behaviour from outside, with the JSON Schemas of their data (None: any data)."""
    routes = {r.event: project.messages.get(r.schema) for r in project.routes.values() if r.event}
    pressed = {button.event: None for state in machine.states.values() for button in state.buttons}
    steady = {**controller_events(project.controllers.values()), **robot_events(), **own_module_events(project.modules)}
    return {**steady, **routes, **pressed, **machine.events}


def story(project: Project, behavior: str, finding: ExplorationFinding) -> str:
    """Return the YAML of a story that leads to a finding.

    In a story, a kind of command, such as `say`, fails or hangs from the beginning or not at all. If it also works on
    the path to the finding, the story can't follow this path; it then contains a comment about this.
    """
    robot = dict(_broken(finding.path))
    lines = [HEAD, f"title: {_flow(finding.message)}"]
    lines += [f"behavior: {_flow(behavior)}"] if behavior != project.behavior else []
    lines += [f"robot: {_flow(robot)}"] if robot else []
    stimuli = [step.stimulus for step in finding.path if step.stimulus]
    worked = {_verb(s.command) for s in stimuli if s.kind is StimulusKind.DONE} & robot.keys()
    lines += [
        f"# Here `{verb}` works at first and fails later; in a story it can only fail from the beginning."
        for verb in sorted(worked)
    ]
    steps = [*_steps(project, finding.path), *([f"wait: {finding.patience:g}s"] if finding.patience else [])]
    return "\n".join([*lines, "steps:", *(f"  - {step}" for step in steps)]) + "\n"


def _steps(project: Project, path: tuple[PathStep, ...]) -> Iterator[str]:
    yield _expect(path[0].states, (), {})
    for before, step in pairwise(path):
        stimulus = step.stimulus
        assert stimulus is not None  # only the first step has none
        changed = step.states != before.states
        if stimulus.kind is StimulusKind.EVENT:
            yield _happens(project, stimulus.event.name, stimulus.event.data)
        if stimulus.kind is StimulusKind.TIME and not changed:
            yield f"wait: {stimulus.waited:g}s"
        elif changed:
            within = {StimulusKind.TIME: f"{stimulus.waited + 1:g}s", StimulusKind.DONE: ROBOT_TIMEOUT}.get(
                stimulus.kind
            )
            yield _expect(step.states, before.states, {"within": within} if within else {})


def _happens(project: Project, name: str, data: Any) -> str:
    """Return the story step that raises an event: spoken words, a message on its route, or a bare event."""
    route = next((r.name for r in project.routes.values() if r.event == name), None)
    if route == SPEECH_ROUTE and isinstance(data, Mapping) and isinstance(data.get("result"), str) and data["result"]:
        return f"says: {_flow(data['result'])}"
    if route is not None:
        return f"message: {_flow({'route': route, 'body': data})}"
    return f"event: {_flow({'name': name, 'data': data} if data else name)}"


def _expect(states: tuple[str, ...], before: tuple[str, ...], more: Mapping[str, Any]) -> str:
    """Return the story step that expects the states that became active, or all `states` if none did."""
    fresh = [state for state in states if state not in before] or list(states)
    return f"expect: {_flow({'state': fresh[0] if len(fresh) == 1 else fresh, **more})}"


def _broken(path: tuple[PathStep, ...]) -> Iterator[tuple[str, str]]:
    """Yield each verb that must fail on the path, or hang while a timer ends, with `fails` or `hangs`."""
    for step in path:
        if step.stimulus and step.stimulus.kind is StimulusKind.FAILED:
            yield _verb(step.stimulus.command), "fails"
        elif step.stimulus:
            yield from ((_verb(command), "hangs") for command in step.stimulus.pending)


def _verb(command: object) -> str:
    return type(command).__name__.lower()


def _flow(value: Any) -> str:
    """Return a value as YAML on one line."""
    text: str = yaml.safe_dump([value], default_flow_style=True, allow_unicode=True, sort_keys=False, width=10_000)
    return text.strip()[1:-1]


def _unseen(project: Project, behavior: str, found: Exploration) -> Iterator[Gap]:
    machine = project.behaviors[behavior]
    for path in found.never_entered:
        place = project.place(f"behaviors/{behavior}.yaml", machine.states[path].where)
        yield Gap(place, f"state `{machine.states[path].name}` is never entered")
    for transition in found.never_taken:
        place = project.place(f"behaviors/{behavior}.yaml", transition.where)
        yield Gap(place, f"{described(machine, transition)} is never taken")


def _place(project: Project, behavior: str, finding: ExplorationFinding) -> Place:
    where = finding.where or project.behaviors[behavior].states[finding.state].where
    return project.place(f"behaviors/{behavior}.yaml", where)
