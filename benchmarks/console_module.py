"""A module on the bus of a running exhibition, for console_pages.py: `python console_module.py FOLDER PATTERN …`.

Sends each line of its input, `{"key": …, "body": …}`, and prints `{"sent": …}`; prints `{"arrived": …, "key": …}` for
each message that matches a pattern. Times are in seconds since 1970. It is a program of its own, since it needs the
engine of the checkout that is measured.
"""

import json
import sys
import threading
import time
from importlib import import_module
from importlib.util import find_spec

# Before the folder `run`, this module was in `app`.
REACHING = "lumen.run.reaching" if find_spec("lumen.run") else "lumen.app.reaching"

_turn = threading.Lock()


def report(**fields: object) -> None:
    """Print one line; handlers of the bus call this on threads of the bus."""
    with _turn:
        print(json.dumps(fields), flush=True)


def main() -> None:
    folder, *patterns = sys.argv[1:]
    bus = import_module(REACHING).reach_exhibition(folder, None).bus
    for pattern in patterns:
        bus.subscribe(pattern, lambda message: report(arrived=time.time(), key=message.key))
    report(ready=time.time())
    for line in sys.stdin:
        message = json.loads(line)
        sent = time.time()
        bus.publish(message["key"], message["body"])
        report(sent=sent)


if __name__ == "__main__":
    main()
