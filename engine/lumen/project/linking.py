"""Link behaviours to the machines of the behaviours that they invoke."""

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
"""The maximum depth to which behaviours may invoke one another."""


def link(
    machines: Mapping[str, MachineDefinition], reports: Mapping[str, DocumentReport], names: Collection[str]
) -> dict[str, MachineDefinition]:
    """Return these machines by name, each with those that it invokes; invalid invocations are reported.

    `names` are the names of all behaviours, including unreadable ones, so that a reference to one of those is not
    reported.
    """
    linker = _Linker(machines, reports, names)
    return {name: linker.machine(name) for name in machines}


def with_robots(machine: MachineDefinition, robots: tuple[str, ...]) -> MachineDefinition:
    """Return the machine, and those that it invokes, with the names of the robots that `send` can address."""
    invoked = {name: with_robots(each, robots) for name, each in machine.invoked.items()}
    return replace(machine, robots=robots, invoked=invoked)


class _Linker:
    """Links each behaviour after those that it invokes; `way` is the chain of invocations from the outermost one."""

    def __init__(
        self, machines: Mapping[str, MachineDefinition], reports: Mapping[str, DocumentReport], names: Collection[str]
    ) -> None:
        self.machines, self.reports, self.names = machines, reports, names
        self.linked: dict[str, MachineDefinition] = {}
        self.levels: dict[str, int] = {}
        self.way: list[str] = []

    def machine(self, name: str) -> MachineDefinition:
        """Return the machine of that name, linked to those that it invokes at every depth."""
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
        """Return the invoked machine, or None if it can't be invoked; report why unless its own file has errors."""
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
        """Report input that the invoked behaviour has no key for, or that does not fit the key's type."""
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
