"""Who may do what: roles, from nobody to author."""

from enum import IntEnum
from typing import NamedTuple


class Role(IntEnum):
    """What somebody may: `NOBODY` let a robot rest, `SHOW` break nothing, `OPERATOR` steer, `AUTHOR` everything."""

    NOBODY = 0
    SHOW = 1
    OPERATOR = 2
    AUTHOR = 3

    @property
    def word(self) -> str:
        return self.name.lower()


class Person(NamedTuple):
    """Somebody at a page: a role, and the name that they gave, if any."""

    role: Role
    name: str = ""

    @property
    def by(self) -> str:
        """As what they stand in journals."""
        return self.name or (self.role.word if self.role else "a person at the console")


ROLES = {role.word: role for role in Role}
