"""Compiles a controller's rules into a sequence of operations on a tape.

The tape begins with the inputs, in the controller's order; every operation reads earlier values and appends one. A
value that is needed twice is computed once, and a rule that only passes on a membership needs no operation. Outputs
read only their own slots, so unrelated groups of outputs do not interact.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import Any, NamedTuple

from lumen.fuzzy.activations import ACTIVATE
from lumen.fuzzy.arithmetic import Arithmetic, Number
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.norms import norm
from lumen.language.controllers import (
    Antecedent,
    Conjunction,
    ControllerDefinition,
    Disjunction,
    Negation,
    Operators,
    Proposition,
    Rule,
    RuleBlock,
)


def _extremely(m: Arithmetic, x: Number) -> Number:
    return m.where(x <= 0.5, 2.0 * x * x, 1.0 - 2.0 * (1.0 - x) * (1.0 - x))


def _seldom(m: Arithmetic, x: Number) -> Number:
    low, high = m.sqrt(m.maximum(0.5 * x, 0.0)), m.sqrt(m.maximum(0.5 * (1.0 - x), 0.0))
    return m.where(x <= 0.5, low, 1.0 - high)


HEDGE_FUNCTIONS: Mapping[str, Callable[[Arithmetic, Number], Number]] = {
    "any": lambda m, x: 1.0,
    "not": lambda m, x: m.maximum(1.0 - x, 0.0),
    "extremely": _extremely,
    "seldom": _seldom,
    "somewhat": lambda m, x: m.sqrt(m.maximum(x, 0.0)),
    "very": lambda m, x: x * x,
}


def hedged(m: Arithmetic, hedges: tuple[str, ...], degree: Number) -> Number:
    """Return the degree after its hedges; the hedge next to the term is applied first."""
    for hedge in reversed(hedges):
        degree = HEDGE_FUNCTIONS[hedge](m, degree)
    return degree


Tape = list[Any]
Operation = Callable[[Tape], Any]


class Conclusion(NamedTuple):
    """A rule's conclusion about an output."""

    term: str
    """The output's term that it concludes."""
    slot: int
    """The slot of its degree on the tape."""
    implication: str
    """The norm by which the degree modifies the term."""


class InferenceProgram:
    """The operations of a controller under one arithmetic."""

    def __init__(self, controller: ControllerDefinition, m: Arithmetic) -> None:
        self._controller, self._m = controller, m
        self._operations: list[Operation] = []
        self._known: dict[Any, int] = {}
        self._parts: dict[int, int] = {}
        self.conclusions: dict[str, list[Conclusion]] = {name: [] for name in controller.outputs}
        """The conclusions about each output, in the order of the rules."""
        self._inputs = {name: i for i, name in enumerate(controller.inputs)}
        self.rules = [slot for block in controller.blocks for slot in self._block(block)]
        """The slot of each rule's degree, in the order written."""

    def run(self, inputs: Sequence[Any]) -> Tape:
        """Return the tape for these inputs: numbers or arrays, depending on the arithmetic."""
        tape = list(inputs)
        append = tape.append
        for operation in self._operations:
            append(operation(tape))
        return tape

    def _add(self, operation: Operation, key: Any = None) -> int:
        slot = len(self._inputs) + len(self._operations)
        self._operations.append(operation)
        if key is not None:
            self._known[key] = slot
        return slot

    def _block(self, block: RuleBlock) -> list[int]:
        """Return the slots of the rules' degrees.

        A rule may use an earlier rule's conclusion only if the activation decides about each rule alone.
        """
        operators = block.operators
        if operators.activation.method in ("general", "threshold"):
            return [self._conclude(rule, self._activated([rule], operators)[0], operators) for rule in block.rules]
        slots = self._activated(block.rules, operators)
        return [self._conclude(rule, slot, operators) for rule, slot in zip(block.rules, slots, strict=True)]

    def _activated(self, rules: Sequence[Rule], operators: Operators) -> list[int]:
        slots = [self._degree(rule, operators) for rule in rules]
        if operators.activation.method == "general":
            return slots
        m, method, activation = self._m, ACTIVATE[operators.activation.method], operators.activation
        whole = self._add(lambda tape: method(m, activation, [tape[slot] for slot in slots]))
        return [self._part(whole, i) for i in range(len(slots))]

    def _part(self, whole: int, i: int) -> int:
        """Return the slot of a rule's degree after activation; a rule with NaN before is not applied and has 0."""
        m = self._m
        part = self._add(lambda tape: tape[whole][i])
        slot = self._add(lambda tape: m.where(tape[part] == tape[part], tape[part], 0.0))
        self._parts[slot] = part
        return slot

    def _degree(self, rule: Rule, operators: Operators) -> int:
        slot, weight = self._antecedent(rule.antecedent, operators), rule.weight
        return slot if weight == 1.0 else self._add(lambda tape: weight * tape[slot])

    def _conclude(self, rule: Rule, slot: int, operators: Operators) -> int:
        """Add a rule's conclusions; return its slot.

        A consequent's hedge also changes the degrees of later ones (FuzzyLite).
        """
        degree = slot
        for proposition in rule.consequents:
            if proposition.hedges:
                degree = self._hedge(degree, proposition.hedges, slot)
            conclusion = Conclusion(proposition.term, degree, operators.implication)
            self.conclusions[proposition.variable].append(conclusion)
        return slot

    def _hedge(self, slot: int, hedges: tuple[str, ...], rule: int) -> int:
        """Return the slot of the hedged degree; it stays 0 for a rule that is not applied."""
        m, part = self._m, self._parts.get(rule)
        if part is None:
            return self._add(lambda tape: hedged(m, hedges, tape[slot]))
        return self._add(lambda tape: m.where(tape[part] == tape[part], hedged(m, hedges, tape[slot]), 0.0))

    def _antecedent(self, node: Antecedent, operators: Operators) -> int:
        match node:
            case Proposition():
                return self._proposition(node)
            case Negation(operand):
                inner = self._antecedent(operand, operators)
                return self._add(lambda tape: hedged(self._m, ("not",), tape[inner]))
            case Conjunction(left, right):
                combine = norm(self._m, operators.conjunction)
            case Disjunction(left, right):
                combine = norm(self._m, operators.disjunction)
        a, b = self._antecedent(left, operators), self._antecedent(right, operators)
        return self._add(lambda tape: combine(tape[a], tape[b]))

    def _proposition(self, node: Proposition) -> int:
        if node.variable in self._controller.outputs:
            return self._concluded(node)
        if (slot := self._known.get(node)) is not None:
            return slot
        x, m, hedges = self._value(node.variable), self._m, node.hedges
        if hedges and hedges[-1] == "any":
            return self._add(lambda tape: hedged(m, hedges, tape[x]), node)
        degree = membership(m, self._controller.inputs[node.variable].terms[node.term])
        if hedges:
            return self._add(lambda tape: hedged(m, hedges, degree(tape[x])), node)
        return self._add(lambda tape: degree(tape[x]), node)

    def _value(self, name: str) -> int:
        """Return the slot of an input's value, clipped to its range if `lock_range` is set."""
        variable, x = self._controller.inputs[name], self._inputs[name]
        if not variable.lock_range:
            return x
        if (slot := self._known.get(name)) is not None:
            return slot
        return self._add(lambda tape: self._m.clamp(tape[x], variable.minimum, variable.maximum), name)

    def _concluded(self, node: Proposition) -> int:
        """Return the slot of the degree of an output's term, as concluded by the rules so far."""
        slots = [c.slot for c in self.conclusions[node.variable] if c.term == node.term]
        aggregate = norm(self._m, self._controller.outputs[node.variable].aggregation)
        m, hedges = self._m, node.hedges
        return self._add(lambda tape: hedged(m, hedges, reduce(aggregate, [tape[s] for s in slots]) if slots else 0.0))
