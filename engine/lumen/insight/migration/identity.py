"""The mapping of active states to those of a new machine: by path, or by `renamed`."""

from collections.abc import Iterator, Mapping

from lumen.language.machines import MachineDefinition

CONTEXT_PREFIX = "context."
"""The prefix of context keys in `renamed`: `context.name: context.visitor`."""


class Identity:
    """The mapping of states and context keys from an old machine to a new one.

    A renaming counts once: one that the old machine's file already contains was followed before. A renamed state
    includes the states below it. With `back`, the new machine ran before, and the old machine's renamings are undone.
    """

    def __init__(self, old: MachineDefinition, new: MachineDefinition, *, back: bool = False) -> None:
        self._new = new
        fresh = {_path(old, name): now for name, now in new.renamed.items() if old.renamed.get(name) != now}
        past = {now: _path(new, name) for name, now in old.renamed.items() if new.renamed.get(name) != now}
        again = {now: new.renamed[name] for now, name in past.items() if name in new.renamed}
        self._first: Mapping[str, str] = {n: was for n, was in past.items() if self._known(was)} if back else fresh
        self._last: Mapping[str, str] = {} if back else again

    def state(self, path: str) -> str | None:
        """Return the path in the new machine; None if the state is gone."""
        for table in (self._first, {path: path}, self._last):
            for prefix in _prefixes(path):
                if prefix in table:
                    found = table[prefix] + path[len(prefix) :]
                    if found in self._new.states:
                        return found
                    if table is self._first:
                        return None
                    break
        return None

    def keys(self) -> Mapping[str, str]:
        """Return for each key of the new context its name in the old machine."""
        names = {key: key for key in self._new.context}
        for table in (self._last, self._first):
            for was, now in table.items():
                if was.startswith(CONTEXT_PREFIX) and now.removeprefix(CONTEXT_PREFIX) in names:
                    names[now.removeprefix(CONTEXT_PREFIX)] = was.removeprefix(CONTEXT_PREFIX)
        return names

    def _known(self, name: str) -> bool:
        return name in self._new.states or name.removeprefix(CONTEXT_PREFIX) in self._new.context


def _path(machine: MachineDefinition, name: str) -> str:
    """Return the path of the state of that id; the name itself if there is none."""
    if name in machine.states:
        return name
    return next((path for path, state in machine.states.items() if path and state.alias == name), name)


def _prefixes(path: str) -> Iterator[str]:
    """Yield a path and those of the states around it, longest first."""
    while path:
        yield path
        path = path.rpartition(".")[0]
