"""Measure Lumen on a Reachy Mini, beside the vendor's own client, on the vendor's daemon without a robot.

    sh tests/features/reachy/install_daemon.sh && python benchmarks/reachy.py [--seconds 20]

It prints the processor time of streaming 50 targets a second, in per cent of one core, for Lumen (with its life, its
limits and the messages that come back) and for `reachy_mini.ReachyMini.set_target`; and the time from a face message
to the first target that moves the head, and to the first measured movement. Then it prints how long a rest lasts until
the robot is asleep, and how long after a kill of the daemon in a dance the robot is reported lost.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from tests import ROOT
from tests.features.reachy.driving import Driven, reachy_project
from tests.features.reachy.real_daemon import PROGRAM, RealDaemon
from tests.guarded import run_guarded

import lumen
from lumen.clock.real import RealClock
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.commands import Rest, Wake
from lumen.language.projects import Project
from lumen.ports import Joints, Live, Perform, Sense
from lumen.project.chosen_model import choose

LOOKS = 20
VENDOR = """
import sys, time, numpy as np
from reachy_mini import ReachyMini
from reachy_mini.utils import create_head_pose
port, seconds = int(sys.argv[1]), float(sys.argv[2])
given = dict(connection_mode="network", media_backend="no_media", log_level="ERROR")
with ReachyMini(host="127.0.0.1", port=port, **given) as mini:
    mini.wake_up()
    begin, spent, i = time.monotonic(), time.process_time(), 0
    while time.monotonic() < begin + seconds:
        yaw = 0.2 * np.sin(2 * np.pi * (time.monotonic() - begin) / 3)
        mini.set_target(create_head_pose(yaw=yaw, degrees=False), antennas=[-0.17, 0.17], body_yaw=0.0)
        i += 1
        time.sleep(max(0.0, begin + i * 0.02 - time.monotonic()))
    print(100 * (time.process_time() - spent) / seconds, i / seconds)
"""


def streaming(robot: Driven, seconds: float) -> tuple[float, float]:
    """Return the processor time of a robot with idle life only [% of a core], and its ticks per second."""
    begin, spent, ticks = time.monotonic(), time.process_time(), 0
    while time.monotonic() < begin + seconds:
        robot.robot.poll()
        ticks += 1
        time.sleep(max(0.0, begin + ticks * 0.02 - time.monotonic()))
    return 100 * (time.process_time() - spent) / seconds, ticks / seconds


def looks(url: str) -> tuple[list[float], list[float]]:
    """Return the times from a face message to the head's first new target, and to its first measured motion [s]."""
    clock = RealClock()
    choose("reachy_mini")
    project = lumen.load(ROOT / "examples/reachy")
    robot = ReachyRobot(project.body, url, clock.now)
    sent, moved = [], []
    with lumen.open(ROOT / "examples/reachy", robot=robot, clock=clock) as exhibition:
        robot.start("", Live(project.life["lively"]))
        while "waiting" not in exhibition.configuration:
            exhibition.run(seconds=0.2)
        exhibition.send("face", {"x": 160.0, "y": 120.0})
        while "listening" not in exhibition.configuration:
            exhibition.run(seconds=0.2)
        for i in range(LOOKS):
            exhibition.run(seconds=0.7)
            goal, before = robot._mover.goal["head_yaw"], _yaw(robot)
            begin = time.monotonic()
            exhibition.send("face", {"x": 60.0 if i % 2 else 260.0, "y": 120.0})
            while abs(robot._mover.goal["head_yaw"] - goal) < 1e-3 and time.monotonic() < begin + 2:
                exhibition.tick()
                time.sleep(0.002)
            sent.append(time.monotonic() - begin)
            while abs(_yaw(robot) - before) < 0.02 and time.monotonic() < begin + 2:
                exhibition.tick()
                time.sleep(0.002)
            moved.append(time.monotonic() - begin)
    return sent, moved


def asleep(robot: Driven) -> float:
    """Return the time from the command `rest` to its end, when the head lies [s]."""
    robot.answer("wake again", Wake())
    begin = time.monotonic()
    robot.answer("rest", Rest())
    return time.monotonic() - begin


def lost(robot: Driven, project: Project, kill: Callable[[], None]) -> float:
    """Return the time from the end of the daemon, in a dance, to `robot.lost` [s]."""
    robot.answer("wake for a dance", Wake())
    robot.robot.start("dance", Perform(project.motions["dance"]))
    robot.until(lambda: abs(robot.joints()["head_roll"]) > 0.1, "it dances")
    begin = time.monotonic()
    kill()
    robot.until(lambda: "robot.lost" in robot.names(), "it is lost")
    return time.monotonic() - begin


def _yaw(robot: ReachyRobot) -> float:
    reading = robot.read(Sense.JOINT)
    assert isinstance(reading, Joints)
    return reading.angles[reading.names.index("head_yaw")]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=20.0)
    seconds = parser.parse_args().seconds
    project = reachy_project()
    with tempfile.TemporaryDirectory() as folder:
        daemon = RealDaemon(Path(folder))
        try:
            robot = Driven(project, daemon.url)
            robot.answer("wake", Wake())
            robot.robot.start("", Live(project.life["lively"]))
            cost, rate = streaming(robot, seconds)
            robot.close()
            print(f"Lumen, streaming at {rate:.0f} Hz with its life:   {cost:5.1f} % of a core")
            python = PROGRAM.with_name("python")
            done = run_guarded(
                [python, "-c", VENDOR, str(daemon.port), str(seconds)], capture_output=True, text=True, check=True
            )
            vendor, rate = map(float, done.stdout.split()[-2:])
            print(f"the vendor's client, set_target at {rate:.0f} Hz:     {vendor:5.1f} % of a core")
            sent, moved = looks(daemon.url)
            for what, times in (("a new target", sent), ("a measured movement", moved)):
                most = f"longest of {LOOKS}: {1000 * max(times):.0f}"
                print(f"from a face to {what:<20} {1000 * median(times):12.0f} ms ({most})")
            robot = Driven(project, daemon.url)
            print(f"from rest to asleep {1000 * asleep(robot):30.0f} ms (limit 5000)")
            print(
                f"from a kill in a dance to robot.lost {1000 * lost(robot, project, daemon.kill):13.0f} ms (limit 500)"
            )
            robot.close()
        finally:
            daemon.close()


if __name__ == "__main__":
    main()
