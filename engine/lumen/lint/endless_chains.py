"""Finds states that lead back to themselves without a guard or a delay: by events, `do`, `invoke`, `after: 0s`."""

from collections.abc import Iterator
from contextlib import suppress
from functools import partial

from lumen.language.diagnostics import WARNING, Code
from lumen.language.machines import MachineDefinition, State
from lumen.lint.chain_survey import ChainSurvey, UncertainError, sends_event
from lumen.lint.instant_chains import InstantChain, TakenTransition, asked_guards, round_of
from lumen.lint.statecharts import ALWAYS_LOOP
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import Same, memoize
from lumen.project.transitions import ENDLESS_ALWAYS

ENDLESS_CHAIN = Code("endless-chain", "statecharts", WARNING, "transitions loop for ever, without a guard or a delay")


MAX_STEPS_TO_REST = 20
"""The number of steps within which a state must come to rest after its entry; otherwise it counts as left."""

MAX_SHOWN_TRANSITIONS = 6
"""The maximum number of a chain's transitions that its message names."""


def check(draft: ProjectDraft) -> None:
    """Report chains that never come to rest."""
    ends: dict[tuple[int, int], bool | None] = {}
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        rounds = memoize(("endless chains", name), _with_invoked(machine), partial(_rounds, machine, ends))
        for around, asked in rounds:
            _report(machine, around, asked, report)


def _with_invoked(machine: MachineDefinition) -> tuple[Same, ...]:
    """Return a machine and all that it invokes, directly or not: chains depend on them alone."""
    found = {id(machine): machine}
    ahead = [machine]
    while ahead:
        new = {id(other): other for other in ahead.pop().invoked.values() if id(other) not in found}
        found |= new
        ahead += new.values()
    return tuple(map(Same, found.values()))


def _rounds(
    machine: MachineDefinition, ends: dict[tuple[int, int], bool | None]
) -> list[tuple[list[TakenTransition], list[str]]]:
    """Return the transitions of each chain that never comes to rest, and the guards that it checks."""
    found: list[tuple[list[TakenTransition], list[str]]] = []
    told: set[int] = set()
    for chain in _beginnings(ChainSurvey(machine, ends)):
        if (around := round_of(chain)) and told.isdisjoint(id(t) for t, _ in around):
            told.update(id(t) for t, _ in around)
            found.append((around, asked_guards(chain, len(around))))
    return found


def _beginnings(survey: ChainSurvey) -> Iterator[InstantChain]:
    """Yield a chain for each transition of a state in which the machine can rest, and a chain for its beginning.

    It stops when the work exceeds MAX_WORK.
    """
    stays: dict[str | None, bool] = {None: True}
    followed: set[tuple[str, tuple[str, ...], bool]] = set()
    for state in survey.machine.states.values():  # a parent comes before its children
        stays[state.path] = stays[state.parent] and _stays(survey, state)
        for transition in state.transitions if stays[state.path] else ():
            if survey.exhausted:
                return
            sends = sends_event(transition.actions)
            if not transition.event or not (transition.targets or sends):
                continue
            way = survey.domain(transition), transition.targets, sends
            if way in followed and not (sends or survey.speaks_at_exit(way[0])):
                continue  # such a chain depends on the domain and the targets alone
            followed.add(way)
            chain = InstantChain(survey)
            with suppress(UncertainError):
                chain.stand_around(state.path)
                chain.enter((state.path,), state.parent)
                chain.internal, chain.timers, chain.begun = (), [], set(chain.active)
                chain.take([transition], transition.event)
                chain.taken.clear()
                yield chain
    chain = InstantChain(survey)
    with suppress(UncertainError):
        chain.enter(("",), None)
        yield chain


def _stays(survey: ChainSurvey, state: State) -> bool:
    """Return whether a state is still active when the machine next rests after its entry; True if that is uncertain.

    False if the machine does not rest within MAX_STEPS_TO_REST steps.
    """
    chain = InstantChain(survey)
    try:
        chain.stand_around(state.path)
        if any(map(survey.is_left_at_once, chain.active)):
            return False  # an ancestor is left immediately
        chain.enter((state.path,), state.parent)
        for _ in range(MAX_STEPS_TO_REST):
            if not chain.step():
                return state.path in chain.active
    except UncertainError:
        return True
    return False


def _report(
    machine: MachineDefinition, around: list[TakenTransition], asked: list[str], report: DocumentReport
) -> None:
    first = min(range(len(around)), key=lambda i: str(around[i][0].where))
    rows = around[first:] + around[:first]
    ways = ", ".join(
        f"{_way(event)} of `{machine.states[t.source].name or machine.id}`" for t, event in rows[:MAX_SHOWN_TRANSITIONS]
    )
    message, code = "this loop never ends", ENDLESS_CHAIN
    hint = "add a step that takes time, such as `after: {1s: …}`, or give one of these transitions a `guard`"
    if asked:
        message += f" while {' and '.join(f'`{shown}`' for shown in asked)} {'are' if len(asked) > 1 else 'is'} false"
        hint = "change a value that the guard checks, or add a step that takes time"
    if not any(event for _, event in rows):
        code = ALWAYS_LOOP if asked else ENDLESS_ALWAYS
        if not any(t.targets for t, _ in rows):
            hint = "give it a `target`, or move its actions to `entry`"
    related = [(t.where, "then here") for t, _ in rows[1:]]
    report(code, rows[0][0].where, f"{message}: {ways}", hint, related=related)


def _way(event: str) -> str:
    if not event:
        return "`always`"
    return "`after: 0s`" if event.startswith("after.") else f"`{event}`"
