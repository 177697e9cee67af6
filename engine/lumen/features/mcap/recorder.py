"""Records a bus on a separate thread: neither publishers nor ticks wait for a disk, unless it is patient."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple, Protocol

from lumen.bus.aliases import COPY
from lumen.features.mcap.files.encoding import MessageEncoder
from lumen.features.mcap.files.recorded import Recorded
from lumen.features.mcap.notes import notes_of
from lumen.journal.happenings import happening
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.language.routing_keys import DEFAULT_KEYS, INTERNAL_KEYS, key_of_robot
from lumen.ports import Bus, Message
from lumen.upkeep.drops import DropLog
from lumen.upkeep.threads import WatchedThread

MAX_WAITING = 20_000
"""The most unwritten messages; beyond it, publishers of a patient recorder wait, else the oldest are dropped."""
WRITE_PERIOD = 0.1
"""The time between two writes [s]."""
FORGETTING_SPACING = 2.0
"""The time between two removals of names [s]: each rewrites files."""
FORGETTING_SPAN = 10.0
"""The time for which a forgotten name is also removed from new messages [s], because the request contains it."""
MAX_FORGOTTEN = 100
"""The maximum number of names that are removed at a time."""
FORGOTTEN_ROUTE, IMAGE_ROUTE = "forgotten", "image"
FORGOTTEN_KEY = DEFAULT_KEYS[FORGOTTEN_ROUTE].partition("{robot}")[2]

_log = logging.getLogger(__name__)


class RecordingTape(Protocol):
    """Receives items to record; disk errors are not raised, but described in `trouble`."""

    trouble: str

    def write(self, items: Sequence[Recorded], now: float) -> None: ...

    def mark(self, why: str, now: float) -> None:
        """Keep the recording around this moment, for the reason `why`."""
        ...

    def settle(self, now: float) -> None:
        """Complete the chunks, pieces and recordings that are due at `now` [s since 1970]."""
        ...

    def forget(self, people: Sequence[PersonName]) -> None:
        """Remove these people from the items already written."""
        ...

    def close(self) -> None: ...


class _Heard(NamedTuple):
    message: Message
    came: float


class Recorder:
    """Writes the messages of a bus to tapes, from `start` to `close`.

    If it is `patient`, publishers wait for a slow disk; otherwise messages are dropped, logged and counted in
    `dropped`. Without `camera`, it does not subscribe to images. `extra` returns further items for a message and its
    arrival time [s since 1970].
    """

    def __init__(
        self,
        bus: Bus,
        project: Project,
        tapes: Sequence[RecordingTape],
        *,
        camera: bool = True,
        patient: bool = False,
        extra: Callable[[Message, float], Iterable[Recorded]] | None = None,
    ) -> None:
        self.tapes, self._bus, self._camera, self._patient, self._extra = tapes, bus, camera, patient, extra
        self._waiting: deque[_Heard] = deque(maxlen=None if patient else MAX_WAITING)
        self._drops = DropLog(_log, "messages for the recording")
        self._encoder = MessageEncoder(project)
        self._project, self._news = project, deque[Project]()
        self._undo: list[Callable[[], None]] = []
        self._forgotten: dict[str, tuple[PersonName, float]] = {}
        self._to_forget: list[PersonName] = []
        self._forgot = 0.0
        self._wake, self._idle, self._closing = threading.Event(), threading.Event(), False
        self._thread = WatchedThread("lumen-recorder", self._run)

    @property
    def trouble(self) -> str:
        """The reason why a tape fails; empty if none fails."""
        return next((tape.trouble for tape in self.tapes if tape.trouble), "")

    @property
    def dropped(self) -> int:
        """The number of dropped messages."""
        return sum(self._drops.counts.values())

    def start(self) -> None:
        """Start the thread and subscribe."""
        self._thread.start()
        self._undo = [self._bus.subscribe(pattern, self._hear) for pattern in _patterns(self._project, self._camera)]

    def use(self, project: Project) -> None:
        """Use the message schemas of another bundle from now on, and record its metadata."""
        self._news.append(project)

    def mark(self, why: str) -> None:
        """Mark this moment on all tapes, for the reason `why`.

        Any thread can call this method.
        """
        for tape in self.tapes:
            tape.mark(why, time.time())

    def close(self, patience: float = 20.0) -> None:
        """Write the waiting messages, for at most `patience` [s], and close all tapes; further calls do nothing."""
        for undo in self._undo:
            undo()
        self._undo = []
        self._closing = True
        self._wake.set()
        if self._thread.started:
            self._thread.join(patience)
        self._drops.tell(all=True)

    def _hear(self, message: Message) -> None:
        if message.id.endswith(COPY):
            return  # the original message arrives too
        heard = _Heard(message, time.time())
        if not self._patient:
            self._drops.push(self._waiting, heard, lambda each: each.message.key, "the disk is too slow for them")
            return
        self._waiting.append(heard)
        if len(self._waiting) > MAX_WAITING:
            self._idle.clear()
            self._wake.set()
            self._idle.wait(FORGETTING_SPAN)

    def _run(self) -> None:
        while True:
            self._wake.wait(WRITE_PERIOD)
            self._wake.clear()
            closing = self._closing
            self._write_waiting()
            self._idle.set()
            now = time.time()
            if self._to_forget and (closing or abs(now - self._forgot) > FORGETTING_SPACING):
                people, self._to_forget, self._forgot = self._to_forget, [], now
                for tape in self.tapes:
                    tape.forget(people)
            for tape in self.tapes:
                tape.settle(now)
            self._drops.tell()
            if closing and not self._waiting:
                for tape in self.tapes:
                    tape.close()
                return

    def _write_waiting(self) -> None:
        items, marks = list[Recorded](), list[tuple[str, float]]()
        while self._news:
            self._project = self._news.popleft()
            self._encoder.use(self._project)
            items.append(notes_of(self._project))
        for _ in range(len(self._waiting)):
            message, came = self._waiting.popleft()
            self._look_for_names(message, came)
            message = self._scrubbed(message, came)
            try:
                items += self._encoder.encode(message, came)
                items += self._extra(message, came) if self._extra else ()
            except Exception as error:  # a message that can't be encoded must not affect others
                self._drops.add(message.key, f"it can't be written: {error!r}")
            if why := happening(message, self._project.robot):
                marks.append((why, came))
        for tape in self.tapes:
            tape.write(items, time.time())
            for why, came in marks:
                tape.mark(why, came)

    def _look_for_names(self, message: Message, came: float) -> None:
        if message.key != self._project.key_of(FORGOTTEN_ROUTE) and not message.key.endswith(FORGOTTEN_KEY):
            return  # a name that another robot forgets counts too: its messages are recorded as well
        match message.body:
            case {"name": str(name)} if (key := name_key(name)) and len(self._forgotten) < MAX_FORGOTTEN:
                person = PersonName(name)
                self._to_forget += [person] if key not in self._forgotten else []
                self._forgotten[key] = person, came + FORGETTING_SPAN

    def _scrubbed(self, message: Message, came: float) -> Message:
        """Return a message without the names that were forgotten within the last FORGETTING_SPAN."""
        for key, (person, until) in list(self._forgotten.items()):
            if came > until:
                del self._forgotten[key]
            else:
                body, sender, cause = map(person.scrubbed, (message.body, message.sender, message.cause))
                message = message._replace(body=body, sender=sender, cause=cause)
        return message


def _patterns(project: Project, camera: bool) -> Sequence[str]:
    """Return the patterns to subscribe to: everything if the camera is recorded.

    Otherwise they are all known keys except the image key: without a subscriber, no images are rendered.
    """
    if camera:
        return ("#",)
    ours = [key_of_robot(key, project.robot) for key in INTERNAL_KEYS]
    keys = {key for name in project.routes for key in (project.key_of(name), project.routes[name].alias) if key}
    return sorted((keys | set(ours)) - {project.key_of(IMAGE_ROUTE)})
