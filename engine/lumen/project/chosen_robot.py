"""Choose one robot of several for one exhibition.

The choice is one of the project's files, under a name that no real file has, so the result still depends on the files
alone. It is left out of their hash, because all robots of a house have the same files.
"""

from collections.abc import Mapping

CHOSEN_ROBOT = ".robot"


def as_robot(files: Mapping[str, bytes], robot: str) -> dict[str, bytes]:
    """Return the files with the choice of `robot` added; unchanged if the name is empty."""
    return {**files, CHOSEN_ROBOT: robot.encode()} if robot else dict(files)


def chosen_robot(files: Mapping[str, bytes]) -> str:
    """Return the name of the robot for which these files are read; empty for the first robot."""
    return files.get(CHOSEN_ROBOT, b"").decode("utf-8", "replace").strip()
