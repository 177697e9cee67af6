"""The verdict of a run, and its form in `lumen run --format json`."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from lumen.run.node import Node
from lumen.run.parts.visitor import VisitorPart
from lumen.run.services import Services

WELL, FAILED, TROUBLED, EARLY, INTERRUPTED = "well", "failed", "troubled", "early", "interrupted"
ENDED = "Ended"
_WORDS = {
    FAILED: "The story failed",
    EARLY: "Ended before the story was over",
    TROUBLED: "Ended with trouble",
    WELL: ENDED,
}
MAX_TROUBLES = 5
"""The maximum number of troubles that the summary of a run lists."""


class RunVerdict(NamedTuple):
    """The verdict of a run.

    A run with troubles (see `troubles_of`) is `troubled` unless its story failed, and `failure` is the first trouble.
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
        """Return the troubles as lines of a summary: the first MAX_TROUBLES, and the number of the rest."""
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


class RunEnd(NamedTuple):
    """The end of a run, for its verdict."""

    ended: str
    """One of the values of `RunVerdict.ended`."""
    words: str
    """The end in words, for the summary's first line."""
    failure: str
    """Why the story failed, else the first trouble; empty if there is neither."""


def end_of(robots: Sequence[Services], troubles: Sequence[str]) -> RunEnd:
    """Return how a run of these robots, or of parts of them, ended.

    A failed story comes first, then an interruption, then a story that was not over, then the troubles.
    """
    players = [visitor.player for each in robots if (visitor := each.get(VisitorPart))]
    failure = next((player.failure for player in players if player and player.failure), "")
    early = any(each.node.failed for each in robots)
    ended = FAILED if failure else EARLY if early else TROUBLED if troubles else WELL
    words, first = _WORDS[ended], failure or next(iter(troubles), "")
    interrupted = not failure and any(each.node.interrupted for each in robots)
    return RunEnd(INTERRUPTED if interrupted else ended, words, first)


def troubles_of(node: Node, *, judged: bool) -> list[str]:
    """Return the troubles of a process after it was closed.

    If a story was played (`judged`), these are only the faults of installed packages, because the story itself fails if
    the behaviour has an unexpected trouble.
    """
    return [*([] if judged else node.troubles), *node.faults]
