"""The results of a migration: a plan, a delay or a refusal."""

from typing import NamedTuple

from lumen.language.commands import Command
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.statechart import Snapshot


class MigrationPlan(NamedTuple):
    """The continuation of a behaviour under the new files.

    Perform `leaving` under the old bundle, then `entering` under the new one.
    """

    snapshot: Snapshot
    """The snapshot under the new files."""
    leaving: tuple[Command, ...] = ()
    """Exit actions and cancels under the old bundle, in the order of exit."""
    entering: tuple[Command, ...] = ()
    """Commands under the new bundle."""
    exited: tuple[str, ...] = ()
    """The names of old states that were left; empty, as is `entered`, if every active state continues."""
    entered: tuple[str, ...] = ()
    """The names of new states that were entered."""
    notes: tuple[str, ...] = ()
    """Sentences about changes that an operator might miss: the new state, or forgotten values."""
    sent: tuple[Event, ...] = ()
    """Events that an invoked behaviour sends to its host during the migration."""

    @property
    def commands(self) -> tuple[Command, ...]:
        """All commands to be performed, in order."""
        return self.leaving + self.entering


class MigrationDelay(NamedTuple):
    """A delay: the `do` of a state, or an invoked behaviour, is still running and was changed or removed.

    Try again after the next step, or with `now`, which cancels the `do` or the behaviour.
    """

    reason: str
    what: str


class Refusal(NamedTuple):
    """A refusal: the behaviour can't continue under the new files."""

    reason: str
    """Why the behaviour can't continue."""
    hint: str = ""
    """A hint on how to fix the files."""
    state: str = ""
    """The name of the active state that was removed or has ended; empty for any other reason."""
    behavior: str = ""
    """The name of the new behaviour's file."""
    where: NodePath = ()
    """The place in the new `behaviors/BEHAVIOR.yaml` that could be changed."""


MigrationVerdict = MigrationPlan | MigrationDelay | Refusal
