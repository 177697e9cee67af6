"""The name of the person at this terminal."""

import getpass
import platform


def person() -> str:
    """Return the user's name and the machine's, such as `ada on stand`."""
    try:
        user = getpass.getuser()
    except (OSError, KeyError):  # the system has no name for this user
        user = "an unknown user"
    return f"{user} on {platform.node() or 'a terminal'}"
