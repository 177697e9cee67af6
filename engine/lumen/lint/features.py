"""Features that were installed beside Lumen and can't be used."""

from collections.abc import Iterator

from lumen.feature import Feature, distribution_of, resolve, rows
from lumen.project.broken_features import broken_features, faults_reported
from lumen.project.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report each distribution whose feature, or a row of it, is ignored."""
    draft.loose += broken_features()
    for feature, where in _imported():
        if distribution_of(feature):
            with faults_reported(feature, f"its module `{where}`", draft.loose):
                resolve(where)


def _imported() -> Iterator[tuple[Feature, str]]:
    """Iterate over the import strings that nothing else of lint imports."""
    yield from rows("codes")
    yield from rows("forgets")
    yield from ((feature, row.make) for feature, row in rows("parts"))
