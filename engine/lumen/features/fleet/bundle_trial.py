"""A bundle that a robot tries and does not take: what would become of it here?"""

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.errors import UsageError
from lumen.features.fleet.house_keys import fitted
from lumen.features.fleet.kept_bundles import BundleFolder
from lumen.features.fleet.rollouts.presence import DIFFER, MAX_TEXT, REFUSED, SAME


class FileTrier(Protocol):
    """What says of files what would become of them."""

    @property
    def running(self) -> str:
        """The hash of the files that run."""

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        """The files of that hash, where they ran here."""

    def attempt(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Judge files as if they were taken: lint, the last visits, and the plan; `answer` hears the verdict."""


class BundleTrial:
    """Of one robot: `tick` it with the bundle that is to be tried.

    `said` is what came of it, empty until that is known; `wants` is its hash while it has to be fetched.
    """

    def __init__(self, trier: FileTrier, folder: BundleFolder, tell: Callable[[str], None]) -> None:
        self._trier, self._folder, self._tell = trier, folder, tell
        self._about, self._asked = "", False
        self.wants = ""
        self.said: dict[str, Any] = {}

    def tick(self, bundle: str, running: str) -> None:
        """Go on with it; `running` is the bundle that runs, as the fleet calls it."""
        if bundle != self._about:
            self._about, self._asked, self.said, self.wants = bundle, False, {}, ""
        if not bundle or self._asked:
            return
        if bundle == running:
            self._say(SAME)
            return
        kept = self._folder.files(bundle)
        self.wants = "" if kept else bundle
        if kept:
            self._try(kept, bundle)

    def _try(self, kept: Mapping[str, bytes], bundle: str) -> None:
        self._asked = True
        self._tell(f"bundle {bundle[:12]} is being tried; the robot keeps its present files")
        try:
            files = fitted(kept, self._trier.files(self._trier.running) or {})
        except UsageError as error:
            self._say(REFUSED, why=str(error))
            return
        self._trier.attempt(files, lambda verdict: self._answer(verdict, bundle))

    def _answer(self, verdict: Any, bundle: str) -> None:
        if bundle != self._about or not isinstance(verdict, Mapping):
            return
        visits = verdict.get("visits") or {}
        played, same = int(visits.get("visits", 0)), int(visits.get("same", 0))
        match verdict.get("verdict"):
            case "dry run" | "unchanged":
                self._say(DIFFER if visits.get("differing") else SAME, played, same)
            case "refused":
                self._say(REFUSED, played, same, refusal(verdict))

    def _say(self, verdict: str, played: int = 0, same: int = 0, why: str = "") -> None:
        self._asked = True
        counts = {"played": played, "same": min(same, played)}
        self.said = {"bundle": self._about, "verdict": verdict, **counts, "why": why[:MAX_TEXT]}


def refusal(verdict: Mapping[str, Any]) -> str:
    """Why files were refused: where lint found an error, else the reason. Recorded visits may name people."""
    found = [row for row in verdict.get("diagnostics", ()) if row.get("severity") == "error"]
    if found:
        row = found[0]
        return f"{row.get('file')}:{row.get('line')}: {row.get('code')}"
    return str(verdict.get("reason") or verdict["verdict"])
