"""Trials of a bundle: a robot predicts what it would change here, without switching to it."""

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.errors import UsageError
from lumen.features.fleet.house_keys import fitted
from lumen.features.fleet.kept_bundles import BundleFolder
from lumen.features.fleet.rollouts.presence import DIFFER, MAX_TEXT, REFUSED, SAME


class FileTrier(Protocol):
    """Judges files without applying them."""

    @property
    def running(self) -> str:
        """The hash of the files that run."""

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        """Return the files of that hash if they have run here, else None."""

    def attempt(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Judge files as if they were applied: lint, replay of the last visits, and plan; `answer` receives the
        verdict.
        """


class BundleTrial:
    """The trial of one robot; call `tick` with the bundle to try.

    `said` is the result, empty until it is known; `wants` is the bundle's hash while it must be fetched.
    """

    def __init__(self, trier: FileTrier, folder: BundleFolder, tell: Callable[[str], None]) -> None:
        self._trier, self._folder, self._tell = trier, folder, tell
        self._about, self._asked = "", False
        self.wants = ""
        self.said: dict[str, Any] = {}

    def tick(self, bundle: str, running: str) -> None:
        """Continue the trial; `running` is the fleet's name of the bundle that runs."""
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
    """Return the reason for a refusal: the place and code of lint's first error, else the verdict's reason.

    Messages of lint are left out, since recorded visits may contain people's names.
    """
    found = [row for row in verdict.get("diagnostics", ()) if row.get("severity") == "error"]
    if found:
        row = found[0]
        return f"{row.get('file')}:{row.get('line')}: {row.get('code')}"
    return str(verdict.get("reason") or verdict["verdict"])
