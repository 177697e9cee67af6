"""Formats of the verdict of `lumen test`, for people and for programs: each is a function from a verdict to text."""

from lumen.feature import owner, table
from lumen.project.broken_features import called_for_text
from lumen.run.verdict import Verdict


def verdict_formats() -> tuple[str, ...]:
    """Return the names of all formats."""
    return tuple(table("verdict_formats"))


def render(format: str, verdict: Verdict) -> str:
    """Return the verdict in this format.

    Raises LumenError with the name of the package if the format belongs to another package and is faulty.
    """
    return called_for_text(owner("verdict_formats", format), table("verdict_formats")[format], verdict)
