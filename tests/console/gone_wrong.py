"""A job of the console that goes wrong, in the way it is called: stands in for `lumen.console.job`."""

import os
import signal
import sys

from lumen.console.job_promises import OUT_OF_MEMORY, REFUSED

match sys.argv[1]:
    case "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    case "refused":
        sys.stdout.write("there is no such file")
        sys.exit(REFUSED)
    case "too large":
        sys.exit(OUT_OF_MEMORY)
    case "slow":
        sys.stdin.read()
        signal.pause()
    case "poses":
        sys.stdin.readline()
        sys.exit(1)
    case _:
        sys.stdout.write(sys.stdin.read())
