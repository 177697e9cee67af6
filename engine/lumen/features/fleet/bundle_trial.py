"""Trials of a bundle: a robot predicts the bundle's effects on it without switching to it."""

import re
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.errors import UsageError
from lumen.feature import table
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.rollouts.presence import DIFFER, MAX_TEXT, REFUSED, SAME
from lumen.project.files import belongs
from lumen.project.project_folders import MAIN_FILE

HOUSE_KEYS = (
    "house", "robot", "robots", "hall", "stage", "units", "bus", "aliases", "timezone", "modules",
)  # fmt: skip
"""The core's keys of lumen.yaml that describe a house and its robots: bundles never change them."""

_BLOCK = re.compile(r"^(?=[^\s#])", re.MULTILINE)
_KEY = re.compile(r"""["']?([\w-]+)["']?\s*:""")


def fitted(bundle: Mapping[str, bytes], here: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return a bundle's files, adapted to a house that runs the files `here`.

    Raises UsageError if one of the lumen.yaml files is unusable (`at_home`).
    """
    return {**as_started(bundle, here), MAIN_FILE: at_home(bundle.get(MAIN_FILE, b""), here.get(MAIN_FILE, b""))}


def as_started(files: Mapping[str, bytes], here: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files with the marks in `here` of options chosen at the start, such as --model."""
    return {**files, **{path: mark for path, mark in here.items() if not belongs(path)}}


def at_home(shared: bytes, own: bytes) -> bytes:
    """Return a bundle's lumen.yaml, `shared`, with the keys about a house from the house's own lumen.yaml, `own`.

    Raises UsageError if either file is not UTF-8, or has anything but keys and comments at the left edge.
    """
    of_house = {*HOUSE_KEYS, *(key.partition(".")[0] for key, row in table("sections").items() if row.of_house)}
    ours = {key: text for key, text in _blocks(own) if key in of_house}
    kept = [text for key, text in _blocks(shared) if key not in of_house]
    ended = [text if text.endswith("\n") else f"{text}\n" for text in (*kept, *ours.values())]
    return "".join(ended).encode()


def _blocks(content: bytes) -> list[tuple[str, str]]:
    """Return each top-level key with its text; comments and the text before the first key have the key ""."""
    try:
        parts = _BLOCK.split(content.decode().replace("\r\n", "\n"))
    except UnicodeDecodeError:
        raise UsageError("lumen.yaml is not UTF-8") from None
    found = []
    for part in filter(None, parts):
        key = _KEY.match(part)
        if key is None and not part.startswith("#") and part.strip():
            raise UsageError(f"lumen.yaml: a key is expected at the left edge, not `{part[:20].strip()}`")
        found.append((key.group(1) if key else "", part))
    return found


class FileTrier(Protocol):
    """Judges files without applying them."""

    @property
    def running(self) -> str:
        """The hash of the running files."""

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        """Return the files with that hash if they have run here, else None."""

    def attempt(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Judge files as if they were applied: lint them, replay the last visits, and plan the change.

        `answer` receives the verdict.
        """


class BundleTrial:
    """One robot's trial; call `tick` with the bundle to try.

    `said` is the result, empty until it is known; `wants` is the bundle's hash while the bundle must be fetched.
    """

    def __init__(self, trier: FileTrier, folder: BundleFolder, tell: Callable[[str], None]) -> None:
        self._trier, self._folder, self._tell = trier, folder, tell
        self._about, self._asked = "", False
        self.wants = ""
        self.said: dict[str, Any] = {}

    def tick(self, bundle: str, running: str) -> None:
        """Continue the trial of `bundle`, empty for none; `running` is the hash of the running bundle."""
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
    """Return the reason for a refusal: the position and code of lint's first error, else the verdict's reason.

    Lint's messages are left out, because recorded visits may contain people's names.
    """
    found = [row for row in verdict.get("diagnostics", ()) if row.get("severity") == "error"]
    if found:
        row = found[0]
        return f"{row.get('file')}:{row.get('line')}: {row.get('code')}"
    return str(verdict.get("reason") or verdict["verdict"])
