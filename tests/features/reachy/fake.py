"""A fake of the daemon of Reachy Mini: its protocol, without a robot. `recorded.json` has the real daemon's answers.

It speaks HTTP and the WebSocket as `reachy-mini` 1.13.0 does with `--mockup-sim`: targets are reached at once,
moves of the daemon go evenly, and while one runs targets are ignored. It has no physics, no motor and no sound.
"""

import base64
import hashlib
import json
import struct
import threading
import time
import uuid
from collections.abc import Mapping
from contextlib import suppress
from email.message import Message
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from lumen.features.reachy.pose import BODY, HEAD, JOINTS, LEFT, RIGHT, head_joints, rotation

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
PERIOD = 0.02
"""The period in which it sends joints [s]."""
MOVE_DURATION = 0.3
"""The time of its moves [s]: those of the real daemon last 2 to 4."""
INIT = {**dict.fromkeys(JOINTS, 0.0), LEFT: 0.1745, RIGHT: -0.1745}
ASLEEP = {**INIT, "head_x": -0.021, "head_z": -0.044, "head_pitch": 0.4258, LEFT: 3.05, RIGHT: -3.05}


class FakeDaemon:
    """The daemon at `url`; `joints` is the robot's pose, `targets` all that it got, and `asked` the HTTP requests.

    If `silent`, it sends nothing more over open sockets. If `media`, it plays sounds.
    """

    def __init__(self, port: int = 0, *, media: bool = False) -> None:
        self.joints, self.mode, self.media = dict(ASLEEP), "enabled", media
        self.targets: list[tuple[float, dict[str, float]]] = []
        self.asked: list[tuple[str, Any]] = []
        self.sounds: dict[str, bytes] = {}
        self.moves: dict[str, threading.Event] = {}
        self.held: dict[str, float] | None = None
        self.silent = False
        self.doa: dict[str, object] | None = None
        self._lock = threading.Lock()
        self._ending = threading.Event()
        self._sockets: list[Any] = []
        self._server = _Server(("127.0.0.1", port), _Handler)
        self._server.daemon_of = self
        self.port = self._server.server_address[1]
        self._threads = [
            threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True),
            threading.Thread(target=self._send, daemon=True),
        ]
        for thread in self._threads:
            thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def close(self) -> None:
        """End as a killed process does: all its sockets close."""
        self._ending.set()
        for connection in self._sockets:
            with suppress(OSError):
                connection.shutdown(2)
        self._server.shutdown()
        self._server.server_close()
        for thread in self._threads:
            thread.join()

    def answer(self, method: str, path: str, body: Any) -> tuple[int, Any]:
        """Return status and data of a request."""
        path = path.partition("?")[0]
        self.asked.append((path, body))
        match method, path:
            case "GET", "/api/daemon/status":
                return 200, self.status()
            case "GET", "/api/daemon/robot-app-lock-status":
                return 200, {"state": "free", "holder_name": None}
            case "GET", "/api/telemetry":
                return 200, {"enabled": True, "disabled_by_env": True}
            case "GET", "/api/state/full":
                return 200, self.full()
            case "GET", "/api/motors/status":
                return 200, {"mode": self.mode}
            case "POST", "/api/motors/set_mode/enabled":
                self.mode = "enabled"
                return 200, {"status": "motors changed to MotorControlMode.Enabled mode"}
            case "GET", "/api/state/doa":
                return 200, self.doa
            case "GET", "/api/move/running":
                return 200, [{"uuid": move} for move in list(self.moves)]
            case "POST", "/api/move/play/wake_up":
                return 200, {"uuid": self.move(INIT)}
            case "POST", "/api/move/play/goto_sleep":
                return 200, {"uuid": self.move(ASLEEP, "disabled")}
            case "POST", "/api/move/goto":
                return 200, {"uuid": self.move({**INIT, **_pose(body)}, duration=body["duration"])}
            case "POST", "/api/move/stop":
                if body["uuid"] not in self.moves:
                    return 500, "Internal Server Error"
                self.moves[body["uuid"]].set()
                del self.moves[body["uuid"]]
                return 200, {"message": f"Stopped move with UUID: {body['uuid']}"}
            case "POST", "/api/move/set_target":
                if self.moves:
                    return 200, {"status": "ignored", "reason": "move_running"}
                self.joints |= _pose(body, "target_")
                return 200, {"status": "ok"}
            case "GET", "/api/media/status":
                return 200, {"available": self.media, "released": False, "no_media": not self.media}
            case "POST", "/api/media/play_sound" | "/api/media/stop_sound":
                return 200, {"status": "ok"}
        return 404, {"detail": "Not Found"}

    def status(self) -> dict[str, Any]:
        return {
            "type": "daemon_status", "robot_name": "reachy_mini", "state": "running", "wireless_version": False,
            "desktop_app_daemon": False, "simulation_enabled": False, "mockup_sim_enabled": True,
            "no_media": not self.media, "media_released": False, "camera_specs_name": "",
            "backend_status": {"motor_control_mode": self.mode, "error": None}, "error": None, "wlan_ip": None,
            "version": "1.13.0", "hardware_id": None,
            "face_target": {"detected": False, "x": None, "y": None, "roll": None, "ts": None},
        }  # fmt: skip

    def full(self) -> dict[str, Any]:
        pose = {name.removeprefix("head_"): self.joints[name] for name in HEAD}
        return {
            "control_mode": self.mode, "head_pose": pose, "head_joints": None, "body_yaw": self.joints[BODY],
            "antennas_position": [self.joints[RIGHT], self.joints[LEFT]], "timestamp": "2026-01-01T00:00:00Z",
            "passive_joints": None, "doa": None, "imu": None,
        }  # fmt: skip

    def move(self, goal: Mapping[str, float], mode: str = "", duration: float = MOVE_DURATION) -> str:
        """Begin a move of the daemon, and return its id."""
        name, stopped = str(uuid.uuid4()), threading.Event()
        self.moves[name] = stopped
        threading.Thread(target=self._play, args=(name, stopped, goal, mode, duration), daemon=True).start()
        return name

    def message(self, text: str) -> None:
        """Take a message of the WebSocket."""
        message = json.loads(text)
        if message.get("type") != "set_full_target":
            return
        found = joints_in(message)
        self.targets.append((time.monotonic(), found))
        if not self.moves:
            self.joints = found

    def states(self) -> list[str]:
        """Return the messages with the robot's pose."""
        joints = {**self.joints, **(self.held or {})}
        x, y, z, roll, pitch, yaw = (joints[name] for name in HEAD)
        rows = [[*row, at] for row, at in zip(rotation(roll, pitch, yaw), (x, y, z), strict=True)]
        motors = [joints[BODY], *[0.0] * 6]
        return [
            json.dumps(
                {
                    "type": "joint_positions",
                    "head_joint_positions": motors,
                    "antennas_joint_positions": [joints[RIGHT], joints[LEFT]],
                }
            ),
            json.dumps({"type": "head_pose", "head_pose": [*rows, [0.0, 0.0, 0.0, 1.0]]}),
        ]

    def attach(self, connection: Any) -> None:
        self._sockets.append(connection)

    def _play(self, name: str, stopped: threading.Event, goal: Mapping[str, float], mode: str, duration: float) -> None:
        begin, start = time.monotonic(), dict(self.joints)
        while (share := min((time.monotonic() - begin) / duration, 1.0)) < 1.0:
            self.joints = {joint: at + share * (goal[joint] - at) for joint, at in start.items()}
            if stopped.wait(PERIOD) or self._ending.is_set():
                return
        self.joints, self.mode = dict(goal), mode or self.mode
        self.moves.pop(name, None)

    def _send(self) -> None:
        while not self._ending.wait(PERIOD):
            if not self.silent:
                for text in self.states():
                    for connection in list(self._sockets):
                        with suppress(OSError):
                            connection.sendall(_frame(text))


def joints_in(message: Mapping[str, Any]) -> dict[str, float]:
    """Return the joints in a message with a target."""
    rows = [message["head"][i : i + 4] for i in range(0, 16, 4)]
    right, left = message["antennas"]
    return {**head_joints(rows), BODY: message["body_yaw"], LEFT: left, RIGHT: right}


def _pose(body: Mapping[str, Any], prefix: str = "") -> dict[str, float]:
    """Return the joints in the body of `goto` or `set_target`."""
    given = body.get(f"{prefix}head_pose") or {}
    head = {f"head_{name}": float(value) for name, value in given.items()}
    return {**dict.fromkeys(HEAD, 0.0), **head} if given else {}


def _frame(text: str) -> bytes:
    data = text.encode()
    return struct.pack(">BBH", 0x81, 126, len(data)) + data if len(data) > 125 else bytes((0x81, len(data))) + data


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    allow_reuse_address = True
    daemon_of: FakeDaemon

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Print nothing: a client may disconnect at any time."""


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    headers: Message
    server: _Server

    def do_GET(self) -> None:
        if self.path == "/ws/sdk":
            self._socket()
        else:
            self._answer("GET")

    def do_POST(self) -> None:
        self._answer("POST")

    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing."""

    def _answer(self, method: str) -> None:
        content = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        if self.path == "/api/media/sounds/upload":
            head, _, rest = content.partition(b"\r\n\r\n")
            name = head.partition(b'filename="')[2].partition(b'"')[0].decode()
            self.server.daemon_of.sounds[name] = rest.rpartition(b"\r\n--")[0]
            status, data = 200, {"status": "ok", "path": f"/tmp/reachy_mini_sounds/{name}"}
        else:
            status, data = self.server.daemon_of.answer(method, self.path, json.loads(content) if content else None)
        text = json.dumps(data).encode() if not isinstance(data, str) else data.encode()
        self.send_response(status)
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)

    def _socket(self) -> None:
        """Shake hands, then take frames until the client leaves."""
        key = self.headers["Sec-WebSocket-Key"]
        accept = base64.b64encode(hashlib.sha1((key + GUID).encode()).digest()).decode()
        self.send_response(101)
        for name, value in (("Upgrade", "websocket"), ("Connection", "Upgrade"), ("Sec-WebSocket-Accept", accept)):
            self.send_header(name, value)
        self.end_headers()
        self.close_connection = True
        self.server.daemon_of.attach(self.connection)
        while head := self.rfile.read(2):
            kind, length = head[0] & 15, head[1] & 127
            if length == 126:
                [length] = struct.unpack(">H", self.rfile.read(2))
            mask = self.rfile.read(4)
            data = bytes(byte ^ mask[i % 4] for i, byte in enumerate(self.rfile.read(length)))
            if kind == 8:
                return
            if kind == 1:
                self.server.daemon_of.message(data.decode())
