"""What comes of asking whether a running behaviour can go on under other files."""

from typing import NamedTuple

from lumen.language.commands import Command
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.statechart import Snapshot


class MigrationPlan(NamedTuple):
    """How a behaviour goes on: `snapshot` under the new files, and what has to be done for that.

    Perform `leaving` under the old bundle (exit actions and cancels, in the order of exit), then `entering` under the
    new one. `exited` are names of old states, `entered` of new ones, as in a Step; both are empty where every active
    state goes on. `notes` are sentences about what somebody could miss: where the behaviour went, what it
    has forgotten. `sent` is what an invoked behaviour sends meanwhile to the one that invoked it.
    """

    snapshot: Snapshot
    leaving: tuple[Command, ...] = ()
    entering: tuple[Command, ...] = ()
    exited: tuple[str, ...] = ()
    entered: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    sent: tuple[Event, ...] = ()

    @property
    def commands(self) -> tuple[Command, ...]:
        """Everything to be performed, in order."""
        return self.leaving + self.entering


class MigrationDelay(NamedTuple):
    """Not yet: `what` names the state whose `do` (or invoked behaviour) is under way and gone or changed.

    Ask again when the behaviour has taken a step, or with `now`, which cancels what is under way.
    """

    reason: str
    what: str


class Refusal(NamedTuple):
    """Not from here: `reason` says why, `hint` what would be right.

    `where` is the place in the *new* `behaviors/BEHAVIOR.yaml` where it could be said; `state` the name of the active
    state that is gone.
    """

    reason: str
    hint: str = ""
    state: str = ""
    behavior: str = ""
    where: NodePath = ()


MigrationVerdict = MigrationPlan | MigrationDelay | Refusal
