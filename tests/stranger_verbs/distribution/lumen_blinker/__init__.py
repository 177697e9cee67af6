"""The manifest of a package that teaches robots to blink."""

from lumen.feature import Feature, VerbRow

EYES = {"enum": ["left", "right", "both"], "default": "both", "description": "Which eyes."}
TIMES = {"type": "integer", "minimum": 1, "description": "How often."}

FEATURE = Feature(
    name="blinker",
    verbs={
        "blink": VerbRow(
            performer="lumen_blinker.blinking",
            description="Blink with the eyes.",
            arguments={"required": ["times"], "properties": {"times": TIMES, "eye": EYES, "for": {"type": "string"}}},
            result={"type": "object", "properties": {"blinked": {"type": "integer", "default": 2}}},
            takes="{{ times * 0.5 }}s",
            parts=("head",),
        ),
        "squint": VerbRow(
            performer="lumen_blinker.performers:WAITS",
            arguments={"required": ["length"], "properties": {"length": {"type": "string", "format": "duration"}}},
            takes="{{ length }}",
        ),
        "wiggle": VerbRow(performer="lumen_blinker.performers:WAITS", takes="2s", parts=("head", "arms"), moves=True),
        "tiptoe": VerbRow(performer="lumen_blinker.performers:WAITS", parts=("legs",), moves=True),
        "hum": VerbRow(performer="lumen_blinker.performers:WAITS", takes="5s", cancel=False),
        "stall": VerbRow(performer="lumen_blinker.performers:STALLS"),
        "break": VerbRow(performer="lumen_blinker.performers:BREAKS"),
        "refuse": VerbRow(performer="lumen_blinker.performers:REFUSES"),
        "misreport": VerbRow(
            performer="lumen_blinker.performers:MISREPORTS", result={"properties": {"blinked": {"type": "integer"}}}
        ),
        "exit": VerbRow(performer="lumen_blinker.performers:EXITS"),
        "count": VerbRow(performer="lumen_blinker.performers:COUNTS"),
        "spoil": VerbRow(performer="lumen_blinker.performers:SPOILS"),
        "vanish": VerbRow(performer="lumen_blinker.missing"),
    },
)
