"""The first requests to Reachy Mini's daemon, before each connection."""

import logging
import re
import time
from typing import Any

from lumen.errors import RobotLostError, RobotModelError, RobotUnreachableError
from lumen.features.reachy.daemon_api import DaemonApi
from lumen.features.reachy.rods import stands_on_rods
from lumen.language.robots import Body

TESTED = (1, 13)
"""The major and minor version of the daemon that Lumen was tested with."""
START_PATIENCE, LOOK_PERIOD = 20.0, 0.2
"""The time limit for the robot's start, and the period in which Lumen checks it [s]."""

_log = logging.getLogger(__name__)


def take_over(api: DaemonApi, body: Body) -> None:
    """Check that `body` is a Reachy Mini, and start the robot if the daemon has not.

    An untested version is logged. Raises RobotError if `body` is another robot, or if the daemon does not answer or
    can't start the robot.
    """
    if not stands_on_rods(body):
        raise RobotModelError(f"{body.name} is no Reachy Mini: write `model: reachy_mini` under `robot` of lumen.yaml")
    state = _status(api)
    if state["state"] in ("stopped", "not_initialized"):
        api.request("POST", "/api/daemon/start?wake_up=false")
    end = time.monotonic() + START_PATIENCE
    while state["state"] != "running":
        if state["state"] == "error":
            raise RobotLostError(f"the daemon at {api.address} has an error: {state.get('error') or 'it names none'}")
        if time.monotonic() > end:
            raise RobotLostError(f"the daemon at {api.address} is `{state['state']}` and does not get ready")
        time.sleep(LOOK_PERIOD)
        state = _status(api)
    found = re.match(r"(\d+)\.(\d+)", str(state.get("version")))
    if found and (int(found[1]), int(found[2])) != TESTED:
        tested = ".".join(map(str, TESTED))
        _log.warning("the robot's daemon has version %s: Lumen was tested with %s", state["version"], tested)


def _status(api: DaemonApi) -> dict[str, Any]:
    status = api.request("GET", "/api/daemon/status")
    if not isinstance(status, dict) or "state" not in status:
        raise RobotUnreachableError(f"what answers at {api.address} is no daemon of a Reachy Mini")
    return status
