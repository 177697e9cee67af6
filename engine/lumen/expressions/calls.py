"""Checks of a call before it runs: its function, the number of its arguments, and literal names in it."""

from collections.abc import Collection

from lumen.errors import ExpressionError
from lumen.expressions.expression_findings import (
    IMPURE_FUNCTION,
    MISPLACED_DRAW,
    UNKNOWN_ANSWERS,
    UNKNOWN_FUNCTION,
    UNKNOWN_PHRASE,
    UNKNOWN_STATE,
    UNSAFE_PATTERN,
    WRONG_ARGUMENT_COUNT,
    Declarations,
    ExpressionFindings,
)
from lumen.expressions.function_table import (
    Function,
    all_functions,
    drawing_functions,
    example_of,
    fault_of,
    functions,
)
from lumen.expressions.own_functions import OwnFunction
from lumen.expressions.patterns import compile_pattern
from lumen.expressions.tree import ExpressionNode, FunctionCall, Literal, walk
from lumen.language.diagnostics import Code, did_you_mean, mean, nearest

_INSTEAD = {
    "len": "size", "length": "size", "count": "size", "lowerAscii": "lower", "toLower": "lower", "strip": "trim",
    "includes": "contains", "in": "In", "regex": "matches", "split": "words", "startsWith": "matches",
    "endsWith": "matches", "time": "now", "clock": "now", "random": "pick", "choose": "pick",
}  # fmt: skip


def function_of(
    node: FunctionCall, around: Declarations, findings: ExpressionFindings
) -> Function | OwnFunction | None:
    """Return the called function; None if it does not exist, its file is broken, or its code can't be imported.

    Report a function that is unknown or can't be imported, and a wrong number of arguments.
    """
    function: Function | OwnFunction | None = all_functions().get(node.function)
    if function is None and node.function in around.functions:
        function = around.functions[node.function]
        if function is None:  # its broken file is reported elsewhere
            return None
    if function is None:
        similar = _INSTEAD.get(node.function)
        own = around.functions
        hint = did_you_mean(node.function, (*functions(), *own), "there are")
        if similar and not nearest(node.function, own):
            hint = mean(node.function, similar)
        findings.report(UNKNOWN_FUNCTION, node, f"there is no function `{node.function}`", hint, node.named)
        return None
    if fault := fault_of(node.function):
        message = f"the function `{node.function}` can't be imported: {fault}"
        findings.report(UNKNOWN_FUNCTION, node, message, "install the package of this function again", node.named)
        return None
    wanted, given = len(function.parameters), len(node.arguments)
    if wanted != given:
        arguments = f"{wanted or 'no'} argument{'s' * (wanted != 1)}"
        message = f"`{node.function}` takes {arguments}, and {given or 'none'} {'is' if given == 1 else 'are'} given"
        if isinstance(function, OwnFunction):
            example = ", ".join(function.parameters)
        else:
            example = example_of(node.function) or ", ".join(sorted(kinds)[0] for kinds in function.parameters)
        usage = f"write `{node.function}({example})`"
        findings.report(WRONG_ARGUMENT_COUNT, node, message, usage, node.named)
    return function


def check_purity(node: FunctionCall, around: Declarations, findings: ExpressionFindings) -> None:
    """Report a call that a function of the project can't contain, and a drawn value as an argument of such a function.

    The function's expression may use an argument several times, and each time would draw another value.
    """
    function = all_functions().get(node.function)
    if around.pure and function and (function.scoped or node.function in drawing_functions()):
        message = f"`{node.function}` reads something other than the arguments"
        hint = f"add an argument to `args`, and pass `{node.function}({example_of(node.function)})` in each call"
        if node.function in drawing_functions():
            hint = "draw the value in `assign`, and pass the key of the context as an argument"
        findings.report(IMPURE_FUNCTION, node, message, hint, node.named)
    if node.function in around.functions:
        inside = (inner for argument in node.arguments for inner, _ in walk(argument))
        drawn = next((n for n in inside if isinstance(n, FunctionCall) and n.function in drawing_functions()), None)
        if drawn:
            message = f"`{drawn.function}` can't be an argument of `{node.function}`, which may use it more than once"
            hint = "assign the value to a key of `context` first, and pass that key"
            findings.report(MISPLACED_DRAW, drawn, message, hint, drawn.named)


def check_names(node: FunctionCall, around: Declarations, findings: ExpressionFindings) -> None:
    """Check literal names in calls of `heard`, `lookup` and `In`, and the pattern in calls of `matches`."""
    if len(node.arguments) != len(all_functions()[node.function].parameters) or not node.arguments:
        return
    last = node.arguments[-1]
    name = last.value if isinstance(last, Literal) and isinstance(last.value, str) else None
    if node.function == "matches":
        _pattern(last, name, findings)
    elif name is not None:
        names: dict[str, tuple[Code, str, Collection[str] | None]] = {
            "heard": (UNKNOWN_PHRASE, "there are no phrases named", around.phrases),
            "lookup": (UNKNOWN_ANSWERS, "there are no answers named", around.answers),
            "In": (UNKNOWN_STATE, "there is no state", around.states),
        }
        code, message, known = names.get(node.function, (UNKNOWN_STATE, "", None))
        if known is not None and name not in known:
            findings.report(code, last, f"{message} `{name}`", did_you_mean(name, known, "there are"))


def _pattern(node: ExpressionNode, pattern: str | None, findings: ExpressionFindings) -> None:
    if pattern is None:
        hint = "to search for a computed value, use `contains`"
        findings.report(UNSAFE_PATTERN, node, "the pattern of `matches` must be a text in quotes", hint)
        return
    try:
        compile_pattern(pattern)
    except ExpressionError as error:
        findings.report(UNSAFE_PATTERN, node, f"in the pattern, {error.message}", error.hint)
