"""The functions of expressions."""

from lumen.feature import Feature, FunctionRow

_FUNCTIONS = "lumen.expressions.functions"
_LISTS = "lumen.expressions.lists"

FEATURE = Feature(
    name="expressions",
    functions={
        "size": FunctionRow(f"{_FUNCTIONS}:size", ("text|list|map",), "number", example="text", exact=True),
        "has": FunctionRow("lumen.expressions.operators:has", ("any",), "boolean", example="event.data.x", exact=True),
        "lower": FunctionRow(f"{_FUNCTIONS}:lower", ("text",), "text", example="text", exact=True),
        "trim": FunctionRow(f"{_FUNCTIONS}:trim", ("text",), "text", example="text", exact=True),
        "contains": FunctionRow(
            f"{_FUNCTIONS}:contains", ("text", "text"), "boolean", example="text, 'part'", exact=True
        ),
        "replace": FunctionRow(
            f"{_FUNCTIONS}:replace", ("text", "text", "text"), "text", example="text, 'old', 'new'", exact=True
        ),
        "after": FunctionRow(f"{_FUNCTIONS}:after", ("text", "text"), "text", example="text, 'phrase'", exact=True),
        "matches": FunctionRow(
            f"{_FUNCTIONS}:matches", ("text", "text"), "boolean", example="text, 'pattern'", exact=True
        ),
        "words": FunctionRow(f"{_FUNCTIONS}:words", ("text",), "list", example="text", exact=True),
        "now": FunctionRow(f"{_FUNCTIONS}:now", (), "text", scoped=True, clock=True, exact=True),
        "hour": FunctionRow(f"{_FUNCTIONS}:hour", (), "number", scoped=True, clock=True, exact=True),
        "minute": FunctionRow(f"{_FUNCTIONS}:minute", (), "number", scoped=True, clock=True, exact=True),
        "weekday": FunctionRow(f"{_FUNCTIONS}:weekday", (), "text", scoped=True, clock=True, exact=True),
        "date": FunctionRow(f"{_FUNCTIONS}:today", (), "text", scoped=True, clock=True, exact=True),
        "heard": FunctionRow(
            f"{_FUNCTIONS}:heard",
            ("text", "text|list|map"),
            "boolean",
            example="event.data.result, 'name'",
            scoped=True,
            exact=True,
        ),
        "lookup": FunctionRow(
            f"{_FUNCTIONS}:lookup",
            ("text", "text"),
            "any",
            example="event.data.result, 'table'",
            scoped=True,
            exact=True,
        ),
        "In": FunctionRow(f"{_FUNCTIONS}:active", ("text",), "boolean", example="'state'", scoped=True, exact=True),
        "take": FunctionRow(f"{_LISTS}:take", ("list", "number"), "list", example="list, 3", exact=True),
        "drop": FunctionRow(f"{_LISTS}:drop", ("list", "number"), "list", example="list, 1", exact=True),
        "shuffle": FunctionRow(
            f"{_LISTS}:shuffle", ("list",), "list", example="list", scoped=True, draws=True, exact=True
        ),
        "pick": FunctionRow(
            f"{_LISTS}:pick", ("text|list",), "any", example="list", scoped=True, draws=True, exact=True
        ),
        "in_language": FunctionRow(f"{_LISTS}:in_language", ("any",), "any", example="value", scoped=True, exact=True),
    },
)
