"""Jobs that need much memory run in processes that end; each outcome, failures too, is a line for the page."""

import asyncio
import errno
import io
import json
import math
import sys
from collections.abc import AsyncIterator
from contextlib import closing
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest

import lumen
from lumen.errors import BusError, LumenError
from lumen.features.console import jobs
from lumen.features.console.jobs import MAX_WAITING, Jobs
from lumen.features.console.poses import Poses
from lumen.features.console.requests import DeniedError
from lumen.upkeep import judge_process
from lumen.upkeep.garbage import RARELY
from lumen.upkeep.judge_process import Fault, NoAnswerError, receive
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served, Stream
from tests.guarded import PIPE, Guarded, run_guarded
from tests.tables import for_each
from tests.waiting import until

JOINTS = "avatar.NAO.data.joint"
FREE_OF_OTHERS = """
import gc, sys
import lumen.retrieval.scorers
from lumen.features.console import job

def found(*_):
    dear = {"lumen.run.recalling", "lumen.features.console.kept_days", "lumen.lint", "snowballstemmer"}
    yield repr((gc.get_threshold()[0], dear & sys.modules.keys())).encode()

job.JOBS["found"] = found
job.main("found", "", "[]")
"""
"""A job that returns its threshold for garbage collection, and which of the expensive modules it imported."""


@pytest.fixture(name="gone_wrong")
def _gone_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "PROGRAM", "tests.features.console.gone_wrong")


def done(*jobs_: str, told: AsyncIterator[bytes] | None = None) -> list[Any]:
    """Run these jobs, all requested at once, and return their results or exceptions."""

    async def ask() -> list[Any]:
        here = Jobs(Path())
        return await asyncio.gather(*(here.do(one, told=told) for one in jobs_), return_exceptions=True)

    return asyncio.run(ask())


def reasons(found: list[Any]) -> list[tuple[int, str]]:
    assert all(isinstance(one, DeniedError) for one in found), found
    return [(one.status, one.reason) for one in found]


@pytest.mark.process
@pytest.mark.usefixtures("gone_wrong")
def test_what_ends_a_job_is_said() -> None:
    [(status, killed), refused, (_, large)] = reasons(done("killed", "refused", "too large"))
    assert (status, refused) == (503, (404, "there is no such file"))
    assert "SIGKILL" in killed
    assert "memory" in large


@pytest.mark.process
@pytest.mark.usefixtures("gone_wrong")
def test_who_waits_too_long_and_who_comes_too_late_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "JOB_TIME", 0.5)
    told = reasons(done(*["slow"] * (MAX_WAITING + 1)))
    late = "this takes longer than 0.5 s: use `lumen` in a terminal"
    assert [reason for _, reason in told].count(late) == MAX_WAITING
    assert "try again in a moment" in told[-1][1]


def test_a_job_imports_its_own_modules_and_searches_rarely_for_garbage() -> None:
    printed = run_guarded([sys.executable, "-c", FREE_OF_OTHERS], input=b"", capture_output=True, check=True).stdout
    assert receive(io.BytesIO(printed)) == repr((RARELY, set())).encode()


def test_a_process_that_can_not_be_started_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: Any, **__: Any) -> None:
        raise BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable")

    monkeypatch.setattr(judge_process.subprocess, "Popen", refused)
    reason = "cannot start a process to compute this: Resource temporarily unavailable"
    assert reasons(done("echo", "echo")) == [(503, reason), (503, reason)]


@pytest.mark.process
@pytest.mark.usefixtures("gone_wrong")
def test_what_tells_a_job_may_fail() -> None:
    async def told() -> AsyncIterator[bytes]:
        yield b"one"
        raise BusError("nobody answers")

    assert [str(one) for one in done("echo", told=told())] == ["nobody answers"]


@for_each(
    ("error", "reason"),
    [
        (LumenError("there is no such model"), "there is no such model"),
        (NoAnswerError(Fault.MEMORY, 77), "this needs more memory than the console allows: use `lumen` in a terminal"),
        (
            NoAnswerError(Fault.ENDED, 1),
            "the process that computes this ended without an answer (exit code 1): try again, or use",
        ),
    ],
)
def test_a_process_of_poses_that_has_ended_says_why(error: Exception, reason: str) -> None:
    def begin(job: str, home: str) -> Any:
        assert (job, home) == ("poses", "/home")
        return Mock(request=Mock(side_effect=error))

    watch = SimpleNamespace(keys=SimpleNamespace(home=lambda robot: "/home"))
    poses = Poses(watch, SimpleNamespace(begin=begin), "NAO")  # type: ignore[arg-type]
    with pytest.raises(DeniedError) as raised:
        asyncio.run(poses._asked(b"{}"))
    assert raised.value.reason.startswith(f"the robot cannot be drawn: {reason}")
    assert poses._process is None, "the next look begins another one"


def test_no_process_of_poses_is_begun_for_a_page_that_has_closed() -> None:
    view = SimpleNamespace(moved=1, joints={}, robot="NAO")
    poses = Poses(SimpleNamespace(robots={"NAO": view}), Mock(), "NAO")  # type: ignore[arg-type]
    asyncio.run(poses._placed(view))  # type: ignore[arg-type]
    assert poses._process is None


@pytest.mark.process
def test_entries_that_are_told_make_the_same_day(copy: Path) -> None:
    async def told() -> AsyncIterator[bytes]:
        yield json.dumps([{"position": 3, "at": 1.0, "heard": "heard", "data": {"result": "dance"}}]).encode()
        yield b"{nonsense"

    day = json.loads(asyncio.run(Jobs(copy).do("day", "", "2026-11-23", "page", "told", told=told())))
    assert (day["date"], day["visits"]) == ("2026-11-23", [])


def test_the_console_itself_has_neither_the_simulator_nor_numbers_in_it() -> None:
    heavy = {"mujoco", "dm_control", "numpy", "scipy"}
    script = f"import sys, lumen.features.console.serving; print(*{heavy} & set(sys.modules))"
    with Guarded([sys.executable, "-c", script], stdout=PIPE, text=True) as process:
        assert process.communicate()[0].split() == []


def test_poses_follow_the_joints_and_their_process_ends_with_the_looking(
    served: Served, hosted: Hosted, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pose turns the head by the angle of its joint on the bus; a message without joints is ignored."""
    monkeypatch.setattr("lumen.features.console.poses.LINGER", 0.1)
    poses, bus = served.console.site.sights.poses("NAO"), hosted.exhibition.node.bus
    names = list(lumen.load(hosted.root).body.joints)

    def turned(angle: float) -> bool:
        """Return whether the last pose has the head at that angle [rad] about z, by its quaternion w, i, j, k."""
        bus.publish(JOINTS, {"name": [], "angle": [], "stiffness": []})
        angles = [angle if name == "HeadYaw" else 0.0 for name in names]
        bus.publish(JOINTS, {"name": names, "angle": angles, "stiffness": [1.0] * len(names)})
        if not (found := stream.of("pose")):
            return False
        w, _, _, k = found[-1].data["links"]["HeadPitch"][3:]
        return abs(2 * math.atan2(k, w) - angle) < 1e-3

    with Stream(browser, "/api/poses?robot=NAO") as stream:
        for angle in (0.5, -0.25):
            until(partial(turned, angle))
        process = poses._process
        assert process
        assert process.alive
    until(lambda: not process.alive)


def test_a_model_that_is_gone_is_said_and_what_draws_is_begun_anew(
    served: Served, hosted: Hosted, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lumen.features.console.poses.RETRY", 0.1)
    monkeypatch.setattr(jobs, "PROGRAM", "tests.features.console.gone_wrong")
    with Stream(browser, "/api/poses?robot=NAO") as stream:
        until(lambda: len(stream.of("trouble")) > 1)
    assert "the robot cannot be drawn: " in stream.of("trouble")[0].data["reason"]


def test_who_does_not_read_poses_is_given_the_newest_only(
    served: Served, hosted: Hosted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The console keeps no pose that it did not send, however often the robot moves."""
    poses = served.console.site.sights.poses("NAO")
    view = served.console.site.watch.robots["NAO"]

    async def read() -> tuple[bytes, bytes]:
        stream = poses.stream()
        first = await anext(stream)
        for _ in range(1_000):
            view.feel("joint", {"name": []})
        return first, await anext(stream)

    async def placed(of: object) -> bytes:
        return b"%d" % view.moved

    monkeypatch.setattr(poses, "_placed", placed)
    first, second = asyncio.run(read())
    assert int(first) + 900 < int(second) <= view.moved  # the robot moves too


def test_while_the_first_pose_is_computed_its_readers_hear_that_the_console_is_there(
    served: Served, hosted: Hosted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pages give up on a stream that is silent for 3 s, and a small machine needs longer to load the model."""
    monkeypatch.setattr("lumen.features.console.poses.HEARTBEAT", 0.01)
    poses = served.console.site.sights.poses("NAO")

    async def read() -> list[bytes]:
        loaded = asyncio.Event()

        async def placed(of: object) -> bytes:
            await loaded.wait()
            return b"pose"

        monkeypatch.setattr(poses, "_placed", placed)
        stream = poses.stream()
        told = [await anext(stream) for _ in range(3)]
        loaded.set()
        while told[-1] != b"pose":
            told.append(await anext(stream))
        return told

    assert set(asyncio.run(read())) == {b":\n\n", b"pose"}


def test_a_robot_of_another_project_is_not_drawn_by_the_model_of_this_one(served: Served, hosted: Hosted) -> None:
    body = {"robot": "NAO2", "parts": ["robot"], "session": "s", "state": "here", "time": 0.0}
    with closing(served):  # other tests need a console that knows no other robot
        hosted.exhibition.node.bus.publish("lumen.NAO2.presence", body)
        until(lambda: "NAO2" in [robot["robot"] for robot in served.browser.robots])
        for path in ("shape", "poses"):
            answer = served.browser.get(f"/api/{path}?robot=NAO2")
            reason = "only robots of this console's own project can be drawn"
            assert (answer.status, answer.data["reason"]) == (404, reason)
