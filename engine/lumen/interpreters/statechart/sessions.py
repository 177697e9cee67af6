"""What a machine hears, sorted: timers that have ended, the robot's answers, and news."""

from lumen.interpreters.statechart.answers import CommandAnswer, answer_of, inside
from lumen.interpreters.statechart.doing import awaited
from lumen.interpreters.statechart.hosting import InvocationRunner
from lumen.interpreters.statechart.values import Step, Timer
from lumen.language.events import Event


class Session(InvocationRunner):
    """A run from one event until everything rests."""

    def hear(self, event: Event) -> Step:
        """Take an event, and all that follows from it.

        Those behaviours that were invoked before hear news too, after the machine itself: what it leaves because of
        them ends without a word.
        """
        if event.sendid:
            self.elapse(event)
        elif ".command." in event.name and (answer := answer_of(event)):
            self.answer(event, answer)
        else:
            self.news = event if self.invoked else None
            self.take(self.configuration.candidates(event.name))
        return self.settle()

    def elapse(self, event: Event) -> None:
        """A timer has ended, its own or an invoked behaviour's; one that is no longer there was cancelled."""
        ended = [t for t in self.timers if t.id == event.sendid and t.event == event.name]
        if not ended:
            id, owner = inside(event.sendid)
            if owner in self.invoked:
                self.tell(owner, event._replace(sendid=id))
            return
        timer = min(ended, key=lambda t: t.due)
        self.timers = _without(self.timers, timer)
        if timer.kind == "after":
            self.take(self.configuration.timed(timer.event))
        elif timer.kind == "send":
            self.take(self.configuration.candidates(event.name))
        elif timer.id in awaited(self.doing.get(timer.state)):
            self.answered(timer.state, timer.id)

    def answer(self, event: Event, answer: CommandAnswer) -> None:
        """What became of a command: the `do` that awaits it goes on or fails; nobody else hears of it."""
        kind, id, reason = answer
        own, owner = inside(id)
        if owner:
            self.hand_down(event, kind, own, owner)
            return
        waiting = next((path for path, position in self.doing.items() if id in awaited(position)), None)
        if waiting is not None and kind == "done":
            self.answered(waiting, id)
        elif waiting is not None:
            self.begun = ()
            self.collapse(self.chart.nodes[waiting], id, reason)
        elif kind == "error" and id.startswith("c"):
            self.post(Event("error.communication", {"command": id, "reason": reason}, self.at))

    def hand_down(self, event: Event, kind: str, id: str, owner: str) -> None:
        """Give an answer to the behaviour whose command it was; not to one of the same name that began later."""
        child = self.invoked.get(owner)
        if child and not (id.startswith("c") and int(id[1:].partition("@")[0]) <= child.commands):
            self.tell(owner, event._replace(name=f"{kind}.command.{id}"))


def _without(timers: tuple[Timer, ...], timer: Timer) -> tuple[Timer, ...]:
    index = next(i for i, t in enumerate(timers) if t is timer)
    return timers[:index] + timers[index + 1 :]
