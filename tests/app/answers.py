"""The child process of a `JudgeProcess`: it answers, or fails in the way that the question names."""

import os
import signal
import sys
from functools import partial

from lumen.upkeep.judge_process import answering


def judged(question: str) -> object:
    match question:
        case "a fault":
            return 1 // 0
        case "an end":
            sys.exit(3)
        case "a signal":
            os.kill(os.getpid(), signal.SIGKILL)
        case "no memory":
            raise MemoryError
        case "silence":
            signal.pause()
        case "much":
            return b"." * 10_000
        case "the end of the pipe":
            os.closerange(3, 100)
            sum(range(10**6))
            os._exit(3)
    sys.stdout.write("printed\n")
    sys.stdout.flush()
    return question


with answering() as pipe:
    for question in pipe:
        pipe.answer(partial(judged, question))
