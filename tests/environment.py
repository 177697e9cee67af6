"""The environment of all tests: what a user has set, or Lumen has left on this machine, changes no result."""

import os

from tests import ROOT
from tests.guarded import temporary_folder

OF_THE_RUN = "LUMEN_TEST_"
"""The beginning of the variables that a run of the tests sets itself."""
SHOWN = ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "LINES")
"""Variables that change what a terminal shows."""


def settle() -> None:
    """Remove a user's settings from this process's environment, and give it Lumen's own folders.

    The cache that one start keeps for the next is shared by all tests of this and later runs. The state folder, in
    which `lumen run` without a project leaves a copy of the shipped exhibition, is empty.
    """
    for name in [*os.environ]:
        if (name.startswith("LUMEN_") and not name.startswith(OF_THE_RUN)) or name in SHOWN:
            del os.environ[name]
    os.environ["XDG_CACHE_HOME"] = str(ROOT / ".cache/xdg")
    os.environ["XDG_STATE_HOME"] = str(temporary_folder("lumen-state-"))
