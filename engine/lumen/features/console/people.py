"""Roles and their rights, from `nobody` to `author`."""

from enum import IntEnum
from typing import NamedTuple


class Role(IntEnum):
    """The rights of a person, in ascending order: each role may do all that the lower ones may."""

    NOBODY = 0
    """A person without a PIN may make a robot rest."""
    SHOW = 1
    """Look, set marks, approve, and press the buttons that the behaviour offers."""
    OPERATOR = 2
    """Control the robot and the behaviour."""
    AUTHOR = 3
    """Change the files, too."""

    @property
    def word(self) -> str:
        return self.name.lower()


class Person(NamedTuple):
    """A person at a page: a role, and the name given at sign-in, if any."""

    role: Role
    name: str = ""

    @property
    def by(self) -> str:
        """The name of the person in journals: their own, else that of the role."""
        return self.name or (self.role.word if self.role else "a person at the console")


ROLES = {role.word: role for role in Role}
