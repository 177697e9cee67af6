"""A session of states that were active before it, in another machine."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.interpreters.migration.verdicts import MigrationPlan
from lumen.interpreters.statechart.activities import ActivityRunner
from lumen.interpreters.statechart.answers import labelled
from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.hosting import output_of
from lumen.interpreters.statechart.sessions import Session
from lumen.interpreters.statechart.values import Invoked, Step
from lumen.language.events import Event


class NewWork(NamedTuple):
    """What a state that stays has to begin: behaviours to invoke, by their ids, and its `do`."""

    invokes: frozenset[str]
    do: bool


class Continued(Session):
    """States that stay (`fresh`) begin only what they did not have; `outcome` is the output of a machine at its end."""

    fresh: Mapping[StateNode, NewWork] = {}
    outcome: Any = None

    def begin(self, node: StateNode) -> None:
        if node not in self.fresh:
            super().begin(node)
            return
        for invoke, given in node.invokes:
            if invoke.id in self.fresh[node].invokes:
                self.introduce(node, invoke, given)
        if self.fresh[node].do:
            ActivityRunner.begin(self, node)

    def leave(self, node: StateNode) -> None:
        """Leave a state; it is one like others after that."""
        super().leave(node)
        self.fresh = {other: fresh for other, fresh in self.fresh.items() if other is not node}

    def adopt(self, id: str, child: Invoked, plan: MigrationPlan) -> None:
        """Go on with an invoked behaviour as planned, and follow what comes of it."""
        after = plan.snapshot
        self.invoked = {**self.invoked, id: child}
        self.commands += tuple(labelled(command, id) for command in plan.entering)
        self.language, self.counters, self.generator = after.language, after.counters, after.generator
        if self.program_of(child.state, id).planner.configuration(after.configuration).finished:
            self.end(id)
            self.post(Event(f"done.invoke.{id}", plan.output, self.at))

    def step(self) -> Step:
        found = super().step()
        self.outcome = output_of(found, self.chart.root.name)
        return found
