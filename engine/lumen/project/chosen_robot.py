"""One robot of several, chosen for one exhibition.

The choice stands among the files that are read, under a name that no file has: what is built still depends on the files
alone. It is no part of their hash: the robots of a house have the same files.
"""

from collections.abc import Mapping

CHOSEN_ROBOT = ".robot"


def as_robot(files: Mapping[str, bytes], robot: str) -> dict[str, bytes]:
    """The files as that robot reads them; as they are where the name is empty."""
    return {**files, CHOSEN_ROBOT: robot.encode()} if robot else dict(files)


def chosen_robot(files: Mapping[str, bytes]) -> str:
    """The robot that these files are read as; empty for the first."""
    return files.get(CHOSEN_ROBOT, b"").decode("utf-8", "replace").strip()
