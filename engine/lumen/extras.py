"""Optional packages: which extra of pyproject.toml installs them."""

import sys
from importlib.util import find_spec

from lumen.errors import UsageError

INSTALL_BARE = "pip install --no-deps 'dm-control>=1.0.50,<2'"
"""For a Python on which the dependencies of dm-control can't be installed (docs/installing.md)."""


class MissingExtraError(UsageError):
    """A feature needs packages that are not installed; the message has the command that installs them."""


def demand(extra: str, what: str, *modules: str, instead: str = "") -> None:
    """Raise MissingExtraError if a module that `what` needs, and `extra` installs, is missing.

    `instead` is what works without these modules. This function imports none of them.
    """
    missing = [module for module in modules if not _is_installed(module)]
    if not missing:
        return
    bare = "dm_control" in missing and sys.version_info >= (3, 13)
    commands = [f"pip install 'lumen-robot[{extra}]'"] if missing != ["dm_control"] or not bare else []
    command = " and ".join([*commands, *[INSTALL_BARE] * bare])
    raise MissingExtraError(f"{what} needs {', '.join(missing)}: {command}{f' ({instead})' if instead else ''}")


def _is_installed(module: str) -> bool:
    try:
        return find_spec(module) is not None
    except ValueError:  # a program has put None, or a module without a spec, into sys.modules
        return sys.modules.get(module) is not None
