"""What somebody is told who has a broker checked."""

from typing import NamedTuple


class BrokerFinding(NamedTuple):
    """What was looked at, what is wrong with it (empty where nothing is), and what is to be known of it.

    `mend` is the command that puts it right, where one does.
    """

    what: str
    wrong: str = ""
    note: str = ""
    mend: str = ""
