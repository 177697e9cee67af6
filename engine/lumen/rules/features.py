"""Features that were installed beside Lumen and can't be used."""

from lumen.feature import FeatureFault, distribution_of, found, resolve, rows
from lumen.interpreters.added_verbs import faulty_verbs
from lumen.language.diagnostics import Diagnostic
from lumen.loading.broken_features import broken
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


def broken_features() -> list[Diagnostic]:
    """Return a finding for each installed distribution whose feature, or a row of it, is ignored."""
    verbs = ((distribution_of(feature), fault) for feature, fault in faulty_verbs())
    faults = [*found().faults, *(FeatureFault(distribution, fault) for distribution, fault in verbs if distribution)]
    return [broken(fault.distribution, fault.message) for fault in faults]
