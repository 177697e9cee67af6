"""`lumen doctor --robot reachy`: checks the robot's daemon, and that no other program uses the robot."""

from collections.abc import Iterator, Mapping

from lumen.errors import RobotError
from lumen.extras import MissingExtraError, demand
from lumen.features.reachy.daemon_api import DaemonAddress, DaemonApi
from lumen.features.reachy.set_up import ADDRESS
from lumen.features.reachy.taking_over import TESTED

DoctorFinding = tuple[str, str, str]
"""The name of the check, a severity, and a text."""


def examine(options: Mapping[str, str]) -> Iterator[DoctorFinding]:
    """Yield the findings about the daemon at the address in the option `url`.

    Raises UsageError if that is not a valid address.
    """
    try:
        demand("reachy", "a Reachy Mini", "websockets")
    except MissingExtraError as error:
        yield "packages", "error", str(error)
    api = DaemonApi(DaemonAddress(options.get("url", ADDRESS)))
    try:
        status = api.request("GET", "/api/daemon/status")
        if not isinstance(status, dict) or "version" not in status:
            yield "daemon", "error", f"what answers at {api.address} is no daemon of a Reachy Mini"
            return
        yield from _daemon(api, status)
        yield from _others(api)
        yield from _media(api)
    except RobotError as error:
        hint = "is the robot on, and in this network? Its address is on its dashboard"
        yield "daemon", "error", f"{error}: {hint}"


def _daemon(api: DaemonApi, status: Mapping[str, object]) -> Iterator[DoctorFinding]:
    version, tested = str(status["version"]), ".".join(map(str, TESTED))
    kind = "Wireless" if status.get("wireless_version") else "Lite"
    if status.get("simulation_enabled") or status.get("mockup_sim_enabled"):
        kind = "a simulation"
    yield "daemon", "ok", f"`{status.get('robot_name')}` ({kind}) at {api.address}, version {version}"
    if version.split(".")[:2] != tested.split("."):
        yield "version", "warning", f"Lumen was tested with {tested} of the daemon, not with {version}"
    state = str(status.get("state"))
    if state == "running":
        yield "robot", "ok", "the daemon has started the robot"
    elif state in ("stopped", "not_initialized"):
        yield "robot", "note", f"the daemon is `{state}`: Lumen starts the robot"
    else:
        yield "robot", "error", f"the daemon is `{state}`: {status.get('error') or 'look at its log'}"


def _others(api: DaemonApi) -> Iterator[DoctorFinding]:
    lock = api.request("GET", "/api/daemon/robot-app-lock-status")
    running = api.request("GET", "/api/move/running")
    if lock.get("state") != "free":
        name = lock.get("holder_name") or lock.get("state")
        yield "other apps", "warning", f"`{name}` has the robot: stop it on the dashboard, else both move it"
    elif running:
        yield "other apps", "warning", "the daemon plays a move: another program moves the robot"
    else:
        yield "other apps", "ok", "no other app has the robot"
    telemetry = api.request("GET", "/api/telemetry")
    if telemetry.get("enabled") and not telemetry.get("disabled_by_env"):
        yield (
            "telemetry",
            "note",
            "the daemon sends usage data to its maker: DO_NOT_TRACK=1 in its environment ends that",
        )


def _media(api: DaemonApi) -> Iterator[DoctorFinding]:
    if api.request("GET", "/api/media/status").get("available"):
        yield "loudspeaker", "ok", "the daemon plays sounds"
    else:
        yield "loudspeaker", "warning", "the daemon runs without its media server: the robot does not speak"
