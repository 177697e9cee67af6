"""How fast the simulated NAO lives: with all that drives it, against bare `mj_step` of the same model and moment.

    python benchmarks/simulation.py

CPU time of one thread; each line is the median of several runs. Standing is the dearest state: both soles bear load.
"""

import platform
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

import mujoco

import lumen
from lumen.language.commands import Walk
from lumen.language.stories import Visitor
from lumen.ports import Image, Perform, RobotCommand, Sense
from lumen.robots.simulation import SimulatedRobot, available

ROOT = Path(__file__).parent.parent
SECONDS, REPEATS = 5.0, 5


def factor(live: Callable[[], object], seconds: float = SECONDS) -> float:
    """Simulated seconds per second of CPU time."""
    live()
    times = []
    for _ in range(REPEATS):
        begin = process_time()
        live()
        times.append(process_time() - begin)
    return seconds / median(times)


def sensing(robot: SimulatedRobot) -> None:
    """`SECONDS` with every sense but the camera read at the original's rates."""
    for tick in range(round(SECONDS / 0.02)):
        robot.advance(0.02)
        if tick % 3 == 0:
            robot.read(Sense.JOINT)
        if tick % 5 == 0:
            robot.read(Sense.SONAR)
            robot.read(Sense.TACTILE)
            robot.face()


def performing(robot: SimulatedRobot, command: RobotCommand) -> float:
    """Simulated seconds per second of CPU time through a command."""
    robot.start("it", command)
    begin, start = process_time(), robot.time
    while not (answers := [event.name for event in robot.poll() if event.name.endswith(".command.it")]):
        robot.advance(0.02)
    assert answers == ["done.command.it"]
    return (robot.time - start) / (process_time() - begin)


def frame(robot: SimulatedRobot) -> float:
    """Time to draw a camera image [s]."""
    image = robot.read(Sense.IMAGE)
    assert isinstance(image, Image)
    image.pixels()
    begin = perf_counter()
    for _ in range(20):
        image.pixels()
    return (perf_counter() - begin) / 20


def main() -> None:
    begin = perf_counter()
    project = lumen.load(ROOT)
    loaded = perf_counter()
    robot = SimulatedRobot(project.body, ROOT / "models", project.hall)
    robot.advance(0.02)
    standing = perf_counter()
    robot.place(Visitor())
    robot.advance(1.0)
    model, data = robot.world.model, robot.world.data
    steps = round(SECONDS / model.opt.timestep)
    bare = factor(lambda: mujoco.mj_step(model, data, steps))
    alone = factor(lambda: robot.advance(SECONDS))
    sensed = factor(lambda: sensing(robot))
    danced = performing(robot, Perform(project.motions["dance"]))
    walked = performing(robot, Walk(0.2))
    print(
        f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, MuJoCo {mujoco.__version__}"
    )
    print(f"project loaded in {loaded - begin:.2f} s, robot standing {standing - loaded:.2f} s later")
    print(f"bare mj_step             {bare:6.1f} x real time")
    print(f"robot, standing          {alone:6.1f} x   {alone / bare:.2f} of bare")
    print(f"robot, senses, visitor   {sensed:6.1f} x   {sensed / bare:.2f} of bare")
    print(f"robot, dancing           {danced:6.1f} x   {danced / bare:.2f} of bare")
    print(f"robot, walking           {walked:6.1f} x   {walked / bare:.2f} of bare")
    reason = available()
    print(f"camera image             {reason or f'{1000 * frame(robot):6.1f} ms at 320 x 240'}")
    robot.close()


if __name__ == "__main__":
    main()
