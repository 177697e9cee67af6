"""Access to invoked behaviours by the ids of their invokes (`hint@quiz`): their snapshots, machines and timers."""

from lumen.insight.explaining.history import RecordedStep
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.statechart.command_ids import inner_id
from lumen.statechart.values import Snapshot, Timer


def ended_timer(before: Snapshot | None, event: Event) -> Timer | None:
    """Return the timer whose end is that event, in whichever behaviour it ran; None if there is none."""
    id, owner = inner_id(event.sendid)
    inner = within(before, owner)
    return next((t for t in inner.timers if (t.id, t.event) == (id, event.name)), None) if inner and id else None


def sets_timer(one: RecordedStep, sendid: str, timer: Timer) -> bool:
    """Return whether a step set that timer."""
    _, owner = inner_id(sendid)
    before, after = within(one.before, owner), within(one.step.snapshot, owner)
    return after is not None and timer in after.timers and (before is None or timer not in before.timers)


def within(snapshot: Snapshot | None, owner: str) -> Snapshot | None:
    """Return the snapshot of the behaviour that runs under these ids; None if none does."""
    for id in reversed(owner.split("@")) if owner else ():
        child = snapshot.invoked.get(id) if snapshot else None
        snapshot = child.snapshot if child else None
    return snapshot


def machine_within(one: RecordedStep, owner: str) -> MachineDefinition:
    """Return the machine that runs under these ids."""
    machine, around = one.machine, one.before
    for id in reversed(owner.split("@")) if owner else ():
        behaviors = [i.behavior for s in machine.states.values() for i in s.invoke if i.id == id]
        child = around.invoked.get(id) if around else None
        chosen = machine.invoked_behavior(child.state, id) if child else behaviors[0]
        machine, around = machine.invoked[chosen], child.snapshot if child else None
    return machine
