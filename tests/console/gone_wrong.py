"""A job of the console that goes wrong, in the way it is called: stands in for `lumen.features.console.job`."""

import os
import signal
import sys

from lumen.errors import LumenError
from lumen.upkeep.judge_process import OUT_OF_MEMORY, answering

with answering() as pipe:
    match sys.argv[1]:
        case "killed":
            os.kill(os.getpid(), signal.SIGKILL)
        case "refused":
            pipe.send(LumenError("there is no such file"))
        case "too large":
            sys.exit(OUT_OF_MEMORY)
        case "slow":
            signal.pause()
        case "poses":
            pipe.receive()
            sys.exit(1)
        case _:
            pipe.send(b"".join(iter(pipe.receive, None)))
