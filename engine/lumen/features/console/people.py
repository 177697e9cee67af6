"""Roles and their rights, from `nobody` to `author`."""

from enum import IntEnum
from typing import NamedTuple


class Role(IntEnum):
    """The roles of people in ascending order; each includes the rights of the lower ones."""

    NOBODY = 0
    """Make a robot rest, which needs no PIN."""
    SHOW = 1
    """Look, set marks, approve, and press the buttons that the behaviour offers."""
    OPERATOR = 2
    """Control the robot and the behaviour."""
    AUTHOR = 3
    """Change the files."""

    @property
    def word(self) -> str:
        return self.name.lower()


class Person(NamedTuple):
    """A person at a page: a role, and the name given at sign-in, if any."""

    role: Role
    name: str = ""

    @property
    def by(self) -> str:
        """The person's name in journals, else the role's word; for `NOBODY` "a person at the console"."""
        return self.name or (self.role.word if self.role else "a person at the console")


ROLES = {role.word: role for role in Role}
