"""Measure the cost of regular expressions, in Lumen and in the engines that it could use, in µs of CPU time.

    python benchmarks/patterns.py [--rounds N]

For each pattern, it measures reading the pattern, searching a visitor's sentence, and searching 1,000 characters that
are difficult for this pattern. Figures are medians of several rounds, in which the engines take turns. `google-re2`
is measured if it is installed. Python's `re` tries one alternative after the other: searches for which it needs more
than a second are left out.
"""

import argparse
import platform
import re
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from random import Random
from statistics import geometric_mean, median
from time import process_time

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzzy import processor
from tests.guarded import DEVNULL, PIPE, TimeoutExpired, run_guarded

from lumen.expressions.patterns import compile_pattern

Search = Callable[[str], object]
Engines = dict[str, Callable[[str], Search]]

SENTENCE = "Could you dance for me, please? My name is Ada, and I would love to see it."
LETTERS = "".join(Random(2015).choices("ab", k=1_000))
PATTERNS: list[tuple[str, str]] = [
    ("dance", "a" * 1_000),
    (r"(?i)\b(hello|hi|good (morning|evening))\b", "hello" * 200),
    (r"^my name is (\w+)$", "my name is " + "a" * 988 + "!"),
    (r"[a-z]+@[a-z]+\.(com|org)", "a" * 1_000),
    (r"\w+\s\w+$", "a" * 999 + " "),
    (r"(a|aa)*b", "a" * 1_000),
    ("a?" * 20 + "a" * 20 + "[^ab]", LETTERS),
    (".*.*.*.*.*x", "a" * 1_000),
    ("(a|b)*a(a|b){12}c", LETTERS),
    (r"\w{1,60}x", "a" * 1_000),
    ("(a+)+$", "a" * 999 + "!"),
]
"""Patterns, each with a text that is hard for it."""

MAX_SECONDS = 1.0
"""The greatest duration of a search that is still measured [s of CPU]."""


def by_lumen(pattern: str) -> Search:
    """Compile a pattern with Lumen, without its cache."""
    getattr(compile_pattern, "cache_clear", lambda: None)()
    return compile_pattern(pattern).search


def by_re(pattern: str) -> Search:
    """Compile a pattern with Python's `re`, without its cache."""
    re.purge()
    return re.compile(pattern).search


def by_jsonschema_rs(pattern: str) -> Search:
    """Compile a pattern with jsonschema-rs."""
    from jsonschema_rs import Draft202012Validator, RegexOptions

    return Draft202012Validator({"pattern": pattern}, pattern_options=RegexOptions()).is_valid


def by_re2(pattern: str) -> Search:
    """Compile a pattern with google-re2, without its cache."""
    import re2

    re2.purge()
    return re2.compile(pattern).search  # type: ignore[no-any-return]


ENGINES: dict[str, tuple[Callable[[str], Search], str]] = {
    "Lumen": (by_lumen, "from lumen.expressions.patterns import compile_pattern"),
    "jsonschema-rs": (by_jsonschema_rs, "import jsonschema_rs"),
    "google-re2": (by_re2, "import re2"),
    "re": (by_re, "import re"),
}
"""The function that compiles a pattern, and the import that it needs."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    engines = {name: make for name, (make, needs) in ENGINES.items() if importable(needs)}
    print(f"Python {platform.python_version()}, {platform.machine()}, {processor()}")
    needs = {name: ENGINES[name][1] for name in engines}
    print(f"\nimporting it, ms of CPU beyond Python itself: {imports(needs, rounds)}")
    print(f"\nµs of CPU, median of {rounds}: reading a pattern, a sentence, 1,000 hard characters")
    print(" " * 32 + "".join(f"{name:>28}" for name in engines))
    ratios: dict[str, list[float]] = {name: [] for name in engines}
    for pattern, hard in PATTERNS:
        taken = [measured(step, rounds) for step in steps(engines, pattern, hard)]
        shown = pattern if len(pattern) < 32 else f"{pattern[:30]}…"
        print(f"{shown:32}" + "".join(f"{''.join(cell(step, name) for step in taken):>28}" for name in engines))
        for step in taken[1:]:
            for name in ratios.keys() & step.keys():
                ratios[name].append(step[name] / step["Lumen"])
    print("\nsearching takes Lumen's time so many times, geometric mean of what was measured:")
    print(
        "  " + ", ".join(f"{name} {geometric_mean(found):.2f} x" for name, found in ratios.items() if name != "Lumen")
    )
    return 0


def steps(engines: Engines, pattern: str, hard: str) -> list[dict[str, Callable[[], object]]]:
    """Return the steps of each engine that can do them: compiling, searching the sentence, searching the hard text."""
    able = {name: make(pattern) for name, make in engines.items()}
    return [
        {name: partial(make, pattern) for name, make in engines.items()},
        {name: partial(search, SENTENCE) for name, search in able.items()},
        {name: partial(search, hard) for name, search in able.items() if name != "re" or not hopeless(pattern, hard)},
    ]


def cell(taken: dict[str, float], name: str) -> str:
    """Return a time as a cell of the table."""
    return f"{1e6 * taken[name]:9.1f}" if name in taken else f"{'> 1 s':>9}"


def measured(work: Mapping[str, Callable[[], object]], rounds: int) -> dict[str, float]:
    """Return the median time of a call [s of CPU]; the calls take turns, about 5 ms at a time."""
    counts = {name: max(1, int(0.005 / max(timed(todo, 1), 1e-7))) for name, todo in work.items()}
    taken: dict[str, list[float]] = {name: [] for name in work}
    for _ in range(rounds):
        for name, todo in work.items():
            taken[name].append(timed(todo, counts[name]) / counts[name])
    return {name: median(times) for name, times in taken.items()}


def timed(todo: Callable[[], object], count: int) -> float:
    """Return the processor time of `count` calls [s]."""
    began = process_time()
    for _ in range(count):
        todo()
    return process_time() - began


def hopeless(pattern: str, text: str) -> bool:
    """Return True if `re` needs longer than a second; it runs in a process that can be ended."""
    code = f"import re; re.search({pattern!r}, {text!r})"
    try:
        run_guarded([sys.executable, "-c", code], timeout=MAX_SECONDS + 1, check=True)
    except TimeoutExpired:
        return True
    return False


def importable(statement: str) -> bool:
    """Return True if the import statement works in a new process."""
    return run_guarded([sys.executable, "-c", statement], stdout=DEVNULL, stderr=DEVNULL).returncode == 0


def imports(statements: dict[str, str], rounds: int) -> str:
    """Return the time of each import beyond Python itself [ms of CPU], as text."""
    report = "; import resource; used = resource.getrusage(resource.RUSAGE_SELF); print(used.ru_utime + used.ru_stime)"
    taken: dict[str, list[float]] = {name: [] for name in ["", *statements]}
    for _ in range(rounds):
        for name, times in taken.items():
            code = statements.get(name, "import sys") + report
            said = run_guarded([sys.executable, "-c", code], stdout=PIPE, text=True, check=True).stdout
            times.append(float(said))
    bare = median(taken.pop(""))
    return ", ".join(f"{name} {1e3 * (median(times) - bare):.1f}" for name, times in taken.items())


if __name__ == "__main__":
    sys.exit(main())
