"""A process that answers questions under limits: `JudgeProcess` in the parent asks, `answering` in the child answers.

Both are Lumen's own programs, connected by private pipes. A message is a length and a pickled value.
"""

import os
import pickle
import signal
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from enum import Enum
from typing import IO, Any

MAX_MEMORY = 1 << 30
"""The memory limit of a process [bytes]; a behaviour of ten thousand states needs a third."""
ANSWER_TIMEOUT = 60.0
"""The time limit for judging the files of a project [s]."""
NICENESS = 5
"""The `nice` value of a process under limits, which lets other processes, above all the robot's, run first."""
OUT_OF_MEMORY = 77
"""The exit code of a process that was refused more memory."""
_LENGTH = struct.Struct(">Q")


class Fault(Enum):
    """The reasons why there is no answer."""

    LATE = "it took too long"
    MEMORY = "it was refused more memory"
    SIZE = "its answer is too large"
    ENDED = "it ended"


class NoAnswerError(Exception):
    """Raised if the process gave no answer and has ended; `code` is its exit code, negative for a signal."""

    def __init__(self, fault: Fault, code: int) -> None:
        super().__init__(fault.value)
        self.fault, self.code = fault, code

    @property
    def signal(self) -> str:
        """The name of the signal that ended the process; empty if none did."""
        with suppress(ValueError):
            return signal.Signals(-self.code).name
        return ""


class _SizeError(Exception):
    """A message is larger than its reader allows."""


class JudgeProcess:
    """A process that runs `command` and answers one question at a time; it can be started again after its end.

    `max_answer` is the maximum size of an answer [bytes], None for no limit. `end` may be called on any thread: an open
    `request` then raises NoAnswerError.
    """

    def __init__(self, command: Sequence[str], max_answer: int | None = None) -> None:
        self.command, self._max_answer = tuple(command), max_answer
        self._child: subprocess.Popen[bytes] | None = None
        self._asking, self._sending = threading.RLock(), threading.Lock()

    @property
    def started(self) -> bool:
        """True if the process was started and its end has not been noticed since."""
        return self._child is not None

    @property
    def alive(self) -> bool:
        """True if the process is running."""
        child = self._child
        return child is not None and child.poll() is None

    def start(self) -> None:
        """Start the process unless it is running. Raises OSError if the system refuses."""
        if self.alive:
            return
        self.end()
        self._child = subprocess.Popen(
            self.command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # so that Ctrl-C does not reach it
        )

    def request(self, question: Any, timeout: float = threading.TIMEOUT_MAX) -> Any:
        """Return the answer, or raise it if it is an exception.

        Raises NoAnswerError if the process was not started, ends without an answer, or is killed after `timeout` [s].
        """
        with self._asking:
            if (child := self._child) is None:
                raise NoAnswerError(Fault.ENDED, 0)
            began, timer = time.monotonic(), threading.Timer(timeout, child.kill)
            timer.start()
            try:
                self._send(child, question)
                answer = self._received(child)
            except (OSError, EOFError, pickle.UnpicklingError, _SizeError) as error:
                self._end(child)
                late = time.monotonic() - began >= timeout
                raise NoAnswerError(_fault(error, child.returncode, late=late), child.returncode) from None
            except BaseException:  # a late answer would be mistaken for that to the next question
                self._end(child)
                raise
            finally:
                timer.cancel()
        if isinstance(answer, Exception):
            raise answer
        return answer

    def send(self, message: Any) -> None:
        """Send a message that has no answer.

        If the process has ended, the message is lost, and the next request fails.
        """
        if child := self._child:
            self._send(child, message)

    def end(self) -> None:
        """End the process at once, if it was started."""
        if child := self._child:
            self._end(child)

    def _send(self, child: "subprocess.Popen[bytes]", message: Any) -> None:
        data = _packed(message)
        assert child.stdin
        with self._sending, suppress(OSError):
            if self._child is child:
                child.stdin.write(data)
                child.stdin.flush()

    def _received(self, child: "subprocess.Popen[bytes]") -> Any:
        assert child.stdout
        try:
            return receive(child.stdout, self._max_answer)
        except EOFError:
            child.wait()  # its pipe is closed before it has an exit code
            raise

    def _end(self, child: "subprocess.Popen[bytes]") -> None:
        if self._child is child:
            self._child = None
        child.kill()
        child.wait()
        with self._asking, self._sending:  # wait until all readers and writers have noticed the end
            for pipe in (child.stdin, child.stdout):
                assert pipe
                with suppress(OSError):  # what the process did not read
                    pipe.close()


class AnswerPipe:
    """The child's end: iterates over the questions of a `JudgeProcess`, and sends the answers."""

    def __init__(self, questions: IO[bytes], answers: IO[bytes]) -> None:
        self._questions, self._answers = questions, answers

    def __iter__(self) -> Iterator[Any]:
        while True:
            yield self.receive()

    def receive(self) -> Any:
        """Return the next question. Raises EOFError after the last."""
        return receive(self._questions)

    def send(self, answer: Any) -> None:
        """Send an answer."""
        self._answers.write(_packed(answer))
        self._answers.flush()

    def answer(self, judge: Callable[[], Any], seconds: float = 0.0) -> None:
        """Send the return value or the exception of `judge`; a MemoryError is raised instead.

        The system ends the process if `judge` runs longer than `seconds` [s]; 0 sets no limit.
        """
        limit_time(seconds)
        answer: Any
        try:
            answer = judge()
        except MemoryError:
            raise
        except Exception as error:  # an internal error fails only this answer
            answer = error
        self.send(answer)
        limit_time(0.0)


@contextmanager
def answering(max_memory: int | None = None) -> Iterator[AnswerPipe]:
    """Yield the pipe to the parent; the block ends when the parent closes it.

    The process may use at most `max_memory` [bytes], and exits with OUT_OF_MEMORY if it needs more; None for no limit.
    With a limit, it also runs with the priority NICENESS.
    Prints go to standard error.
    """
    if max_memory is not None:
        if hasattr(os, "nice"):
            os.setpriority(os.PRIO_PROCESS, 0, NICENESS)
        _limit_memory(max_memory)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    try:
        yield AnswerPipe(sys.stdin.buffer, answers)
    except (EOFError, BrokenPipeError):
        return
    except MemoryError:
        os._exit(OUT_OF_MEMORY)


def limit_time(seconds: float) -> None:
    """Let the system end this process after `seconds` [s], even if its parent is gone; 0 removes the limit.

    On Windows, there is no limit.
    """
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, seconds)


def _packed(message: Any) -> bytes:
    data = pickle.dumps(message, pickle.HIGHEST_PROTOCOL)
    return _LENGTH.pack(len(data)) + data


def receive(pipe: IO[bytes], most: int | None = None) -> Any:
    """Return the next message. Raises EOFError at the end, and _SizeError if the message has more than `most` bytes."""
    head = pipe.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        raise EOFError
    (length,) = _LENGTH.unpack(head)
    if most is not None and length > most:
        raise _SizeError
    return pickle.loads(pipe.read(length))


def _limit_memory(most: int) -> None:
    with suppress(ImportError, OSError, ValueError):  # not on every system, and a lower limit can't be raised
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _fault(error: Exception, code: int, *, late: bool) -> Fault:
    if isinstance(error, _SizeError):
        return Fault.SIZE
    if late:
        return Fault.LATE
    return Fault.MEMORY if code == OUT_OF_MEMORY else Fault.ENDED
