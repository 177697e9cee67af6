"""Random machines with everything that Appendix D speaks of, as hypothesis strategies."""

from collections.abc import Iterator
from typing import Any

from hypothesis import strategies as st

from lumen.statechart import Machine

Data = dict[str, Any]
Event = tuple[str, Any]

EVENTS = ["a", "b", "b.c", "b.c.d", "bc", "x.y"]
DESCRIPTORS = ["a", "b", "b.*", "b.c", "b.c.*", "x", "x.y", "*", "error", "error.execution", "done.state"]
GUARDS = [
    "context.n < 4",
    "context.n % 2 == 0",
    "event.data.k > 1",
    "has(event.data.k)",
    "context.t == 'x'",
    "In(S)",
    "size(state.path) > 2",
]
ACTIONS: list[Data] = [
    {"assign": {"n": "context.n + 1"}},
    {"assign": {"n": "context.n + event.data.k"}},
    {"assign": {"n": "context.n + 1", "t": "context.n"}},
    {"assign": {"t": "event.name", "any": {"was": "context.any", "list": ["context.n", 1]}}},
    {"assign": {"any.was": "context.n", "t": "event.name"}},
    {"assign": {"t": "In(S) ? 'x' : 'y'"}},
    {"if": "context.n < 9", "then": [{"assign": {"n": "context.n + 1"}}, {"raise": "a"}], "else": [{"play": "p"}]},
    {"if": "event.data.k > 0", "then": [{"raise": {"event": "b.c", "data": {"k": "event.data.k - 1"}}}]},
    {"if": "event.name != 'x.y'", "then": [{"raise": "x.y"}]},
    {"send": {"event": "b", "data": {"k": "context.n"}}},
    {"send": {"event": "a", "delay": "300ms", "id": "one"}},
    {"cancel": "one"},
    {"play": "wave"},
    {"log": "{{ context.n }} in {{ state.path }}"},
]
DEEDS: list[Data] = [
    *ACTIONS,
    {"say": {"any": ["x", "y", "z"]}},
    {"wait": "200ms"},
    {"parallel": [{"say": "x"}, {"wait": "100ms"}, {"if": "context.n > 2", "then": [{"play": "p"}, {"wait": "50ms"}]}]},
]

happenings: st.SearchStrategy[list[Event | None]] = st.lists(
    st.none() | st.tuples(st.sampled_from(EVENTS), st.sampled_from([None, {"k": 1}, {"k": 3}, {"k": "text"}])),
    min_size=1,
    max_size=10,
)
"""Events from outside, and None for the timer that ends next."""


@st.composite
def machine_data(draw: st.DrawFn, *, deeds: bool = False) -> Data:
    """Draw a random machine as a dict: four levels, any target; with `deeds` its states have a `do`."""
    return Making(draw, deeds).data()


def machines(*, deeds: bool = False) -> st.SearchStrategy[Machine]:
    return machine_data(deeds=deeds).map(Machine.from_dict)


class Making:
    """One machine under construction: first the tree of its states, then the contents of each."""

    def __init__(self, draw: st.DrawFn, deeds: bool) -> None:
        self.draw, self.deeds = draw, deeds
        self.states: dict[str, Data] = {}
        self.left = draw(st.integers(2, 14))

    def data(self) -> Data:
        root = self.state("", 0)
        for path, state in self.states.items():
            self.fill(path, state)
        return {"id": "root", "context": {"n": 0, "t": "x", "any": None}, **root}

    def chance(self, percent: int) -> bool:
        return self.draw(st.integers(0, 99)) >= 100 - percent

    def pick(self, options: list[Any]) -> Any:
        return options[self.draw(st.integers(0, len(options) - 1))]

    def state(self, path: str, depth: int) -> Data:
        """Return the tree of states; those without children may be final, and some children are histories."""
        data: Data = {}
        self.states[path] = data
        if path and self.chance(30):
            data["id"] = f"i{len(self.states)}"
        if depth == 0 or (depth < 4 and self.left > 1 and self.chance(65)):
            parallel = self.chance(40)
            data.update({"type": "parallel"} if parallel else {})
            data["states"] = {}
            for index in range(self.draw(st.integers(1 if depth else 2, 3))):
                self.left -= 1
                below = f"{path}.c{index}".lstrip(".")
                data["states"][f"c{index}"] = self.state(below, depth + 1)
            self.end(data["states"], 50 if not parallel else 25)
            for kind in ("shallow", "deep"):
                if self.chance(25):
                    data["states"][kind] = self.states[f"{path}.{kind}".lstrip(".")] = {
                        "type": "history",
                        "history": kind,
                    }
        return data

    def end(self, children: dict[str, Data], percent: int) -> None:
        """Perhaps make the last child final."""
        last = list(children.values())[-1]
        if "states" not in last and self.chance(percent):
            last["type"] = "final"

    def fill(self, path: str, data: Data) -> None:
        kind = data.get("type", "")
        if kind == "history":
            if self.chance(50):
                data["target"] = self.beginning(path.rpartition(".")[0])
            return
        for key in ("entry", "exit"):
            if self.chance(40):
                data[key] = self.actions()
        if kind == "final":
            data.update({"output": {"k": self.pick(["context.n", "event.data.k"])}} if self.chance(50) else {})
            return
        if self.deeds and self.chance(50):
            data["do"] = self.actions(DEEDS, 3)
        if "states" in data and kind != "parallel" and self.chance(30):
            data["initial"] = self.beginning(path)
        self.transitions(data)

    def transitions(self, data: Data) -> None:
        events = dict.fromkeys(self.pick(DESCRIPTORS) for _ in range(self.draw(st.integers(0, 2))))
        data["on"] = {event: [self.answer(event) for _ in range(self.draw(st.integers(1, 2)))] for event in events}
        if self.chance(15):
            data["always"] = self.bounded()
        if self.chance(20):
            data["after"] = {self.pick(["100ms", "300ms", "1s"]): self.transition()}
        if self.chance(50) and ("states" in data or "do" in data):
            data["onDone"] = self.bounded()
        if "do" in data and self.chance(50):
            data["onError"] = self.transition()

    def answer(self, event: str) -> Data:
        """Return a transition, which mostly can't bring itself about without end."""
        inner = event == "*" or event.startswith(("done", "error"))
        return self.bounded() if inner and self.chance(95) else self.transition()

    def bounded(self) -> Data:
        """Return a transition that can fire a few times only."""
        data = self.transition(f"context.n < {self.draw(st.integers(1, 9))}")
        data["actions"] = [{"assign": {"n": "context.n + 1"}}, *data.get("actions", [])]
        return data

    def transition(self, guard: str = "") -> Data:
        data: Data = {"target": self.target()} if self.chance(85) else {}
        if self.chance(30):
            data["reenter"] = True
        if guard or self.chance(45):
            data["guard"] = guard or self.pick(GUARDS).replace("S", f"'{self.pick([p for p in self.states if p])}'")
        if not data.get("target") or self.chance(50):
            data["actions"] = self.actions()
        return data

    def actions(self, options: list[Data] = ACTIONS, most: int = 2) -> list[Data]:
        states = [path for path in self.states if path]
        return [named(self.pick(options), self.pick(states)) for _ in range(self.draw(st.integers(1, most)))]

    def target(self) -> Any:
        histories = [path for path, state in self.states.items() if state.get("type") == "history"]
        path = self.pick(histories if histories and self.chance(30) else list(self.states))
        if not path:
            return "#root"
        together = [other for other in self.states if other and self.meet(path, other)]
        if together and self.chance(40):
            return [f"#{path}", f"#{self.pick(together)}"]
        return f"#{path}"

    def beginning(self, home: str) -> Any:
        """Return states below `home` to begin in: one, or two of different regions."""
        below = [p for p in self.under(home) if self.states[p].get("type") != "history"]
        path = self.pick(below)
        together = [p for p in below if self.meet(path, p)]
        return [f"#{path}", f"#{self.pick(together)}"] if together and self.chance(50) else f"#{path}"

    def under(self, home: str) -> Iterator[str]:
        return (p for p in self.states if p and p != home and (not home or p.startswith(f"{home}.")))

    def meet(self, one: str, other: str) -> bool:
        """Return whether two states are in different regions of a parallel state, or one is in the other."""
        left, right = one.split("."), other.split(".")
        common = 0
        while common < min(len(left), len(right)) and left[common] == right[common]:
            common += 1
        if common in (len(left), len(right)):
            return one != other
        histories = {left[common], right[common]} & {"shallow", "deep"}
        return not histories and self.states[".".join(left[:common])].get("type") == "parallel"


def named(value: Any, state: str) -> Any:
    """Return the action, with `S` in its expressions replaced by the name of a state."""
    match value:
        case dict():
            return {key: named(item, state) for key, item in value.items()}
        case list():
            return [named(item, state) for item in value]
        case str():
            return value.replace("In(S)", f"In('{state}')")
    return value
