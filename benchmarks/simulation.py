"""Measure the speed of the simulated NAO: with its whole software, compared with bare `mj_step` of the same moments.

    python benchmarks/simulation.py

Figures are simulated seconds per second of CPU time of the whole process. The servos' targets are recorded, and then
replayed to a bare `mj_step` from the same initial state, which reaches exactly the same final state.
"""

import platform
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot, available
from lumen.features.simulation.world import CONTROL_PERIOD, World
from lumen.language.commands import Walk
from lumen.language.projects import Project
from lumen.language.routes import SIZES, Size
from lumen.language.stories import Visitor
from lumen.ports import Image, Perform, RobotCommand, Sense
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.rehearsal import rehearse
from lumen.run.setup import Setup

ROOT = Path(__file__).parent.parent
SECONDS = 20.0
BEGINNING = mujoco.mjtState.mjSTATE_INTEGRATION

Told = list[tuple[NDArray[np.float64], NDArray[np.float64]]]
"""For each control period, the targets of the servos and their force limits."""


class Pace(NamedTuple):
    """Simulated seconds per second of CPU time: of the robot, and of bare steps of the same moments."""

    lived: float
    bare: float


def against_bare(name: str, robot: SimulatedRobot, live: Callable[[], object]) -> None:
    """Print the speed of the robot in `live`, and that of bare steps of the same moments."""
    lived, bare = paced(robot, live)
    print(f"{name:<18} {lived:6.1f} x real time   bare {bare:6.1f} x   {lived / bare:.2f} of bare", flush=True)


def paced(robot: SimulatedRobot, live: Callable[[], object]) -> Pace:
    """Return the speed of the robot in `live`, and that of bare steps."""
    world = robot.world
    told: Told = []
    beginning = np.zeros(mujoco.mj_stateSize(world.model, BEGINNING))
    mujoco.mj_getState(world.model, world.data, beginning, BEGINNING)
    _listen(world, told)
    begin = process_time()
    live()
    took = process_time() - begin
    del world.step
    bare, time = _bare(world, beginning, told), CONTROL_PERIOD * len(told)
    return Pace(time / took, time / bare)


def _listen(world: World, told: Told) -> None:
    """Record the targets of the servos from now on."""
    step, data, most = world.step, world.data, world.model.actuator_forcerange

    def listening() -> None:
        told.append((data.ctrl.copy(), most.copy()))
        step()

    world.step = listening  # type: ignore[method-assign]


def _bare(world: World, beginning: NDArray[np.float64], told: Told) -> float:
    """Return the CPU time of bare steps with the recorded targets [s]."""
    model, data, steps = world.model, mujoco.MjData(world.model), round(CONTROL_PERIOD / world.model.opt.timestep)
    mujoco.mj_setState(model, data, beginning, BEGINNING)
    mujoco.mj_forward(model, data)
    begin = process_time()
    for goal, most in told:
        data.ctrl[:], model.actuator_forcerange[:] = goal, most
        mujoco.mj_step(model, data, steps)
    took = process_time() - begin
    assert np.array_equal(data.qpos, world.data.qpos), "these were other moments"
    return took


def sensing(robot: SimulatedRobot) -> None:
    """Simulate `SECONDS` with every sense except the camera read at the original's rates."""
    for tick in range(round(SECONDS / 0.02)):
        robot.advance(0.02)
        if tick % 3 == 0:
            robot.read(Sense.JOINT)
        if tick % 5 == 0:
            robot.read(Sense.SONAR)
            robot.read(Sense.TACTILE)
            robot.face()


def performing(robot: SimulatedRobot, command: RobotCommand) -> None:
    """Simulate a command to its successful end."""
    robot.start("it", command)
    while not (answers := [event.name for event in robot.poll() if event.name.endswith(".command.it")]):
        robot.advance(0.02)
    assert answers == ["done.command.it"]


def touring(project: Project, robot: SimulatedRobot) -> None:
    """Simulate the story of a whole visit, with everything on the bus except images."""
    blind = replace(project, routes={name: route for name, route in project.routes.items() if name != Sense.IMAGE})
    clock = SimulatedClock(robot.advance)
    rehearsal = rehearse(blind, project.stories[project.story], Setup(robot, clock, robot))
    assert rehearsal.failed is None, rehearsal.failed


class Pictured(NamedTuple):
    """Simulated seconds with the camera per second of CPU time, and the numbers of its images."""

    lived: float
    published: int
    dropped: int


def pictured(project: Project, robot: SimulatedRobot, pace: float) -> Pictured:
    """Simulate `SECONDS` of the story with all senses, at `pace` times real time."""
    setup = Setup(robot, SimulatedClock(robot.advance, pace), robot)
    exhibition = Exhibition(Plan(project, setup, story=project.stories[project.story]))
    exhibition.node.bus.subscribe(project.key_of(Sense.IMAGE), lambda _: None)
    exhibition.start()
    began = process_time()
    lived = exhibition.run(SECONDS)
    took = process_time() - began
    images = exhibition.robot.server.counts[Sense.IMAGE]
    exhibition.close()
    return Pictured(lived / took, images.published, images.dropped)


def frame(robot: SimulatedRobot, size: Size) -> float:
    """Return the time to render a camera image of that size [s]."""
    image = robot.read(Sense.IMAGE)
    assert isinstance(image, Image)
    image.pixels(size)
    begin = perf_counter()
    for _ in range(20):
        image.pixels(size)
    return (perf_counter() - begin) / 20


def main() -> None:
    begin = perf_counter()
    project = lumen.load(ROOT)
    loaded = perf_counter()
    robot = SimulatedRobot(project.body, ROOT / "models", project.hall)
    robot.advance(0.02)
    standing = perf_counter()
    print(
        f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, MuJoCo {mujoco.__version__}"
    )
    print(f"project loaded in {loaded - begin:.2f} s, robot standing {standing - loaded:.2f} s later")
    robot.place(Visitor())
    robot.advance(1.0)
    against_bare("standing", robot, lambda: robot.advance(SECONDS))
    against_bare("standing, senses", robot, lambda: sensing(robot))
    against_bare("walking", robot, lambda: performing(robot, Walk(0.2)))
    against_bare("dancing", robot, lambda: performing(robot, Perform(project.motions["dance"])))
    visited = SimulatedRobot(project.body, ROOT / "models", project.hall, stage=project.stage)
    against_bare("a whole tour", visited, lambda: touring(project, visited))
    if not available():
        seen = SimulatedRobot(project.body, ROOT / "models", project.hall, stage=project.stage)
        lived, published, dropped = pictured(project, seen, 4.0)
        images = f"{dropped} of {published + dropped} images dropped at 4 x"
        print(f"with the camera    {lived:6.1f} x real time by CPU   {images}")
    for size in () if available() else SIZES[1:3]:
        print(f"camera image       {1000 * frame(robot, size):6.1f} ms at {size}")
    print(available() or "", end="\n" * bool(available()))
    robot.close()


if __name__ == "__main__":
    main()
