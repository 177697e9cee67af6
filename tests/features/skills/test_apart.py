"""Skills of an exhibition in two processes: the robot's process performs them, and the brain's gets the results."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from lumen.bus import connect
from lumen.cli.main import main
from lumen.project import load
from tests.features.skills.changing import BEHAVIOR, project_in
from tests.guarded import DEVNULL, STDOUT, Guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until

pytestmark = [pytest.mark.slow, pytest.mark.broker, pytest.mark.process]
SHORT = {BEHAVIOR: ("duration: 3s", "duration: 50ms")}


@pytest.fixture
def start(tmp_path: Path, broker: RabbitMQ) -> Iterator[Callable[[str], Path]]:
    """A function that starts these parts of the project in `tmp_path/hall`, and returns the file with their output."""
    with ExitStack() as stack:

        def begin(parts: str) -> Path:
            log = tmp_path / f"{parts}.log"
            process = Guarded(
                [sys.executable, "-m", "lumen", "run", tmp_path / "hall", "--robot", "own", "--only", parts],
                env={**os.environ, "LUMEN_BUS": broker.url, "XDG_STATE_HOME": str(tmp_path / "state")},
                text=True,
                stdin=DEVNULL,
                stdout=stack.enter_context(log.open("w")),
                stderr=STDOUT,
            )
            stack.callback(process.wait)
            stack.callback(process.kill)
            return log

        yield begin


def test_the_process_of_the_robot_performs_a_skill_of_the_brain(
    tmp_path: Path, broker: RabbitMQ, start: Callable[[str], Path]
) -> None:
    root = project_in(tmp_path / "hall", SHORT)
    assert main(["new", "robot", "own", "--project", str(root)]) == 0
    project = load(root)
    bus, states, signs = connect(broker.url, project), Collector(), Collector()
    bus.subscribe(project.key_of("state"), states)
    bus.subscribe(project.key_of("presence"), signs)
    robot, brain = start("robot"), start("brain,motion")

    def shown() -> str:
        return f"{robot.read_text()[-1500:]}\n{brain.read_text()[-1500:]}"

    until(lambda: any(set(body.get("skills", ())) == {"spray"} for body in signs.bodies), shown=shown)
    until(lambda: any(body.get("follows") for body in signs.bodies), shown=shown)
    assert any(body.get("skill_states", {}).get("spray", {}).get("state") == "idle" for body in signs.bodies)

    def met() -> bool:
        bus.publish(project.key_of("face"), {"x": 160, "y": 120})
        return any("sprayed" in body.get("entered", ()) for body in states.bodies)

    until(met, every=0.5, shown=shown)
    assert next(body["context"]["litres"] for body in states.bodies if "sprayed" in body.get("entered", ())) == 0.2
    assert "spraying with the left nozzle" in robot.read_text()
    assert "spraying with" not in brain.read_text()
    bus.close()
