"""How a run went, in the form of `lumen run --format json`."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from lumen.run.node import Node

WELL, FAILED, TROUBLED, EARLY, INTERRUPTED = "well", "failed", "troubled", "early", "interrupted"
MAX_TROUBLES = 5
"""The number of troubles that the summary of a run lists."""


class RunVerdict(NamedTuple):
    """How a run went.

    A run with troubles (`troubles_of`) is `troubled`, and `failure` is the first of them, unless its story failed.
    """

    ended: str
    """`well`, `failed`, `troubled`, `early` (before the end of its story) or `interrupted`."""
    lived: float
    """The time in the exhibition [s]."""
    took: float | None = None
    """The time that the run took [s]; None for a single robot whose parts run in several processes."""
    failure: str = ""
    """Why the story failed, else the first trouble; empty if there is neither."""
    summary: tuple[str, ...] = ()
    """The lines of the summary."""
    film: str = ""
    """The path of the film; empty if none was made."""

    @property
    def code(self) -> int:
        """The exit code: 1 for a failed, troubled or early end, else 0."""
        return int(self.ended in (FAILED, TROUBLED, EARLY))

    @staticmethod
    def listed(troubles: Sequence[str]) -> list[str]:
        """Return the troubles as lines of a summary."""
        more = len(troubles) - MAX_TROUBLES
        return [*troubles[:MAX_TROUBLES], *([f"… and {more} more"] if more > 0 else [])]

    def to_json(self, project: str, story: str | None) -> dict[str, Any]:
        """Return the object of `--format json`; times in [s], rounded to milliseconds."""
        took = None if self.took is None else round(self.took, 3)
        return {
            "ended": self.ended,
            "project": project,
            "story": story,
            "time": round(self.lived, 3),
            "took": took,
            "failure": self.failure or None,
            "summary": list(self.summary),
            "film": self.film or None,
        }


def troubles_of(node: Node, *, judged: bool) -> list[str]:
    """Return the troubles of a process at its end, after it was closed.

    A story has judged the troubles of the behaviour, and fails for each unexpected one; the faults of packages remain.
    """
    return [*([] if judged else node.troubles), *node.faults]
