"""Check the context and the events of a behaviour: their JSON Schemas, and the initial values of the context."""

from lumen.language.machines import MachineDefinition
from lumen.project.complaints import WRONG_VALUE
from lumen.project.document_report import DocumentReport
from lumen.project.messages import examine
from lumen.project.numbers import finite, numbers_in
from lumen.statechart.type_checks import fits, refusal, type_checks


def check_memory(machine: MachineDefinition, report: DocumentReport) -> list[tuple[str, str]]:
    """Report faults under `context:`, `types:` and `events:`; return the part and key of each invalid schema."""
    unsound = [
        (part, key)
        for part, schemas in (("types", machine.types), ("events", machine.events))
        for key, schema in schemas.items()
        if schema is not None and not examine(schema, report, (part, key))
    ]
    checks = type_checks(machine)
    for key, value in machine.context.items():
        odd = [path for path, number in numbers_in(value, ("context", key)) if not finite(number, report, path)]
        if not odd and key in machine.types and ("types", key) not in unsound and not fits(value, checks[key]):
            hint = "write an initial value that fits, or widen its schema under `types:`"
            report(WRONG_VALUE, ("context", key), f"`{key}` {refusal(value, checks[key])}", hint=hint)
    return unsound
