"""All codes of findings, collected from the modules that declare them next to their checks.

`grep -rn '"cut-short"' engine` finds a code's severity, summary and check; `pages/cut-short.md` explains it.
"""

from collections.abc import Collection, Iterator, Mapping
from functools import cache
from itertools import chain

from lumen.feature import Feature, FeatureFault, distribution_of, resolve, rows
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

    Of two codes with the same name, Lumen's own counts, else the first declared.
    """
    return {code: code for code in sorted((code for _, code in _first_declared().values()), key=_order)}


def repeated_codes() -> Collection[FeatureFault]:
    """Return a fault for each code of an installed package that is ignored because of an earlier one of its name."""
    declared = ((distribution_of(feature), code, *_first_declared()[code]) for feature, code in _declared())
    return dict.fromkeys(
        FeatureFault(distribution, f"its code `{code}` is ignored: the feature `{owner.name}` has that name")
        for distribution, code, owner, first in declared
        if distribution and first is not code
    )


@cache
def families() -> Mapping[str, Mapping[str, Code]]:
    """Return the codes of each family."""
    names = dict.fromkeys((*FAMILY_ORDER, *(code.family for code in codes().values())))
    return {family: {code: code for code in codes().values() if code.family == family} for family in names}


@cache
def _first_declared() -> Mapping[str, tuple[Feature, Code]]:
    """Return the code that counts of each name, and its feature."""
    declared: dict[str, tuple[Feature, Code]] = {}
    for feature, code in _declared():
        declared.setdefault(code, (feature, code))
    return declared


def _declared() -> Iterator[tuple[Feature, Code]]:
    """Yield the codes with their features, Lumen's own first."""
    of_sections = ((feature, where) for feature, (_, where) in rows("section_rules"))
    modules = chain(rows("rules"), of_sections, rows("last_rules"), rows("codes"))
    for feature, where in sorted(modules, key=lambda row: distribution_of(row[0]) is not None):
        found: Mapping[str, object] = {}
        with faults_reported(feature, where, lambda _: None):  # lint reports such a fault
            found = vars(resolve(where.partition(":")[0]))
        yield from ((feature, value) for value in found.values() if isinstance(value, Code) and _is_sound(value))


def _is_sound(code: Code) -> bool:
    return isinstance(code.family, str) and isinstance(code.severity, Severity) and isinstance(code.summary, str)


def _order(code: Code) -> tuple[int, str, str]:
    known = code.family in FAMILY_ORDER
    return FAMILY_ORDER.index(code.family) if known else len(FAMILY_ORDER), code.family, code
