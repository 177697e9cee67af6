"""A job of the console that fails as its argument says, in place of `lumen.features.console.job`."""

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
