"""The shipped tour on the fake of the daemon, from the visitor's face to the goodbye."""

from pathlib import Path

import pytest

import lumen
from lumen.clock.real import RealClock
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.projects import Project
from tests.features.reachy.fake import FakeDaemon
from tests.tour.conftest import copied
from tests.waiting import until

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("patient")]


def test_the_shipped_tour_greets_and_says_goodbye(
    tmp_path: Path, project: Project, daemon: FakeDaemon, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LUMEN_MODEL", "reachy_mini")
    clock, entered = RealClock(), list[str]()
    robot = ReachyRobot(project.body, daemon.url, clock.now)
    with lumen.open(copied(tmp_path), robot=robot, clock=clock) as exhibition:
        exhibition.observe(lambda step: entered.extend(step.entered))

        def until_entered(state: str) -> None:
            """Run until a state was entered since the last one."""
            until(
                lambda: any(path.rpartition(".")[2] == state for path in entered),
                meanwhile=lambda: exhibition.run(seconds=0.2),
                what=state,
                shown=lambda: entered[-12:],
            )
            entered.clear()

        def hears(text: str) -> None:
            exhibition.send("heard", {"name": "visitor", "result": text, "date": "", "language": "en"})

        until(lambda: daemon.mode == "enabled" and robot._mover.awake, meanwhile=lambda: exhibition.run(seconds=0.2))
        exhibition.send("face", {"x": 160.0, "y": 120.0})
        until_entered("greet")
        until_entered("ask_name")
        hears("My name is Budi")
        until_entered("how_are_you")
        hears("I am fine, thank you")
        until_entered("offer")
        hears("Goodbye!")
        until_entered("goodbye")
        until(lambda: "goodbye" not in str(exhibition.configuration), meanwhile=lambda: exhibition.run(seconds=0.2))
    assert len(daemon.targets) > 50
    assert not [path for path, _ in daemon.asked if path == "/api/move/goto"]
