"""The environment of the tests is not the user's, except for what downloads."""

import json
import os
import sys

from tests.guarded import run_guarded
from tests.waiting import HANG

SETTLED = """
import json, os
from tests.environment import downloading, settle
settle()
settle()  # as in a worker, which inherits the environment
print(json.dumps([dict(os.environ), downloading()]))
"""


def test_settings_of_git_and_proxies_are_left_out() -> None:
    theirs = {"GIT_DIR": "/nowhere", "GIT_AUTHOR_NAME": "x", "https_proxy": "http://one", "ALL_PROXY": "http://two"}
    environment = {**os.environ, **theirs}
    del environment["LUMEN_TEST_PROXIES"]
    done = run_guarded(
        [sys.executable, "-c", SETTLED], env=environment, capture_output=True, text=True, timeout=HANG, check=True
    )
    ours, downloads = json.loads(done.stdout)
    assert theirs.keys() & ours.keys() == set()
    assert (ours["GIT_CONFIG_GLOBAL"], ours["GIT_CONFIG_NOSYSTEM"]) == ("/dev/null", "1")
    assert {name: downloads.get(name) for name in ("https_proxy", "ALL_PROXY")} == {
        "https_proxy": "http://one",
        "ALL_PROXY": "http://two",
    }
    assert "GIT_DIR" not in downloads
