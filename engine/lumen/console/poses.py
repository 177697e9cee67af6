"""Where a robot's links are and what they look like, for who draws it; from processes that end when nobody looks."""

import asyncio
from asyncio.subprocess import Process
from collections.abc import AsyncIterator

import orjson

from lumen.console.jobs import Jobs, ended, why_none
from lumen.console.known_robot import KnownRobot
from lumen.console.requests import DeniedError
from lumen.console.watch import Watch

PERIOD = 1 / 15
"""How long after a pose the next is sent at the earliest [s]."""
HEARTBEAT = 1.0
POSE_TIME = 20.0
"""How long a pose may take [s]: the first one loads the model."""
LINGER, RETRY = 5.0, 5.0
"""How long the process stays after the last looker, and until it is begun anew where it has died [s]."""


class Poses:
    """Poses of a robot of this console's own project; other robots have models that nobody here knows.

    Everything raises DeniedError where that has errors, or MuJoCo is not installed.
    """

    def __init__(self, watch: Watch, jobs: Jobs, robot: str) -> None:
        self._watch, self._jobs, self._robot = watch, jobs, robot
        self._shape: tuple[object, bytes] | None = None
        self._child: Process | None = None
        self._turn, self._lookers = asyncio.Lock(), 0
        self._pose: tuple[int, bytes] = -1, b""
        self.closing = False

    async def shape(self) -> bytes:
        """The links with their shapes, and the stage [m], as JSON; made once for a bundle of files."""
        bundle = self._watch.robots[self._robot].said.get("bundle")
        if self._shape is None or self._shape[0] != bundle:
            self._shape = bundle, await self._jobs.do("shape", self._home)
        return self._shape[1]

    async def stream(self) -> AsyncIterator[bytes]:
        """Server-sent events `pose` as it moves, only the newest; `trouble` where there is none, with the reason."""
        seen, waited, view = -1, 0.0, self._watch.robots[self._robot]
        self._lookers += 1
        try:
            while not self.closing:
                if view.moved != seen:
                    seen, waited = view.moved, 0.0
                    try:
                        yield await self._placed(view)
                    except DeniedError as error:
                        yield b"event: trouble\ndata: " + orjson.dumps({"reason": error.reason}) + b"\n\n"
                        await asyncio.sleep(RETRY)
                elif (waited := waited + PERIOD) >= HEARTBEAT:
                    waited = 0.0
                    yield b":\n\n"
                await asyncio.sleep(PERIOD)
        finally:
            self._lookers -= 1
            asyncio.get_running_loop().call_later(0.0 if self.closing else LINGER, self._leave)

    @property
    def _home(self) -> str:
        return self._watch.keys.home(self._robot)

    async def _placed(self, view: KnownRobot) -> bytes:
        """The event of where it is now, computed once for all that look."""
        async with self._turn:
            moved = view.moved
            if self._pose[0] != moved:
                links = await self._asked(orjson.dumps(dict(view.joints)))
                told = b'event: pose\ndata: {"robot":%b,"links":%b}\n\n' % (orjson.dumps(view.robot), links)
                self._pose = moved, b":\n\n" if links == b"null" else told
            return self._pose[1]

    async def _asked(self, joints: bytes) -> bytes:
        """A line for a line, from the process, which is begun where there is none."""
        if self._child is None:
            self._child = await self._jobs.begin("poses", self._home)
        child, line = self._child, b""
        assert child.stdin
        assert child.stdout
        try:
            async with asyncio.timeout(POSE_TIME):
                child.stdin.write(joints + b"\n")
                await child.stdin.drain()
                line = await child.stdout.readline()
        except (TimeoutError, ConnectionError, ValueError):
            pass
        if line.endswith(b"\n"):
            return line.rstrip()
        self._child = None
        if child.returncode is None and not line:
            await asyncio.wait({asyncio.ensure_future(child.wait())}, timeout=1.0)
        code = child.returncode
        await ended(child)
        raise DeniedError(503, f"the robot cannot be drawn: {why_none(code or 0, line)}")

    def _leave(self) -> None:
        """End the process where nobody looks any more: it ends where there is nothing more to read."""
        if not self._lookers and self._child and self._child.stdin:
            self._child.stdin.close()
            self._child = None
