"""Count how often each bundle was started and did not last, so that the next start notices a crash loop."""

from lumen.project.home import Home

CRASH_COUNTS_FILE = "trials.json"
CRASH_COUNTS_VERSION = 1
MAX_CRASHES = 2
"""The number of crashes of a bundle during its probation after which a start uses another bundle."""
MAX_KNOWN_BUNDLES = 20
"""The number of bundles whose counts are kept: the latest."""


class CrashCounter:
    """Counts for each bundle, in a file of the home, how often it crashed before its probation was over.

    The count is written before the bundle becomes active, because a crashing process can no longer write. If the file
    can't be read, all counts are 0; if it can't be written, they stay as they were.
    """

    def __init__(self, home: Home) -> None:
        self._home = home

    def begin(self, hash: str) -> None:
        """Count one more trial of this bundle, which begins now."""
        counts = self._counts()
        counts[hash] = counts.pop(hash, 0) + 1
        self._write(counts)

    def acquit(self, hash: str) -> None:
        """Forget the trials of this bundle: it has lasted."""
        counts = self._counts()
        if counts.pop(hash, 0):
            self._write(counts)

    def annul(self, hash: str) -> None:
        """Take back the last trial of this bundle, which ended for a reason outside the bundle."""
        counts = self._counts()
        if left := counts.pop(hash, 0):
            self._write({**counts, hash: left - 1} if left > 1 else counts)

    def count(self, hash: str) -> int:
        """Return the number of trials of this bundle that began and were neither acquitted nor annulled."""
        return self._counts().get(hash, 0)

    def _counts(self) -> dict[str, int]:
        try:
            data = self._home.read_json(CRASH_COUNTS_FILE)
            if data["version"] != CRASH_COUNTS_VERSION:
                return {}
            return {str(hash): int(count) for hash, count in data["bundles"].items()}
        except (ValueError, TypeError, KeyError, AttributeError, OverflowError):
            return {}

    def _write(self, counts: dict[str, int]) -> None:
        latest = dict(list(counts.items())[-MAX_KNOWN_BUNDLES:])
        self._home.write_json(CRASH_COUNTS_FILE, {"version": CRASH_COUNTS_VERSION, "bundles": latest})
