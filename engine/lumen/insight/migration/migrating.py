"""The migration of a snapshot: it leaves removed states, translates all other parts, and enters new states."""

from collections.abc import Iterator

from lumen.errors import LumenError, SnapshotError
from lumen.insight.migration import carried_state
from lumen.insight.migration.placing import Placement, Unplaced, is_legal
from lumen.insight.migration.situation import MigrationOptions, Situation
from lumen.insight.migration.verdicts import MigrationPlan, MigrationVerdict, Refusal
from lumen.language.machines import MachineDefinition
from lumen.statechart.chart import StateNode
from lumen.statechart.command_ids import outer_command
from lumen.statechart.execution_context import Beginning, ExecutionContext
from lumen.statechart.invocations import Invocations
from lumen.statechart.macrostep import complete
from lumen.statechart.microstep import microstep
from lumen.statechart.values import Invoked, Snapshot, Step


def migrated(
    old: MachineDefinition, new: MachineDefinition, snapshot: Snapshot, options: MigrationOptions, behavior: str = ""
) -> MigrationVerdict:
    """Return how a snapshot continues under the new machine, which is in behaviors/BEHAVIOR.yaml.

    Raises SnapshotError if the snapshot has states that the old machine lacks.
    """
    if old == new and (not options.languages or snapshot.language in options.languages):
        return MigrationPlan(snapshot)
    try:
        situation = Situation(old, new, snapshot, options)
    except KeyError as error:
        raise SnapshotError(f"`{old.id}` has no state {error}, which is active in the snapshot") from None
    placement = situation.placement
    if situation.start.finished and not situation.still_finished():
        return situation.ended_elsewhere(behavior)
    if isinstance(placement, Unplaced):
        busy = None if options.now else situation.busy()
        return busy or situation.refusal(placement, behavior)
    delay = next(situation.delays(placement), None)
    if delay and not options.now:
        return delay
    try:
        return _Migration(situation, placement).plan(behavior)
    except LumenError as error:
        return Refusal(str(error), "let an event or a guard end it", "", behavior)


class _Migration:
    """The migration of one snapshot.

    `before` is the old machine's context; `after` and `invocations` belong to the new machine.
    """

    def __init__(self, situation: Situation, placement: Placement) -> None:
        self.situation, self.placement = situation, placement
        self.old, self.new = situation.old, situation.new
        self.invocations = Invocations({})
        self.before = self._left()
        """The context of the old machine."""
        self.after, self.notes = self._translated()

    def plan(self, behavior: str) -> MigrationVerdict:
        """Return the plan: old exits, the translated state, new entries, and what follows from them."""
        before, after = self.before, self.after
        leaving = before.commands
        for id, child in before.invocations.children.items():
            verdict = self._adopt(id, child)
            if not isinstance(verdict, MigrationPlan):
                return verdict
            leaving += tuple(outer_command(command, id) for command in verdict.leaving)
            self.notes += verdict.notes
        planner = self.new.planner
        microstep(after, planner.forced_plan(after.configuration, set(), self.placement.entered, after.history))
        if not is_legal(self.new.chart, after.configuration.nodes):
            names = ", ".join(f"`{name}`" for name in sorted(after.configuration.names))
            return Refusal(f"{names} can't be active together in the new file", "restart the exhibition", "", behavior)
        if after.configuration.finished:  # it ended before or ends now: nothing can begin any more
            after.timers, after.beginnings = (), ()
        step = complete(after)
        notes = (*self._destinations(step), *self.notes)
        return MigrationPlan(
            step.snapshot, leaving, step.commands, before.exited + step.exited, step.entered, notes, after.for_parent
        )

    def _left(self) -> ExecutionContext:
        """Leave the old machine's states that do not stay, and end what can't continue; return its context."""
        situation, snapshot = self.situation, self.situation.snapshot
        invocations = Invocations(snapshot.invoked)
        context = ExecutionContext.of(self.old, snapshot, None, snapshot.at, invocations)
        context.is_invoked = situation.options.is_invoked
        microstep(context, self.old.planner.forced_plan(situation.start, self.placement.left, set(), snapshot.history))
        for id in situation.ending(self.placement):
            if id in invocations.children:
                invocations.end(context, id)
        for node in situation.changed(self.placement):
            context.activities.cancel(context, node.path)
        return context

    def _translated(self) -> tuple[ExecutionContext, tuple[str, ...]]:
        """Return the context under the new machine, before any state is entered, and notes about lost values."""
        before, situation, kept = self.before, self.situation, self.placement.kept
        data, notes = carried_state.context(self.old.chart, self.new.chart, before.data, situation.identity)
        spoken, language = situation.options.languages, before.language
        if spoken and language not in spoken:
            language = spoken[0]
            notes += (f"language `{before.language}` was removed: the behaviour continues in `{language}`",)
        doing = before.activities.positions
        snapshot = Snapshot(
            configuration=frozenset(image.name for image in kept.values() if image.path),
            context=data,
            at=before.at,
            language=language,
            doing={image.path: doing[node.path] for node, image in kept.items() if node.path in doing},
            halted=carried_state.halted(before.activities.halted, self.old.chart, self.new.chart),
            history=carried_state.history(before.history, self.new.chart, situation.identity),
            counters=before.counters,
            generator=before.generator,
            epoch=before.epoch,
            place=before.place,
            timezone=before.timezone,
            output=before.output,
        )
        after = ExecutionContext.of(self.new, snapshot, None, before.at, self.invocations)
        after.is_invoked, after.internal_queue = before.is_invoked, before.internal_queue
        after.for_parent, after.outbox = before.for_parent, before.outbox
        after.timers = carried_state.timers(before.timers, kept, after)
        beginnings = (self._beginning(node, image) for node, image in kept.items())
        after.beginnings = tuple(found for found in beginnings if found.invokes or found.do)
        return after, notes

    def _beginning(self, node: StateNode, image: StateNode) -> Beginning:
        """Return the invokes and the `do` that begin in a state that stays, because they are new or have changed."""
        had = [(invoke.id, invoke.behavior) for invoke in node.invokes]
        invokes = tuple(invoke for invoke in image.invokes if (invoke.id, invoke.behavior) not in had)
        return Beginning(
            image, invokes, bool(image.do) and (not node.do or node in self.situation.changed(self.placement))
        )

    def _adopt(self, id: str, child: Invoked) -> MigrationVerdict:
        """Migrate an invoked behaviour as part of the new context, and return its verdict."""
        after = self.after
        owner = next(image for node, image in self.placement.kept.items() if node.path == child.state)
        behavior = self.new.chart.definition.invoked_behavior(owner.path, id)
        old, new = self.old.invoked[behavior].chart.definition, self.new.invoked[behavior].chart.definition
        lent = child.snapshot._replace(
            language=after.language,
            counters=after.counters,
            generator=after.generator,
            epoch=after.epoch,
            place=after.place,
            timezone=after.timezone,
        )
        options = self.situation.options._replace(at=after.at, languages=(), is_invoked=True)
        verdict = migrated(old, new, lent, options, behavior)
        if isinstance(verdict, MigrationPlan):
            for event in verdict.sent:
                after.raise_event(event)
            after.commands += tuple(outer_command(command, id) for command in verdict.entering)
            self.invocations.adopt(after, id, Invoked(owner.path, verdict.snapshot, child.commands))
        return verdict

    def _destinations(self, step: Step) -> Iterator[str]:
        """Yield a sentence for each removed state that was active, with the state that the behaviour enters instead."""
        gone = [node for node in self.placement.left if self.situation.identity.state(node.path) is None]
        inner = [node for node in gone if not any(child in gone for child in node.children)]
        names = step.snapshot.configuration
        states = self.new.chart.definition.states.values()
        after = [s.name for s in states if s.name in set(step.entered) & names]
        on = f": the behaviour goes to `{after[-1]}`" if after else ""
        yield from (f"`{node.name}` is gone{on}" for node in sorted(inner, key=lambda node: node.index))
