"""Takes a snapshot from an old machine to a new one: leaves what is gone, translates, enters what is new."""

from collections.abc import Iterator

from lumen.errors import LumenError, SnapshotError
from lumen.interpreters.migration import carried_state as carrying
from lumen.interpreters.migration.continued import Continued, NewWork
from lumen.interpreters.migration.placing import Placement, Unplaced, is_legal
from lumen.interpreters.migration.situation import MigrationOptions, Situation, invoked_behavior
from lumen.interpreters.migration.verdicts import MigrationDelay, MigrationPlan, MigrationVerdict, Refusal
from lumen.interpreters.statechart.answers import labelled
from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.sessions import Session
from lumen.interpreters.statechart.values import Invoked, Snapshot, Step
from lumen.language.machines import MachineDefinition

__all__ = ["MigrationOptions", "move"]


def move(
    old: MachineDefinition, new: MachineDefinition, snapshot: Snapshot, how: MigrationOptions, behavior: str = ""
) -> MigrationVerdict:
    """How the snapshot goes on under the new machine, which stands in behaviors/BEHAVIOR.yaml."""
    if old == new and (not how.languages or snapshot.language in how.languages):
        return MigrationPlan(snapshot)
    try:
        moving = _Moving(old, new, snapshot, how)
    except KeyError as error:
        raise SnapshotError(f"`{old.id}` has no state {error}, which is active in the snapshot") from None
    if isinstance(moving.placement, Unplaced):
        busy = None if how.now else moving.busy()
        return busy or moving.refusal(moving.placement, behavior)
    wait = next(moving.waits(moving.placement), None)
    if wait and not how.now:
        return wait
    try:
        return moving.go(moving.placement, behavior)
    except LumenError as error:
        return Refusal(str(error), "let an event or a guard end it", "", behavior)


class _Moving(Situation):
    """One snapshot on its way."""

    def go(self, placement: Placement, behavior: str) -> MigrationPlan | Refusal | MigrationDelay:
        """The plan: exits of the old machine, what stays translated, entries of the new one, and what follows."""
        out = self.leave(placement)
        into, notes = self.arrive(placement, out)
        leaving = out.commands
        for id, child in out.invoked.items():
            verdict = self.follow(into, placement, id, child)
            if not isinstance(verdict, MigrationPlan):
                return verdict
            leaving += tuple(labelled(command, id) for command in verdict.leaving)
            notes += verdict.notes
        into.microstep(self.new.planner.passage(into.configuration, set(), set(placement.entered), into.history))
        if not is_legal(self.new.chart, into.configuration.nodes):
            names = ", ".join(f"`{name}`" for name in sorted(into.configuration.names))
            return Refusal(f"{names} can't be active together in the new file", "restart the exhibition", "", behavior)
        step = into.settle()
        notes = (*self.whereto(placement, step), *notes)
        return MigrationPlan(
            step.snapshot, leaving, step.commands, out.exited + step.exited, step.entered, notes, into.outcome
        )

    def leave(self, placement: Placement) -> Session:
        """Leave what does not stay, and end what can't go on, by the old machine."""
        out = Session(self.old, self.before, None, self.before.at)
        out.microstep(self.old.planner.passage(self.start, set(placement.left), set(), self.before.history))
        for id in self.ending(placement):
            if id in out.invoked:
                out.end(id)
        for node in self.changed(placement):
            out.abandon(node.path)
        return out

    def arrive(self, placement: Placement, out: Session) -> tuple[Continued, tuple[str, ...]]:
        """What stays, under the new machine; nothing is entered yet."""
        old, new, kept = self.old.chart, self.new.chart, placement.kept
        values, notes = carrying.context(old, new, out.context, self.identity)
        spoken, language = self.how.languages, out.language
        if spoken and language not in spoken:
            language = spoken[0]
            notes += (f"language `{out.language}` is gone: on in `{language}`",)
        before = Snapshot(
            configuration=frozenset(image.name for image in kept.values() if image.path),
            context=values,
            at=out.at,
            language=language,
            timers=carrying.timers(out.timers, kept, out.at),
            doing={image.path: out.doing[node.path] for node, image in kept.items() if node.path in out.doing},
            history=carrying.history(out.history, new, self.identity),
            counters=out.counters,
            generator=out.generator,
            epoch=out.epoch,
        )
        into = Continued(self.new, before, None, out.at)
        into.queue = out.queue
        into.fresh = {image: self.fresh(node, image, placement) for node, image in kept.items()}
        into.waiting = tuple(image for image, fresh in into.fresh.items() if any(fresh))
        return into, notes

    def fresh(self, node: StateNode, image: StateNode, placement: Placement) -> NewWork:
        """What a state that stays did not have before."""
        had = [(invoke.id, invoke.behavior) for invoke, _ in node.invokes]
        new = frozenset(i.id for i, _ in image.invokes if (i.id, i.behavior) not in had)
        return NewWork(new, bool(image.do) and (not node.do or node in self.changed(placement)))

    def follow(self, into: Continued, placement: Placement, id: str, child: Invoked) -> MigrationVerdict:
        """Let an invoked behaviour go on under its new machine; what it enters is asked for by `into`."""
        owner = next(image for node, image in placement.kept.items() if node.path == child.state)
        behavior = invoked_behavior(self.new, owner.path, id)
        old, new = self.old.invoked[behavior].chart.machine, self.new.invoked[behavior].chart.machine
        lent = child.snapshot._replace(
            language=into.language, counters=into.counters, generator=into.generator, epoch=into.epoch
        )
        verdict = move(old, new, lent, self.how._replace(at=into.at, languages=()), behavior)
        if isinstance(verdict, MigrationPlan):
            into.adopt(id, Invoked(owner.path, verdict.snapshot, child.commands), verdict)
        return verdict

    def whereto(self, placement: Placement, step: Step) -> Iterator[str]:
        """A sentence for each state that is gone, and where that leads."""
        gone = [node for node in placement.left if self.identity.state(node.path) is None]
        inner = [node for node in gone if not any(child in gone for child in node.children)]
        names = step.snapshot.configuration
        after = [s.name for s in self.new.chart.machine.states.values() if s.name in set(step.entered) & names]
        on = f": on to `{after[-1]}`" if after else ""
        yield from (f"`{node.name}` is gone{on}" for node in sorted(inner, key=lambda node: node.index))
