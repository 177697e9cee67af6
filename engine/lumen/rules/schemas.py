"""JSON Schemas inside behaviours: those of context keys and of events."""

from lumen.loading.draft import Draft
from lumen.loading.messages import examine


def check(draft: Draft) -> None:
    """Report what is wrong with the schemas under `types:` and `events:`."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for part, schemas in (("types", machine.types), ("events", machine.events)):
            for key, schema in schemas.items():
                if schema is not None and not examine(schema, report, (part, key)):
                    draft.unsound.add((name, part, key))
