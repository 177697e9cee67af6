"""Features of other installed packages that can't be used."""

from collections.abc import Iterator

from lumen.feature import Feature, distribution_of, found, resolve, rows
from lumen.lint.codes import repeated_codes
from lumen.project.broken_features import broken, broken_features, faults_reported
from lumen.project.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report each installed package that has an ignored feature, or a feature with an ignored row."""
    draft.loose += broken_features()
    for feature, where in _imported():
        if distribution_of(feature):
            with faults_reported(feature, f"its module `{where}`", draft.loose.append):
                resolve(where)
    if found().installed:
        draft.loose += (broken(*fault) for fault in repeated_codes())


def _imported() -> Iterator[tuple[Feature, str]]:
    """Yield the import strings of features that the rest of lint does not import."""
    yield from rows("codes")
    yield from rows("forgets")
    yield from ((feature, row.make) for feature, row in rows("parts"))
