"""The limits and speeds of a body's joints, which each robot applies to all its commands, whoever sent them."""

import logging
from collections.abc import Mapping
from typing import overload

from lumen.errors import BadCommandError
from lumen.language.commands import Do
from lumen.language.robots import Body
from lumen.motion.bounds import NOWHERE, aim_within, within_limits
from lumen.ports import Aim, NativeCommand, RobotCommand
from lumen.robot.command_table import check_command
from lumen.upkeep.ratelimit import OnceLog

_log = logging.getLogger(__name__)


class CommandBounds:
    """Brings commands within the limits and speeds of a body; refuses those that no robot of that body can perform.

    Each change of a command is logged once, except for aims: a stream of them would fill the log.
    """

    def __init__(self, body: Body) -> None:
        self._body = body
        self._log_of_changes = OnceLog(_log)

    @overload
    def fit(self, command: NativeCommand) -> NativeCommand: ...

    @overload
    def fit(self, command: RobotCommand) -> RobotCommand: ...

    def fit(self, command: RobotCommand) -> RobotCommand:
        """Return the nearest command that the body can perform. Raises BadCommandError if there is no such command."""
        check_command(command, self._body)
        if isinstance(command, Do):
            return command
        bounded = within_limits(command, self._body)
        self._log_of_changes(bounded.changes)
        return bounded.command

    def aim(self, aim: Aim, here: Mapping[str, float] = NOWHERE) -> Aim | None:
        """Return the nearest aim that the body can perform from `here` [rad], the joints' angles that are known.

        Log a warning and return None if the body can't perform any such aim.
        """
        try:
            check_command(aim, self._body)
        except BadCommandError as error:
            _log.warning("an aim was refused: %s", error)
            return None
        return aim_within(aim, self._body, here)
