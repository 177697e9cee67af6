"""The shape of a daemon's answers; `python -m tests.features.reachy.protocol URL` records one that sleeps."""

import json
import sys
import time
from pathlib import Path
from typing import Any

from lumen.errors import RobotFailedError
from lumen.features.reachy.daemon_api import DaemonAddress, DaemonApi
from tests.waiting import until

RECORDED = Path(__file__).with_name("recorded.json")
GOTO = {"head_pose": {"yaw": 0.3}, "duration": 20.0}
TARGET = {"target_head_pose": {"yaw": 0.2}}
UNKNOWN = {"uuid": "00000000-0000-4000-8000-000000000000"}


def observed(url: str) -> dict[str, Any]:
    """Return the answers of a daemon whose robot sleeps, step by step: the shape of each, and some of the values."""
    api, found = DaemonApi(DaemonAddress(url)), dict[str, Any]()

    def note(name: str, method: str, path: str, body: Any = None) -> Any:
        try:
            answer = api.request(method, path, body)
            found[name] = shape(answer)
        except RobotFailedError as error:
            answer, found[name] = None, str(error).partition(": ")[2].split()[0]
        return answer

    note("status", "GET", "/api/daemon/status")
    note("lock", "GET", "/api/daemon/robot-app-lock-status")
    note("telemetry", "GET", "/api/telemetry")
    note("motors", "GET", "/api/motors/status")
    note("full", "GET", "/api/state/full")
    note("sound", "GET", "/api/state/doa")
    note("media", "GET", "/api/media/status")
    found["silent sound"] = note("play", "POST", "/api/media/play_sound", {"file": "none.wav"})
    note("hush", "POST", "/api/media/stop_sound")
    note("unknown path", "GET", "/api/nothing")
    note("nothing runs", "GET", "/api/move/running")
    note("enable", "POST", "/api/motors/set_mode/enabled")

    def woken() -> object:
        note("wake", "POST", "/api/move/play/wake_up")
        return note("wake runs", "GET", "/api/move/running")

    until(woken, what="it is asked while the move runs")
    until(lambda: not api.request("GET", "/api/move/running"), what="it is awake")
    found["awake"] = settled(api)
    found["target"] = note("set target", "POST", "/api/move/set_target", TARGET)
    move = note("goto", "POST", "/api/move/goto", GOTO)
    until(lambda: note("ignored", "POST", "/api/move/set_target", TARGET)["status"] == "ignored", what="the move runs")
    found["ignored"] = api.request("POST", "/api/move/set_target", TARGET)
    note("stop", "POST", "/api/move/stop", move)
    note("stop unknown", "POST", "/api/move/stop", UNKNOWN)
    found["messages"] = messages(api.address)
    note("sleep", "POST", "/api/move/play/goto_sleep")
    until(lambda: not api.request("GET", "/api/move/running"), what="it sleeps")
    found["asleep"] = settled(api)
    return found


def settled(api: DaemonApi) -> dict[str, Any]:
    """Return the robot's pose once it stays the same: on a slow machine a move ends before its last pose is reached."""
    poses: list[dict[str, Any]] = []

    def still() -> bool:
        poses.append(rounded(api.request("GET", "/api/state/full")))
        return poses[-3:] == [poses[-1]] * 3

    until(still, what="the robot stays where it is", every=0.3)
    return poses[-1]


def messages(address: DaemonAddress) -> dict[str, Any]:
    """Return the shapes of the messages about joints on the WebSocket."""
    from websockets.sync.client import connect

    found: dict[str, Any] = {}
    with connect(f"ws://{address.authority}/ws/sdk", compression=None, proxy=None) as opened:
        end = time.monotonic() + 60
        while len(found) < 2 and time.monotonic() < end:
            message = json.loads(opened.recv(timeout=60))
            if message["type"] in ("head_pose", "joint_positions"):
                found[message["type"]] = shape(message)
    return found


def shape(value: Any) -> Any:
    """Return the kinds of the values in JSON data; names of keys and lengths of lists of numbers are kept."""
    match value:
        case dict():
            return {key: shape(each) for key, each in value.items()}
        case list() if value and all(isinstance(each, int | float) for each in value):
            return f"{len(value)} numbers"
        case list():
            return [shape(each) for each in value]
        case bool() | None:
            return value if value is None else "boolean"
        case int() | float():
            return "number"
    return "text"


def rounded(full: dict[str, Any]) -> dict[str, Any]:
    """Return the robot's pose, to a hundredth of a radian and a centimetre, and the mode of its motors."""
    pose = {name: round(value, 2) + 0.0 for name, value in full["head_pose"].items()}
    antennas = [round(angle, 2) for angle in full["antennas_position"]]
    return {"pose": pose, "antennas": antennas, "mode": full["control_mode"]}


if __name__ == "__main__":
    RECORDED.write_text(json.dumps(observed(sys.argv[1]), indent=1, sort_keys=True) + "\n")
