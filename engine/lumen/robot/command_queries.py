"""Queries about commands, and about a robot that a person stopped, which need no part of the body."""

import logging
from collections.abc import Callable
from typing import Any

from lumen.language.causes import UNNAMED_PROGRAM
from lumen.ports import Message, Robot
from lumen.robot.command_codec import method_of, own_id
from lumen.robot.command_parameters import shown
from lumen.robot.command_reports import CANCELLED, UNKNOWN_COMMAND, CommandRecord, CommandReports
from lumen.robot.person_hold import PersonHold

_log = logging.getLogger(__name__)


class CommandQueries:
    """Answers the queries `cancel`, `outcome`, `stopped` and `resume` with `reply`.

    `resume` is called with the person who lets the robot move again.
    """

    METHODS = ("cancel", "outcome", "stopped", "resume")

    def __init__(
        self,
        robot: Robot,
        reports: CommandReports,
        hold: PersonHold,
        reply: Callable[[Message, Any], None],
        resume: Callable[[str], None],
    ) -> None:
        self._robot, self._reports, self._hold, self._reply, self._resume = robot, reports, hold, reply, resume

    def answer(self, message: Message) -> None:
        """Answer a message whose method is one of `METHODS`."""
        match method_of(message.body):
            case "resume":
                self._let_go_on(message)
            case "stopped":
                stopped = self._hold.stopped
                since = stopped.since.isoformat(timespec="seconds") if stopped else ""
                self._reply(message, {"stopped_by": stopped.by if stopped else "", "since": since})
            case method:
                self._request(message, method)

    def _let_go_on(self, message: Message) -> None:
        """Let the robot move again on behalf of the person in `by`, and reply."""
        parameter = message.body.get("parameter")
        by = parameter.get("by") if isinstance(parameter, dict) else None
        self._resume(shown(by) if isinstance(by, str) and by else UNNAMED_PROGRAM)
        self._reply(message, "command finished")

    def _request(self, message: Message, method: str) -> None:
        """Answer `cancel` or `outcome` for the command with the `id` in the parameter.

        A command that is cancelled before it is known counts as cancelled afterwards, because it may still arrive.
        """
        id = own_id(message.body.get("parameter"))
        if not id:
            _log.warning("a command was refused: `%s` needs the `id` of a command", method)
            self._reply(message, "command failed: pass the `id` of the command")
            return
        record = self._reports.asked(id, message.sender)
        cancelled = method == "cancel"
        if record is None:
            record = CommandRecord(message, id, state=CANCELLED if cancelled else UNKNOWN_COMMAND)
            if cancelled:
                self._reports.remember(record, None)
        elif cancelled and not record.over:
            self._robot.cancel(record.at)
        self._reports.repeat(record, message)
