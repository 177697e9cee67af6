"""All codes of findings, collected from the modules that declare them next to their checks.

`grep -rn '"cut-short"' engine` finds a code's severity, summary and check; `pages/cut-short.md` explains it.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import chain

from lumen.feature import resolve, rows
from lumen.language.diagnostics import Code, Severity
from lumen.project.broken_features import faults_reported

FAMILY_ORDER = (
    "text", "shape", "references", "statecharts", "reload", "expressions", "hearing", "speech", "knowledge",
    "controllers", "motions", "physics", "robot", "routes", "alerts", "fleet", "features", "comments",
)  # fmt: skip
"""The order of the families in lists: faults of a file's form first. Families that are not listed are last."""


@cache
def codes() -> Mapping[str, Code]:
    """Return every code by its name, sorted by family and name.

    Of two codes with the same name, the first declared counts.
    """
    declared: dict[str, Code] = {}
    for code in _declared():
        declared.setdefault(code, code)
    return {code: code for code in sorted(declared.values(), key=_order)}


@cache
def families() -> Mapping[str, Mapping[str, Code]]:
    """Return the codes of each family."""
    names = dict.fromkeys((*FAMILY_ORDER, *(code.family for code in codes().values())))
    return {family: {code: code for code in codes().values() if code.family == family} for family in names}


def _declared() -> Iterator[Code]:
    of_sections = ((feature, where) for feature, (_, where) in rows("section_rules"))
    for feature, where in chain(rows("rules"), of_sections, rows("last_rules"), rows("codes")):
        found: Mapping[str, object] = {}
        with faults_reported(feature, where, []):  # lint reports such a fault
            found = vars(resolve(where.partition(":")[0]))
        yield from (value for value in found.values() if isinstance(value, Code) and _is_sound(value))


def _is_sound(code: Code) -> bool:
    return isinstance(code.family, str) and isinstance(code.severity, Severity) and isinstance(code.summary, str)


def _order(code: Code) -> tuple[int, str, str]:
    known = code.family in FAMILY_ORDER
    return FAMILY_ORDER.index(code.family) if known else len(FAMILY_ORDER), code.family, code
