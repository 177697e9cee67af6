"""Shapes and poses for drawing a robot's links, computed by processes that end after the last viewer has left."""

import asyncio
from collections.abc import AsyncIterator

import orjson

from lumen.errors import LumenError
from lumen.features.console.job_promises import JOB_TIME
from lumen.features.console.jobs import Jobs, why_none
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.requests import DeniedError
from lumen.features.console.watch import Watch
from lumen.upkeep.judge_process import JudgeProcess, NoAnswerError

PERIOD = 1 / 15
"""The shortest time between two poses [s]."""
HEARTBEAT = 1.0
LINGER, RETRY = 5.0, 5.0
"""The time for which the process outlives the last viewer, and the pause before a failed one restarts [s]."""


class Poses:
    """Shapes and poses of a robot of the console's own project; other robots' models are not available.

    If the project has errors or MuJoCo is not installed, `shape` raises DeniedError and `stream` yields `trouble`.
    """

    def __init__(self, watch: Watch, jobs: Jobs, robot: str) -> None:
        self._watch, self._jobs, self._robot = watch, jobs, robot
        self._shape: tuple[object, bytes] | None = None
        self._process: JudgeProcess | None = None
        self._turn, self._lookers = asyncio.Lock(), 0
        self._pose: tuple[int, bytes] = -1, b""
        self.closing = False

    async def shape(self) -> bytes:
        """Return the links with their shapes, and the stage [m], as JSON; computed once per bundle of files."""
        bundle = self._watch.robots[self._robot].said.get("bundle")
        if self._shape is None or self._shape[0] != bundle:
            self._shape = bundle, await self._jobs.do("shape", self._home)
        return self._shape[1]

    async def stream(self) -> AsyncIterator[bytes]:
        """Yield server-sent events: `pose` after each move, or `trouble` with the reason if it can't be computed."""
        seen, waited, view = -1, 0.0, self._watch.robots[self._robot]
        self._lookers += 1
        try:
            while not self.closing:
                if view.moved != seen:
                    seen, waited = view.moved, 0.0
                    try:
                        async for part in self._awaited(view):
                            yield part
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

    async def _awaited(self, view: KnownRobot) -> AsyncIterator[bytes]:
        """Yield the event with the current pose, and comments until it is computed: pages give up on a silent stream.

        If its reader leaves, the computation continues for the next one.
        """
        placed = asyncio.ensure_future(self._placed(view))
        placed.add_done_callback(lambda done: done.cancelled() or done.exception())  # else asyncio logs a traceback
        while not (await asyncio.wait([placed], timeout=HEARTBEAT))[0]:
            yield b":\n\n"
        yield placed.result()

    async def _placed(self, view: KnownRobot) -> bytes:
        """Return the event with the current pose, computed once for all viewers; a comment if there is no pose."""
        async with self._turn:
            moved = view.moved
            if self._lookers and self._pose[0] != moved:  # without a page, nothing would end the process
                links = await self._asked(orjson.dumps(dict(view.joints)))
                told = b'event: pose\ndata: {"robot":%b,"links":%b}\n\n' % (orjson.dumps(view.robot), links)
                self._pose = moved, b":\n\n" if links == b"null" else told
            return self._pose[1]

    async def _asked(self, joints: bytes) -> bytes:
        """Return the process's answer; start one if necessary. Raises DeniedError if it fails."""
        process = self._process = self._process or self._jobs.begin("poses", self._home)
        try:
            answer: bytes = await asyncio.to_thread(process.request, joints, JOB_TIME)
        except (LumenError, NoAnswerError) as error:
            self._process = None
            process.end()
            raise DeniedError(503, f"the robot cannot be drawn: {why_none(error)}") from None
        return answer

    def _leave(self) -> None:
        """End the process unless there is a viewer again."""
        if not self._lookers and self._process:
            process, self._process = self._process, None
            process.end()
