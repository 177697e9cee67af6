"""Where Erlang finds what a RabbitMQ of the tests is made of: in few folders, since each module is looked for in all.

With the folders as they are installed a start looks into 43,000 files that are not there, which takes a third of its
processor time.
"""

import re
from pathlib import Path

NEEDLESS = re.compile(
    r"rabbitmq_(?!prelaunch|mqtt)|(accept|amqp10_client|base64url|cow|eetcd|enough|gun|jose|prometheus|quantile)"
)
"""Plugins that no broker here enables, and what only those need."""


def link_modules(folder: Path, erlang: Path, rabbitmq: Path) -> None:
    """Fill `links` in the folder with the plugins that may be enabled, and `modules` with the modules of all there is.

    `erlang` and `rabbitmq` are where these two are installed.
    """
    links, modules = folder / "links", folder / "modules"
    if modules.exists():
        return
    links.mkdir()
    modules.mkdir()
    for plugin in (rabbitmq / "plugins").iterdir():
        if not NEEDLESS.match(plugin.name):
            (links / plugin.name).symlink_to(plugin)
    for module in (*links.glob("*/ebin/*.beam"), *erlang.glob("lib/*/ebin/*.beam")):
        (modules / module.name).symlink_to(module)
