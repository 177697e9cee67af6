"""The `do` of active states, begun, moved on by answers, and ended."""

from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.doing import ActivityError, awaited, begin_block, resume
from lumen.interpreters.statechart.execution_context import ExecutionContext
from lumen.interpreters.statechart.values import Within
from lumen.language.commands import Cancel
from lumen.language.events import Event


class ActivityRunner(ExecutionContext):
    """A workbench that knows how far each `do` has come."""

    def begin_waiting(self) -> None:
        """Begin what every state entered and not left has to do, in the order of entry."""
        waiting, self.waiting = sorted(self.waiting, key=lambda node: node.index), ()
        for node in waiting:
            self.begin(node)

    def begin(self, node: StateNode) -> None:
        """Begin what a state does while it is active."""
        if node.do:
            self.stand(node)
            self.progress(node, None)

    def answered(self, path: str, id: str) -> None:
        """Go on with the `do` of that state, since what it awaited is over."""
        node = self.chart.nodes[path]
        self.stand(node)
        self.progress(node, id)

    def progress(self, node: StateNode, id: str | None) -> None:
        self.begun = ()
        try:
            position = begin_block(self, node.do) if id is None else resume(self, node.do, self.doing[node.path], id)
        except ActivityError as error:
            self.fail(error.reason, error.where)
            self.collapse(node, id, error.reason)
            return
        self.place(node.path, position)
        if position is None:
            self.post(Event(f"done.do.{node.name}", None, self.at))

    def collapse(self, node: StateNode, id: str | None, reason: str) -> None:
        """End a `do` that failed: its other commands are cancelled, and its state hears why."""
        self.release([i for i in (*awaited(self.doing.get(node.path)), *self.begun) if i != id])
        self.place(node.path, None)
        self.post(Event(f"error.do.{node.name}", {"command": id, "reason": reason}, self.at))

    def abandon(self, path: str) -> None:
        """End a `do` whose state is left."""
        self.release(list(awaited(self.doing[path])))
        self.place(path, None)

    def place(self, path: str, position: Within | None) -> None:
        rest = {p: where for p, where in self.doing.items() if p != path}
        self.doing = {**rest, path: position} if position else rest

    def release(self, ids: list[str]) -> None:
        """Cancel what is awaited under these ids: a timer is taken back, a command told so."""
        pauses = {t.id for t in self.timers if t.kind == "wait" and t.id in ids}
        self.timers = tuple(t for t in self.timers if t.kind != "wait" or t.id not in pauses)
        for id in ids:
            if id not in pauses:
                self.emit(Cancel(id))
