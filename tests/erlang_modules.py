"""Links the modules of the tests' RabbitMQ into few folders, since Erlang looks for each module in every folder.

With the installed folders, a start looks for 43,000 files that do not exist, which costs a third of its
processor time.
"""

import re
from collections.abc import Sequence
from pathlib import Path

NEEDLESS = re.compile(
    r"rabbitmq_(?!prelaunch|mqtt)|(accept|amqp10_client|base64url|cow|eetcd|enough|gun|jose|prometheus|quantile)"
)
"""Plugins that no broker here enables, and the dependencies that only those need."""
NEEDED = ("amqp10_client",)
"""The plugins that rabbitmq_shovel needs."""


def link_modules(folder: Path, erlang: Path, rabbitmq: Path, plugins: Sequence[str] = ()) -> None:
    """Link the plugins that may be enabled into `links` in the folder, and all modules into `modules`, once.

    `erlang` and `rabbitmq` are their installation folders; `plugins` are enabled too, with their dependencies.
    """
    links, modules = folder / "links", folder / "modules"
    if modules.exists():
        return
    links.mkdir()
    modules.mkdir()
    for plugin in (rabbitmq / "plugins").iterdir():
        wanted = (*plugins, *(NEEDED if plugins else ()))
        if not NEEDLESS.match(plugin.name) or plugin.name.rpartition("-")[0] in wanted:
            (links / plugin.name).symlink_to(plugin)
    for module in (*links.glob("*/ebin/*.beam"), *erlang.glob("lib/*/ebin/*.beam")):
        (modules / module.name).symlink_to(module)
