"""Features that were installed beside Lumen and can't be used."""

from lumen.loading.broken_features import broken_features
from lumen.loading.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report each distribution whose feature, or a row of it, is ignored."""
    draft.loose += broken_features()
