"""How a run went, as `lumen run --format json` says it."""

from typing import Any, NamedTuple

WELL, FAILED, EARLY, INTERRUPTED = "well", "failed", "early", "interrupted"


class RunVerdict(NamedTuple):
    """How it `ended`: well, failed, early (before its story did), interrupted; `lived` and `took` in [s]."""

    ended: str
    lived: float
    took: float | None = None
    failure: str = ""
    summary: tuple[str, ...] = ()
    film: str = ""

    @property
    def code(self) -> int:
        return int(self.ended in (FAILED, EARLY))

    def to_json(self, project: str, story: str | None) -> dict[str, Any]:
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
