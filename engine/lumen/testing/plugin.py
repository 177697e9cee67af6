"""The plugin of pytest: with `--lumen-robot` it runs the tests of `robot_promises.py` with that robot.

Each pytest in an environment with Lumen imports this module, so it imports nothing else of Lumen until it is used.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from lumen.language.projects import Project
    from lumen.testing.trial import RobotTrial

PROMISES = Path(__file__).with_name("robot_promises.py")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options `--lumen-robot` and `--lumen-project`."""
    group = parser.getgroup("lumen")
    group.addoption(
        "--lumen-robot",
        metavar="DRIVER",
        help="test a robot of your own: `package:Class`, or NAME for drivers/NAME.py of the project",
    )
    group.addoption(
        "--lumen-project",
        metavar="DIR",
        help="with --lumen-robot: the project whose body and motions the robot gets (default: here or above)",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Add the tests of robots; without other arguments run only these."""
    if not config.getoption("--lumen-robot"):
        return
    named = config.args_source is pytest.Config.ArgsSource.ARGS
    config.args = [*(config.args if named else ()), str(PROMISES)]


@pytest.fixture(scope="session")
def lumen_project(request: pytest.FixtureRequest) -> "Project":
    """The project of `--lumen-project`, else the one here or above, else the one that comes with Lumen."""
    from lumen.errors import LumenError
    from lumen.project import load

    try:
        return load(request.config.getoption("--lumen-project"))
    except LumenError as error:
        pytest.exit(f"--lumen-project: {error}", returncode=4)


@pytest.fixture
def trial(request: pytest.FixtureRequest, lumen_project: "Project") -> "Iterator[RobotTrial]":
    """The robot of `--lumen-robot`, made anew and started, within the limits of the project's body."""
    from lumen.errors import LumenError
    from lumen.testing.trial import RobotTrial

    try:
        made = RobotTrial(request.config.getoption("--lumen-robot"), lumen_project)
    except LumenError as error:
        pytest.fail(str(error), pytrace=False)
    yield made
    made.close()
