"""`lumen console`: pages in a browser for the people who run an exhibition."""

import argparse
from functools import partial

from lumen.app.reaching import reach_exhibition
from lumen.cli.reach import configure_reach
from lumen.extras import demand
from lumen.loading.packaged import find_project

PORT = 8080


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)
    parser.add_argument("--port", type=int, default=PORT, metavar="PORT", help=f"where it listens (default: {PORT})")
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="HOST",
        help="at which address (default: 127.0.0.1, this machine only)",
    )


def run(options: argparse.Namespace) -> int:
    """0 once it was ended. It goes on without the exhibition, and with the next one."""
    demand("console", "`lumen console`", "starlette", "uvicorn")
    from lumen.console.serving import Console

    root, reach = find_project(options.project), partial(reach_exhibition, options.project, options.bus)
    console = Console(reach, root, options.host, options.port)
    print(f"The console is at {console.address} (Ctrl-C ends it)", flush=True)
    console.run()
    return 0
