"""Features that were installed beside Lumen and can't be used."""

from lumen.feature import distribution_of, resolve, rows
from lumen.loading.broken_features import broken, broken_features
from lumen.loading.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report each distribution whose feature, or a row of it, is ignored."""
    draft.loose += broken_features()
    for feature, module in rows("codes"):
        if distribution := distribution_of(feature):
            try:
                resolve(module)
            except Exception as error:  # of code that is not ours
                draft.loose.append(
                    broken(distribution, f"its module `{module}` raised {type(error).__name__}: {error}")
                )
