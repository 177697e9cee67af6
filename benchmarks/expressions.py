"""Measure the cost of evaluations: guards, an assignment's value and a text; medians of several runs [µs of CPU time].

    python benchmarks/expressions.py

For comparison, the same is measured as a Python function on the same data and, if Google's `cel-expr-python` is
installed, by its evaluation.
"""

import platform
import re
from collections.abc import Callable
from typing import Any

from fuzzy import processor
from timing import rate

from lumen.expressions import Scope, compile_expression, compile_guard, compile_template

SCOPE = Scope(
    context={"asked": 1, "visitor": "Ada", "list": [1, 2, 3]},
    event={"name": "heard", "data": {"result": "Can you dance for me, please?", "x": 120.0}},
    state={"path": "talk.ask", "language": "en"},
    configuration=frozenset({"talk", "talk.ask"}).__contains__,
    phrases={"dance": {"en": ("dance", "can you dance"), "id": ("menari", "joget")}},
)
DANCE = re.compile(r"(?i)\b(dance|sing)\b")
GUARDS: dict[str, Callable[[Scope], Any] | None] = {
    "context.asked < 3": lambda s: s[0]["asked"] < 3,
    "context.asked < 3 && event.data.x > 100": lambda s: s[0]["asked"] < 3 and s[1]["data"]["x"] > 100,
    "has(event.data.x) && event.data.x > 100": lambda s: "x" in s[1]["data"] and s[1]["data"]["x"] > 100,
    "context.visitor == 'Ada'": lambda s: s[0]["visitor"] == "Ada",
    "In('talk')": lambda s: s[3]("talk"),
    "heard(event.data.result, 'dance')": None,
    r"event.data.result.matches(r'(?i)\b(dance|sing)\b')": lambda s: DANCE.search(s[1]["data"]["result"]) is not None,
}
VALUES: dict[str, Callable[[Scope], Any]] = {
    "context.asked + 1": lambda s: s[0]["asked"] + 1,
    "{'x': event.data.x, 'list': context.list + [4]}": lambda s: {"x": s[1]["data"]["x"], "list": [*s[0]["list"], 4]},
}
TEXT = "Hello {{ context.visitor }}, you asked {{ context.asked }} times."


def cost(function: Callable[[Scope], Any]) -> float:
    """Return the time of one call [µs]."""

    def work(count: int) -> int:
        for _ in range(count):
            function(SCOPE)
        return count

    return 1e6 / rate(work)


def cel_costs() -> Callable[[str], str]:
    """Return a function from an expression to its cost in CEL as text; empty if CEL can't evaluate it or is missing."""
    try:
        from cel_expr_python import cel
    except ImportError:
        return lambda source: ""
    environment = cel.NewEnv(variables=dict.fromkeys(("context", "event", "state"), cel.Type.DYN))
    data = {"context": SCOPE.context, "event": SCOPE.event, "state": SCOPE.state}

    def measure(source: str) -> str:
        try:
            program = environment.compile(source, disable_check=True)
        except RuntimeError:
            return ""
        if program.eval(data=data).type().name() == "ERROR":
            return ""
        return f"{cost(lambda _: program.eval(data=data)):10.2f}"

    return measure


def main() -> None:
    in_cel = cel_costs()
    print(f"Python {platform.python_version()}, {platform.machine()}, {processor()}; µs of CPU time, an empty loop off")
    print(f"{'':66}{'Lumen':>8}{'Python':>8}{'CEL':>10}")
    empty = cost(lambda _: None)
    for source, python in GUARDS.items():
        by_hand = f"{cost(python) - empty:8.2f}" if python else f"{'':8}"
        print(f"{source:66}{cost(compile_guard(source)) - empty:8.2f}{by_hand}{in_cel(source)}")
    for source, python in VALUES.items():
        print(f"{source:66}{cost(compile_expression(source)) - empty:8.2f}{cost(python) - empty:8.2f}{in_cel(source)}")
    print(f"{TEXT:66}{cost(compile_template(TEXT)) - empty:8.2f}")


if __name__ == "__main__":
    main()
