"""Behaviours that invoke others, each joined with the machines of those others."""

from collections.abc import Collection, Mapping
from dataclasses import replace

from lumen.expressions.expression_findings import TYPE_MISMATCH, UNKNOWN_CONTEXT_KEY
from lumen.language.actions import Expression
from lumen.language.diagnostics import ERROR, Code, did_you_mean
from lumen.language.machines import Invoke, MachineDefinition
from lumen.project.document import TOO_LARGE
from lumen.project.document_report import DocumentReport
from lumen.statechart.type_checks import fits, refusal, type_checks

UNKNOWN_BEHAVIOR = Code("unknown-behavior", "references", ERROR, "the named behaviour is not in behaviors/")
INVOKE_CYCLE = Code(
    "invoke-cycle", "statecharts", ERROR, "a behaviour would invoke itself, directly or through another"
)


MAX_INVOKE_DEPTH = 16
"""How many levels of behaviours may run within one another."""


def link(
    machines: Mapping[str, MachineDefinition], reports: Mapping[str, DocumentReport], names: Collection[str]
) -> dict[str, MachineDefinition]:
    """These machines by name, each with those that it invokes; what can't be invoked is reported.

    `names` are all behaviours that there are; one that could not be read is among them and is not missed.
    """
    linker = _Linker(machines, reports, names)
    return {name: linker.machine(name) for name in machines}


def with_robots(machine: MachineDefinition, robots: tuple[str, ...]) -> MachineDefinition:
    """The machine, and those that it invokes, in a house where these robots hear what is sent to them."""
    invoked = {name: with_robots(each, robots) for name, each in machine.invoked.items()}
    return replace(machine, robots=robots, invoked=invoked)


class _Linker:
    """Goes down from each behaviour to what it invokes; `way` are those above the one that is being linked."""

    def __init__(
        self, machines: Mapping[str, MachineDefinition], reports: Mapping[str, DocumentReport], names: Collection[str]
    ) -> None:
        self.machines, self.reports, self.names = machines, reports, names
        self.linked: dict[str, MachineDefinition] = {}
        self.levels: dict[str, int] = {}
        self.way: list[str] = []

    def machine(self, name: str) -> MachineDefinition:
        """The machine of that name with those that it invokes, and they with theirs."""
        if name not in self.linked:
            self.way.append(name)
            machine, found = self.machines[name], dict[str, MachineDefinition]()
            self.levels[name] = 0
            for invoke in (i for state in machine.states.values() for i in state.invoke):
                if other := self.invoked(name, invoke):
                    found[invoke.behavior] = other
                    self.levels[name] = max(self.levels[name], 1 + self.levels[invoke.behavior])
                    self.check_input(name, invoke, other)
            self.way.pop()
            self.linked[name] = replace(machine, invoked=found) if found else machine
        return self.linked[name]

    def invoked(self, name: str, invoke: Invoke) -> MachineDefinition | None:
        """The machine that is invoked, None where it can't be."""
        report, where, wanted = self.reports[name], (*invoke.where, "behavior"), invoke.behavior
        if wanted in self.way:
            way = " → ".join(f"`{n}`" for n in (*self.way[self.way.index(wanted) :], wanted))
            message = f"`{wanted}` would invoke itself without end: {way}"
            report(INVOKE_CYCLE, where, message, hint="in one of these behaviours, use a state instead of `invoke`")
        elif wanted not in self.names:
            hint = did_you_mean(wanted, self.names, "behaviors/ has")
            report(UNKNOWN_BEHAVIOR, where, f"there is no behaviour `{wanted}`", hint=hint)
        elif wanted in self.machines:
            if (
                len(self.way) < MAX_INVOKE_DEPTH
                and (machine := self.machine(wanted))
                and self.levels[wanted] < MAX_INVOKE_DEPTH
            ):
                return machine
            hint = "combine some of the behaviours in one file"
            report(TOO_LARGE, where, f"more than {MAX_INVOKE_DEPTH} behaviours would be nested", hint=hint)
        return None

    def check_input(self, name: str, invoke: Invoke, machine: MachineDefinition) -> None:
        """Report input that the invoked behaviour has no key for, or that can't be of the key's type."""
        report, checks, called = self.reports[name], type_checks(machine), invoke.behavior
        for key, value in invoke.input.items():
            where, check = (*invoke.where, "input", key), checks.get(key)
            if key in checks:
                if not (isinstance(value, Expression) or value is None or fits(value, check)):
                    message = f"`{key}` of `{called}` {refusal(value, check)}"
                    report(TYPE_MISMATCH, where, message, hint="give it a value of that type")
            elif key not in self.reports[called].lost:
                hint = did_you_mean(key, checks, "it has")
                report(UNKNOWN_CONTEXT_KEY, where, f"the context of `{called}` has no `{key}`", hint=hint, key=True)
