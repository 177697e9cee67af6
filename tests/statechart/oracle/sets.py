"""Which states transitions leave and enter, and which transitions go together: the sets of Appendix D.

Three times the pseudo-code, taken by its letter, leads to illegal configurations, and section 3.13 decides. Its
entry set has no state that is active and not left: `add_ancestors` ends at a state that stays, which it could pass on
the way up from what a history remembers. Its complete target set begins a compound state by default only if none
of its children is in the set: a target around another target enters nothing by itself. And a transition has one domain:
asked again after the exit, when a history among its targets has begun to remember, it could be a smaller one.
"""

from lumen.language.machines import State, StateKind, Transition
from tests.statechart.oracle.content import World
from tests.statechart.oracle.tree import Tree, is_atomic


class Sets(Tree):
    """The sets of a machine in its present configuration and history."""

    def __init__(self, world: World) -> None:
        super().__init__(world.machine)
        self.world = world

    def source(self, transition: Transition) -> State:
        return self.machine.states[transition.source]

    def remove_conflicting(self, enabled: list[Transition]) -> list[Transition]:
        filtered: list[Transition] = []
        for t1 in enabled:
            preempted, removed = False, list[Transition]()
            for t2 in filtered:
                left = self.compute_exit_set([t2])
                if any(s in left for s in self.compute_exit_set([t1])):
                    if self.is_descendant(self.source(t1), self.source(t2)):
                        removed.append(t2)
                    else:
                        preempted = True
                        break
            if not preempted:
                filtered = [t for t in filtered if not any(t is other for other in removed)] + [t1]
        return filtered

    def remembers(self, history: State, state: State) -> bool:
        parent = self.parent(history)
        assert parent is not None  # a history state lies in another
        return is_atomic(state) and self.is_descendant(state, parent) if history.deep else self.parent(state) is parent

    def compute_exit_set(self, transitions: list[Transition]) -> list[State]:
        found: list[State] = []
        for transition in transitions:
            if transition.targets:
                domain = self.transition_domain(transition)
                found += [s for s in self.world.configuration if self.is_descendant(s, domain)]
        return found

    def transition_domain(self, transition: Transition) -> State:
        source, targets = self.source(transition), self.effective_targets(self.targets(transition))
        inside = all(self.is_descendant(s, source) for s in targets)
        if not transition.reenter and source.kind is StateKind.COMPOUND and inside:
            return source
        return self.find_lcca([source, *targets])

    def targets(self, transition: Transition) -> list[State]:
        return [self.machine.states[path] for path in transition.targets]

    def effective_targets(self, targets: list[State]) -> list[State]:
        found: list[State] = []
        for state in targets:
            if state.kind is not StateKind.HISTORY:
                found.append(state)
            elif self.world.history.get(state.path):
                found += self.world.history[state.path]
            else:
                found += self.effective_targets(self.initial(state))
        return found

    def domains(self, transitions: list[Transition]) -> list[tuple[Transition, State]]:
        return [(t, self.transition_domain(t)) for t in transitions if t.targets]

    def compute_entry_set(self, domains: list[tuple[Transition, State]]) -> list[State]:
        entering: list[State] = []
        for transition, domain in domains:
            for state in self.innermost(self.targets(transition)):
                self.add_descendants(state, entering)
            for state in self.effective_targets(self.targets(transition)):
                self.add_ancestors(state, domain, entering)
        return entering

    def add_descendants(self, state: State, entering: list[State]) -> list[State]:
        if state.kind is StateKind.HISTORY:
            parent = self.parent(state)
            assert parent is not None  # a history state lies in another
            self.add_all(self.world.history.get(state.path) or self.initial(state), parent, entering)
            return entering
        entering.append(state)
        if state.kind is StateKind.COMPOUND:
            self.add_all(self.initial(state), state, entering)
        elif state.kind is StateKind.PARALLEL:
            self.add_regions(state, entering)
        return entering

    def innermost(self, states: list[State]) -> list[State]:
        return [s for s in states if not any(self.is_descendant(other, s) for other in states)]

    def add_all(self, states: list[State], top: State, entering: list[State]) -> None:
        for state in self.innermost(states):
            self.add_descendants(state, entering)
        for state in states:
            self.add_ancestors(state, top, entering)

    def add_ancestors(self, state: State, top: State, entering: list[State]) -> None:
        for above in self.proper_ancestors(state, top):
            if above in self.world.configuration:
                return
            entering.append(above)
            if above.kind is StateKind.PARALLEL:
                self.add_regions(above, entering)

    def add_regions(self, parallel: State, entering: list[State]) -> None:
        for child in self.children(parallel):
            if not any(self.is_descendant(s, child) for s in entering):
                self.add_descendants(child, entering)
