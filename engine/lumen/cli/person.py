"""Who sits at this terminal."""

import getpass
import platform


def person() -> str:
    """`ada on stand`: the user's name and the machine's."""
    try:
        user = getpass.getuser()
    except (OSError, KeyError):  # a user that the system has no name for
        user = "an unknown user"
    return f"{user} on {platform.node() or 'a terminal'}"
