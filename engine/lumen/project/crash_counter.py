"""Which bundles were begun with and have not lasted: a crash loop is noticed by the start that comes after it."""

from lumen.project.home import Home

CRASH_COUNTS_FILE = "trials.json"
CRASH_COUNTS_VERSION = 1
MAX_CRASHES = 2
"""How often a bundle may end the exhibition within its probation before a start does something else."""
MAX_KNOWN_BUNDLES = 20
"""How many bundles are remembered, the latest."""


class CrashCounter:
    """Counts in a home how often each bundle became active and ended the exhibition before it had stood its probation.

    A count is written before the bundle is active, for who crashes writes nothing.
    """

    def __init__(self, home: Home) -> None:
        self._home = home

    def begin(self, hash: str) -> None:
        """From now on this bundle is on trial."""
        counts = self._counts()
        counts[hash] = counts.pop(hash, 0) + 1
        self._write(counts)

    def acquit(self, hash: str) -> None:
        """This bundle has lasted."""
        counts = self._counts()
        if counts.pop(hash, 0):
            self._write(counts)

    def annul(self, hash: str) -> None:
        """The last trial of this bundle ended for nothing that it could help."""
        counts = self._counts()
        if left := counts.pop(hash, 0):
            self._write({**counts, hash: left - 1} if left > 1 else counts)

    def count(self, hash: str) -> int:
        """How often it did not last."""
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
