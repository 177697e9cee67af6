"""The connection to NAOqi, with calls that return immediately, and waiting calls for separate threads."""

import re
import threading
from collections.abc import Callable, Iterable
from typing import Any

from lumen.errors import RobotError, RobotFailedError, RobotLostError, RobotUnreachableError
from lumen.upkeep.threads import WatchedThread

NAOQI_PORT = 9559
CALL_TIMEOUT = 2.0
"""The time limit of a waiting call [s]; a robot that does not answer in that time counts as lost."""
CONNECT_TIMEOUT = 5.0
MAX_ERROR_LENGTH = 200

QI_MISSING = (
    "a NAO needs the package `qi`: pip install 'lumen-robot[naoqi]'"
    " (there are wheels for CPython up to 3.12 on Linux, x86-64)"
)

CONNECTION_LOST = "the connection to the robot is lost"
_QI_CONNECTION_LOST = ("Service removed", "Socket is not connected", "Socket disconnected", "Session closed")
"""qi's messages for a lost connection."""

_SCHEME = re.compile(r"^[a-z]+://")


def qi() -> Any:
    """Return the package `qi`, with its logging limited to fatal errors.

    Raises RobotUnreachableError, with installation instructions, if the package is missing.
    """
    try:
        import qi as package
    except ImportError as error:
        raise RobotUnreachableError(QI_MISSING) from error
    package.logging.setLevel(package.logging.FATAL)
    return package


def address(url: str) -> str:
    """Return the complete address: `nao.local` becomes `tcp://nao.local:9559`. Raises RobotError if it is invalid."""
    text = url.strip()
    whole = text if _SCHEME.match(text) else f"tcp://{text}"
    host, colon, port = whole.partition("://")[2].rpartition(":")
    if not colon:
        host, port, whole = port, str(NAOQI_PORT), f"{whole}:{NAOQI_PORT}"
    if not host or not port.isdecimal() or not whole.startswith(("tcp://", "tcps://")):
        raise RobotUnreachableError(f"`{url}` is not the address of a robot: write tcp://nao.local:{NAOQI_PORT}")
    return whole


def plain(error: object) -> str:
    """Return NAOqi's error message as a single line, without the location in NAOqi's code.

    Return `CONNECTION_LOST` for qi's messages about a lost connection.
    """
    text = " ".join(str(error).partition("\n\nAt:")[0].split())
    if text in _QI_CONNECTION_LOST:
        return CONNECTION_LOST
    return text.removeprefix("RuntimeError: ")[:MAX_ERROR_LENGTH] or "it gave no reason"


def _refused(what: str, error: object) -> str:
    """Return why NAOqi refused something, `what` in words; `CONNECTION_LOST` if the connection is lost."""
    return reason if (reason := plain(error)) == CONNECTION_LOST else f"{what}: {reason}"


def _error_of(reason: str) -> RobotError:
    """Return the error for a failed call: RobotLostError if the connection is lost, else RobotFailedError."""
    return RobotLostError(reason) if reason == CONNECTION_LOST else RobotFailedError(reason)


class NaoqiCall:
    """A call in progress or ended; `result` raises RobotError if NAOqi raised an error or the connection is lost."""

    def __init__(self, future: Any = None, value: Any = None, error: str = "") -> None:
        self._future, self._value, self._error = future, value, error

    @property
    def done(self) -> bool:
        """Whether the call has ended."""
        return self._future is None or bool(self._future.isFinished())

    @property
    def failed(self) -> bool:
        """Whether the call has ended with an error."""
        return bool(self._error) or (self._future is not None and self.done and bool(self._future.hasError()))

    def wait(self, seconds: float) -> bool:
        """Wait for the call for at most `seconds`; return whether it has ended."""
        if self._future is not None:
            self._future.wait(int(1000 * seconds))
        return self.done

    def result(self) -> Any:
        """Return the call's value, after waiting for the call to end. Raises RobotError if the call failed."""
        if self._error:
            raise _error_of(self._error)
        if self._future is None:
            return self._value
        if self._future.hasError():
            raise _error_of(plain(self._future.error()))
        return self._future.value()


class NaoqiSession:
    """A session with NAOqi at `url`, which can be reopened after a lost connection.

    `ready` is True while the session is connected and the robot prepared; `pending` is the number of calls in progress.
    `lost` is called with the reason each time the connection breaks, on any thread. If NAOqi does not answer a waiting
    call within `patience` [s], the connection counts as lost.
    """

    def __init__(self, url: str, lost: Callable[[str], None] = lambda _: None, patience: float = CALL_TIMEOUT) -> None:
        self.url, self._patience = address(url), patience
        self.pending = 0
        self.ready = False
        self._lost, self._qi = lost, qi()
        self._session: Any = None
        self._services: dict[str, Any] = {}
        self._serving: dict[str, NaoqiCall] = {}
        self._lock = threading.Lock()

    @property
    def up(self) -> bool:
        """Whether the session is connected."""
        return self._session is not None

    def open(self) -> None:
        """Connect. Raises RobotUnreachableError if no robot answers."""
        session = self._qi.Session()
        future = session.connect(self.url, _async=True)
        future.wait(int(1000 * max(CONNECT_TIMEOUT, self._patience)))
        if not future.isFinished():
            raise RobotUnreachableError(
                f"no robot answers at {self.url}: check that it is switched on and on this network"
            )
        if future.hasError():
            raise RobotUnreachableError(
                f"no robot at {self.url} ({plain(future.error())}): check that it is switched on and on this network"
            )
        session.disconnected.connect(lambda *_: self._broken(session, "the connection was closed"))
        self._services, self._serving = {}, {}
        self._session = session

    def find(self, names: Iterable[str]) -> list[str]:
        """Look up these services for later calls; return the names of missing services.

        Raises RobotLostError if the connection breaks.
        """
        missing = []
        for name in names:
            future = self._opened().service(name, _async=True)
            future.wait(int(1000 * max(CONNECT_TIMEOUT, self._patience)))
            if not future.isFinished() or future.hasError():
                missing.append(name)
            else:
                self._services[name] = future.value()
        self._opened()
        return missing

    def has(self, service: str) -> bool:
        """Return whether the robot is connected and has that service."""
        return self.up and service in self._services

    def post(self, service: str, method: str, *arguments: Any) -> NaoqiCall:
        """Call a method without waiting; errors are raised by the call's `result`."""
        proxy = self._services.get(service)
        if not self.up:
            return NaoqiCall(error=CONNECTION_LOST)
        if proxy is None:
            return NaoqiCall(error=f"this robot has no {service}")
        try:
            future = getattr(proxy, method)(*arguments, _async=True)
        except (AttributeError, RuntimeError) as error:
            return NaoqiCall(error=_refused(f"{service}.{method} cannot be called", error))
        return self._called(future)

    def serve(self, name: str, make: Callable[[Any], object]) -> NaoqiCall:
        """Register the service `name`, which `make` builds with the package `qi`, unless this session has it."""
        if not self.up:
            return NaoqiCall(error=CONNECTION_LOST)
        if name not in self._serving or self._serving[name].failed:
            future = self._session.registerService(name, make(self._qi), _async=True)
            self._serving[name] = self._called(future)
        return self._serving[name]

    def request(self, service: str, method: str, *arguments: Any, patience: float = 0.0) -> Any:
        """Call a method, wait for NAOqi's answer and return it. Only for threads that may wait.

        The maximum wait is `patience` [s], but at least the session's patience. Raises RobotError if the call fails;
        without an answer in that time, the connection counts as lost.
        """
        call, session, patience = self.post(service, method, *arguments), self._session, max(patience, self._patience)
        if not call.wait(patience):
            reason = f"the robot has not answered for {patience:g} s"
            self._broken(session, reason)
            raise RobotLostError(reason)
        return call.result()

    def subscribe(self, event: str, heard: Callable[[Any], None]) -> Any:
        """Call `heard` on qi's thread with the event's value each time ALMemory raises the event.

        The subscription ends when the returned object is released. Raises RobotError if ALMemory can't subscribe.
        """
        subscriber = self.request("ALMemory", "subscriber", event)
        try:
            subscriber.signal.connect(heard)
        except (AttributeError, RuntimeError) as error:
            raise _error_of(_refused(f"`{event}` cannot be subscribed to", error)) from error
        return subscriber

    def close(self) -> None:
        """Disconnect without calling `lost`."""
        session, self._session, self.ready = self._session, None, False
        if session is not None:
            session.close()

    def _opened(self) -> Any:
        """Return qi's session. Raises RobotLostError if the connection is lost."""
        if (session := self._session) is None:
            raise RobotLostError(CONNECTION_LOST)
        return session

    def _called(self, future: Any) -> NaoqiCall:
        with self._lock:
            self.pending += 1
        future.addCallback(self._settled)
        return NaoqiCall(future)

    def _settled(self, _: Any) -> None:
        with self._lock:
            self.pending -= 1

    def _broken(self, session: Any, reason: str) -> None:
        with self._lock:
            if session is None or session is not self._session:
                return
            self._session, self.ready = None, False
        WatchedThread("lumen-naoqi-closing", session.close).start()  # closing may wait for a robot that does not answer
        self._lost(reason)
