"""The environment of all tests: what a user has set, or Lumen has left on this machine, changes no result."""

import json
import os

from tests import ROOT
from tests.guarded import temporary_folder

OF_THE_RUN = "LUMEN_TEST_"
"""The beginning of the variables that a run of the tests sets itself."""
SHOWN = ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "LINES")
"""Variables that change what a terminal shows."""
PROXIES = OF_THE_RUN + "PROXIES"
"""The variable that keeps the user's proxies, which only downloads use; workers of xdist inherit it."""
GIT = {
    "GIT_CONFIG_GLOBAL": os.devnull,
    "GIT_CONFIG_NOSYSTEM": "1",
    "GIT_CONFIG_COUNT": "1",  # a repository that another user owns, as in a container
    "GIT_CONFIG_KEY_0": "safe.directory",
    "GIT_CONFIG_VALUE_0": "*",
}
"""git without the settings of a user and of the machine."""


def settle() -> None:
    """Remove a user's settings from this process's environment, and give it Lumen's own folders.

    The cache that one start keeps for the next is shared by all tests of this and later runs. The state folder, in
    which `lumen run` without a project leaves a copy of the shipped exhibition, is empty.
    """
    proxies = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
    os.environ.setdefault(PROXIES, json.dumps(proxies))
    for name in [*os.environ]:
        lumen = name.startswith("LUMEN_") and not name.startswith(OF_THE_RUN)
        if lumen or name.startswith("GIT_") or name in SHOWN or name in proxies:
            del os.environ[name]
    os.environ.update(GIT)
    os.environ["XDG_CACHE_HOME"] = str(ROOT / ".cache/xdg")
    os.environ["XDG_STATE_HOME"] = str(temporary_folder("lumen-state-"))


def downloading() -> dict[str, str]:
    """Return the environment of a program that downloads: with the user's proxies."""
    return {**os.environ, **json.loads(os.environ.get(PROXIES, "{}"))}
