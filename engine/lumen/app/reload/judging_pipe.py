"""What the two ends of the pipe to the judging process have to agree on: neither needs to import the other."""

import pickle
import struct
from typing import IO, Any

MAX_MEMORY = 1 << 30
"""How much the process may take [bytes]; a behaviour of ten thousand states takes a third. Linux keeps to it."""
ANSWER_TIMEOUT = 60.0
"""How long one question may take [s]."""
OUT_OF_MEMORY = 77
"""The exit code of a process that was refused more memory."""
_LENGTH = struct.Struct(">Q")


def send(pipe: IO[bytes], what: Any) -> None:
    data = pickle.dumps(what, pickle.HIGHEST_PROTOCOL)
    pipe.write(_LENGTH.pack(len(data)) + data)
    pipe.flush()


def receive(pipe: IO[bytes]) -> Any:
    """What comes next; raises EOFError at the end."""
    head = pipe.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        raise EOFError
    return pickle.loads(pipe.read(*_LENGTH.unpack(head)))
