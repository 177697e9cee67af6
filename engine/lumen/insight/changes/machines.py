"""The differences between two versions of a behaviour: its states, context, phrases, answers, lists and events."""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from lumen.insight.changes.actions import block_changes
from lumen.insight.changes.change import Change, Risk, code, how_many, names, quoted
from lumen.insight.changes.transitions import transition_changes
from lumen.insight.migration.placing import Identity
from lumen.language.machines import MachineDefinition, State


def machine_changes(name: str, old: MachineDefinition, new: MachineDefinition) -> Iterator[Change]:
    """Yield the changes of behaviors/NAME.yaml; a renamed state counts as the same state."""
    return _Comparison(name, old, new).all()


class _Comparison:
    def __init__(self, name: str, old: MachineDefinition, new: MachineDefinition) -> None:
        self.name, self.old, self.new, self.file = name, old, new, f"behaviors/{name}.yaml"
        identity = Identity(old, new)
        self.images = {path: identity.state(path) if path else "" for path in old.states}

    def change(self, kind: str, about: str, sentence: str, risk: Risk = Risk.BEHAVIOR, part: str = "") -> Change:
        """Return a change in the behaviour's file, or in the words file that provides `about` under the key `part`."""
        words = self.new.borrowed.get((part, about)) or self.old.borrowed.get((part, about))
        return Change(kind, about, sentence, risk, f"behaviors/words/{words}.yaml" if words else self.file)

    def title(self, state: State) -> str:
        return f"state `{state.name}`" if state.path else f"`{self.name}`"

    def all(self) -> Iterator[Change]:
        yield from self.presence()
        for path, image in self.images.items():
            if image is not None:
                yield from self.state(self.old.states[path], self.new.states[image])
        yield from self.context()
        yield from self.phrases()
        yield from self.answers()
        yield from self.named("list", self.old.lists, self.new.lists)
        old, new = ({one.name: one for one in machine.properties} for machine in (self.old, self.new))
        yield from self.named("property", old, new)
        yield from self.named("event", self.old.events, self.new.events)

    def presence(self) -> Iterator[Change]:
        """Yield the states that were removed, added, renamed or moved.

        Of nested removed or added states, only the outermost are included.
        """
        known = set(self.images.values())
        gone = {path: None for path, image in self.images.items() if image is None}
        fresh = {path: None for path in self.new.states if path not in known}
        yield from self.outermost(self.old, gone, "removed")
        yield from self.outermost(self.new, fresh, "added")
        for path, image in self.images.items():
            parent = self.old.states[path].parent
            moved = image is not None and parent is not None and image != _below(self.images[parent], path)
            if moved and image is not None:
                sentence = f"{self.title(self.old.states[path])} is now `{self.new.states[image].path}`"
                yield self.change("state", path, sentence)

    def outermost(self, machine: MachineDefinition, paths: Collection[str], how: str) -> Iterator[Change]:
        """Yield a change for each outermost state in `paths`, with the number of states in `paths` inside it."""
        within = Counter(around for path in paths for around in _around(path) if around in paths)
        for path in paths:
            if machine.states[path].parent not in paths:
                more = f", with {within[path]} within" if within[path] else ""
                yield self.change("state", path, f"{self.title(machine.states[path])} {how}{more}")

    def state(self, old: State, new: State) -> Iterator[Change]:
        title = self.title(new)
        if old.kind != new.kind:
            yield self.change("state", title, f"{title} is now {new.kind}, not {old.kind}")
        if self.mapped(old.initial) != new.initial and old.kind == new.kind:
            begin = names(self.new.states[path].name for path in new.initial) or "nothing"
            yield self.change("state", title, f"{title} now begins in {begin}")
        for when, before, after in (
            (" on entering", old.entry, new.entry),
            ("", old.do, new.do),
            (" on leaving", old.exit, new.exit),
        ):
            yield from block_changes(before, after, title, when, self.file)
        yield from transition_changes(old, new, title, self.file, self.mapped, self.named_now)
        yield from self.invokes(old, new, title)
        if old.for_each != new.for_each:
            how = (
                f"now goes through {code(new.for_each.each.shown)}" if new.for_each else "no longer goes through a list"
            )
            yield self.change("state", title, f"{title} {how} (`for`)")
        if old.resume != new.resume:
            yield self.change(
                "state", title, f"`resume` of {title} {f'is now `{new.resume}`' if new.resume else 'is gone'}"
            )
        if old.life != new.life:
            how = f"now has the style of life `{new.life}`" if new.life else "no longer sets a style of life"
            yield self.change("state", title, f"{title} {how}")
        if old.gestures != new.gestures:
            how = "without" if new.gestures else "with"
            yield self.change("state", title, f"{title} now speaks {how} gestures")
        yield from self.buttons(old, new, title)
        if self.mapped((old.on_reload,) if old.on_reload else ()) != ((new.on_reload,) if new.on_reload else ()):
            target = f"now leads to `{self.new.states[new.on_reload].name}`" if new.on_reload else "is gone"
            yield self.change("state", title, f"`onReload` of {title} {target}")
        if old.output != new.output:
            yield self.change("state", title, f"{title} now returns different data")

    def buttons(self, old: State, new: State, title: str) -> Iterator[Change]:
        """Yield the buttons that were added, removed or changed.

        They are matched by their labels, because nothing else identifies a button.
        """
        before, after = ({next(iter(b.label.values())): b for b in one.buttons} for one in (old, new))
        for label in dict.fromkeys((*before, *after)):
            if before.get(label) != after.get(label):
                how = "added" if label not in before else "removed" if label not in after else "changed"
                yield self.change("button", title, f"the button {quoted(label)} of {title} {how}")

    def named_now(self, path: str) -> str:
        """Return the name of the state at a path; if it was removed, its old name."""
        return (self.new.states.get(path) or self.old.states[path]).name

    def mapped(self, paths: tuple[str, ...]) -> tuple[str, ...]:
        """Convert old paths to those in the new machine; the path of a removed state is unchanged."""
        return tuple(self.images.get(path) or path for path in paths)

    def invokes(self, old: State, new: State, title: str) -> Iterator[Change]:
        before, after = {i.id: i for i in old.invoke}, {i.id: i for i in new.invoke}
        for id in dict.fromkeys((*before, *after)):
            if id not in after:
                yield self.change("invoke", title, f"{title} no longer invokes `{before[id].behavior}`")
            elif before.get(id) != after[id]:
                same = id in before and before[id].behavior == after[id].behavior
                how = " with different input" if same else ""
                yield self.change("invoke", title, f"{title} now invokes `{after[id].behavior}`{how}")

    def context(self) -> Iterator[Change]:
        old, new = self.old, self.new
        was = Identity(old, new).keys()
        for key in old.context:
            if key not in was.values():
                yield self.change("context", key, f"context key `{key}` removed")
        for key, before in was.items():
            if before not in old.context:
                yield self.change("context", key, f"context key `{key}` added")
                continue
            if before != key:
                yield self.change("context", key, f"context key `{before}` is now `{key}`")
            if old.context[before] != new.context[key]:
                first = f"{code(new.context[key])}, not {code(old.context[before])}"
                yield self.change("context", key, f"`{key}` begins with {first}, from the next start on")
            if old.types.get(before) != new.types.get(key):
                yield self.change("context", key, f"the type of `{key}` changed")

    def phrases(self) -> Iterator[Change]:
        yield from self.named("phrases", self.old.phrases, self.new.phrases)
        both = self.old.phrases.keys() & self.new.phrases.keys()
        for name in sorted(both & (self.old.anyhow ^ self.new.anyhow)):
            how = (
                "now count even if they are negated"
                if name in self.new.anyhow
                else "no longer count if they are negated"
            )
            yield self.change("phrases", name, f"phrases `{name}` {how}", part="phrases")

    def answers(self) -> Iterator[Change]:
        """Yield the changes of answers: another text for the same phrases is cosmetic, everything else is behaviour."""
        old, new = self.old.answers, self.new.answers
        for table in dict.fromkeys((*old, *new)):
            before, after = old.get(table, ()), new.get(table, ())
            if [row.phrases for row in before] == [row.phrases for row in after]:
                for one, other in zip(before, after, strict=True):
                    if one.value != other.value:
                        said = f"`{table}` now answers {quoted(_example(other.value))}"
                        yield self.change("text", table, said, Risk.COSMETIC, "answers")
            else:
                rows = f"{how_many(len(after), 'row')}, not {len(before)}" if len(before) != len(after) else ""
                how = f"now has {rows}" if rows else "listens for different phrases, or in a different order"
                yield self.change("answers", table, f"`{table}` {how}", part="answers")

    def named(self, kind: str, old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[Change]:
        for key in dict.fromkeys((*old, *new)):
            if key not in new or key not in old or old[key] != new[key]:
                how = "added" if key not in old else "removed" if key not in new else "changed"
                yield self.change(kind, key, f"{kind} `{key}` {how}", part="lists" if kind == "list" else kind)


def _below(parent: str | None, path: str) -> str:
    return f"{parent}.{path.rpartition('.')[2]}" if parent else path.rpartition(".")[2]


def _around(path: str) -> Iterator[str]:
    """Yield the paths of the states around a state, innermost first."""
    while path := path.rpartition(".")[0]:
        yield path


def _example(value: Any) -> str:
    return str(next(iter(value.values()), "") if isinstance(value, Mapping) else value)
