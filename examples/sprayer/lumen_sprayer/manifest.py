"""The rows that the package adds to Lumen. Import nothing but `lumen.feature`: each start of Lumen reads this."""

from lumen.feature import Feature, PartRow, Phase, Section, VerbRow

FEATURE = Feature(
    name="sprayer",
    sections={
        "sprayer": Section(
            read="lumen_sprayer.settings:read_sprayer",
            schema="lumen_sprayer.settings:SCHEMA",
            title="nozzle",
            risk="wiring",
            entries="nozzles",
        )
    },
    verbs={
        "spray": VerbRow(
            performer="lumen_sprayer.spraying",
            description="Spray the scent of a nozzle.",
            arguments={
                "required": ["duration", "nozzle"],
                "properties": {
                    "duration": {"type": "string", "format": "duration", "description": "How long", "examples": ["2s"]},
                    "nozzle": {"type": "string", "description": "A nozzle of lumen.yaml", "examples": ["left"]},
                },
            },
            takes="{{ duration }}",
        )
    },
    rules=("lumen_sprayer.rules:check",),
    pages=("lumen_sprayer.pages",),
    parts=(PartRow("scents", Phase.WATCH, "lumen_sprayer.scents:make", "brain"),),
    forgets=("lumen_sprayer.scents:ScentsPart",),
)
