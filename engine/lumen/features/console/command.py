"""`lumen console`: pages in a browser for the people who run an exhibition."""

import argparse
import os
import sys
from collections.abc import Callable
from functools import partial

from lumen.cli.reach import configure_reach
from lumen.extras import demand
from lumen.features.console.settings import CONSOLE_HOST, CONSOLE_PORT, ConsoleSettings
from lumen.project.main_file import main_settings
from lumen.project.running_project import project_to_run
from lumen.run.reaching import reach_exhibition
from lumen.upkeep.heap import give_back
from lumen.upkeep.threads import WatchedThread


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)
    add = parser.add_argument
    add(
        "--port",
        type=int,
        metavar="PORT",
        help=f"the port to listen on (default: the one in lumen.yaml, else {CONSOLE_PORT})",
    )
    add(
        "--host",
        metavar="HOST",
        help=f"the address to listen on (default: the one in lumen.yaml, else {CONSOLE_HOST})",
    )
    add("--beside", action="store_true", help=argparse.SUPPRESS)


def run(options: argparse.Namespace) -> int:
    """Serve the console until a signal ends it or, with `--beside`, its parent process ends; return 0.

    The console outlives an exhibition, and connects to the next one.
    """
    demand("console", "`lumen console`", "starlette", "uvicorn")
    give_back()
    from lumen.features.console.access import pins_from
    from lumen.features.console.serving import Console

    root, reach = project_to_run(options.project), partial(reach_exhibition, options.project, options.bus)
    found = main_settings(root)
    said = found.section(ConsoleSettings) if found else ConsoleSettings()
    port = said.port if options.port is None else options.port
    pins, host = pins_from(said.pins, os.environ), options.host or said.host
    console = Console(reach, root, host, port, pins=pins, hosts=said.hosts, proxies=said.proxies)
    if options.beside:
        WatchedThread("lumen-console-parent", lambda: _end_with_parent(console.end)).start()
    print(f"The console is at {console.address} (Ctrl-C ends it)", flush=True)
    console.run()
    return 0


def _end_with_parent(end: Callable[[], None]) -> None:
    """Call `end` after standard input closes, which happens when the parent process ends."""
    while sys.stdin.buffer.read(1024):
        pass
    end()
