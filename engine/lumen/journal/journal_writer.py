"""Writes the journal of inputs on a thread of its own, so that no step waits for a disk."""

import logging
import os
import threading
import time
import uuid
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, BinaryIO

from lumen.errors import ModuleError
from lumen.insight.replay.entries import How, JumpKind
from lumen.journal.journal_file import JOURNAL_SUFFIX, FramePacker, JournalHeader
from lumen.journal.journal_folder import JournalFolder, JournalTail
from lumen.journal.journal_pen import JournalPen, Jumped, Stepped
from lumen.journal.redaction import redact
from lumen.language.commands import Command
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.statechart import Snapshot, Step
from lumen.talk.hearing import MATCHER
from lumen.upkeep.threads import WatchedThread

MAX_WAITING = 20_000
"""The greatest number of entries that may wait for the disk; further ones are lost, and counted."""
WRITE_PERIOD = 0.25
"""The longest delay before a step without commands is written [s]; other steps are written at once."""
SYNC_PERIOD = 0.5
"""The shortest time between two syncs to the disk [s]."""
MAX_LINES, MAX_LINES_BYTES = 1000, 2_000_000
"""The greatest number of entries in one frame, and the size after which no more are added [bytes]."""
FILE_BYTES = 1_000_000
"""A file larger than this is ended, and a new one begun [bytes]."""
RETRY_PERIOD = 5.0
"""The pause after a write that failed [s]."""

_log = logging.getLogger(__name__)


def hears(project: Project) -> bool:
    """Return True if a state of the project has `hears`."""
    return any(t.hears for m in project.behaviors.values() for state in m.states.values() for t in state.transitions)


class JournalWriter:
    """Writes steps and jumps to the files of a folder, as an `InputRecorder`; `story` names the story played, if any.

    The last entries are also in `tail`, for frequent requests. Without a folder, entries are only in `tail`, and
    positions count from 0.

    If the disk refuses, or is too slow for `MAX_WAITING` entries, entries are lost, and a gap marks them in the
    journal. `lost` counts those that the disk refused, and `trouble` is the first reason. If the run is `rehearsed`, a
    step waits for a slow disk, and a power cut may lose the last entries.
    """

    def __init__(self, folder: JournalFolder | None, *, story: str = "", rehearsed: bool = False) -> None:
        self.folder, self._story, self._rehearsed = folder, story, rehearsed
        self.run = uuid.uuid4().hex
        self.lost, self.trouble = 0, ""
        self.tail, self.begun = JournalTail(), threading.Event()
        self._waiting: deque[Stepped | Jumped | PersonName | threading.Event] = deque()
        self._overflow, self._gone = 0, 0
        self._project: Project | None = None
        self._wake, self._closing = threading.Event(), False
        self._pen = JournalPen()
        self._file: BinaryIO | None = None
        self._packer, self._bytes, self._synced, self._day = FramePacker(), 0, 0.0, ""
        self._retry = 0.0
        self._thread = WatchedThread("lumen-inputs", self._run)

    def start(self) -> None:
        self._thread.start()

    def stepped(self, step: Step, how: How) -> None:
        """Queue a step for writing. This method must be called on the thread that runs the behaviour.

        If MAX_WAITING entries wait, the step is lost; if the run is `rehearsed`, the method first waits up to 5 s for
        room. Later steps are lost, too, until at most half as many entries wait: the next step is then replaced by a
        gap, which counts all steps lost.
        """
        if self._rehearsed and len(self._waiting) >= MAX_WAITING:
            self.flush()
        if len(self._waiting) >= MAX_WAITING or (self._overflow and len(self._waiting) > MAX_WAITING // 2):
            self._overflow += 1
        elif self._overflow and self._project:
            self._overflow += 1  # this step is lost, too
            self.jumped("gap", self._project, step.snapshot, step.commands)
        else:
            self._waiting.append(Stepped(step, how))
            if step.commands:
                self._wake.set()

    def jumped(
        self, kind: JumpKind, project: Project, snapshot: Snapshot, commands: Sequence[Command] = (), **said: Any
    ) -> None:
        """Queue a change of the state without a step, even if the queue is full.

        The entry contains the number of steps lost just before it. This method must be called on the thread that runs
        the behaviour.
        """
        if self._overflow:
            said, self._overflow = {**said, "lost": self._overflow}, 0
        self._project = project
        self._waiting.append(Jumped(kind, project, snapshot, commands, said))
        self._wake.set()

    def forget(self, person: PersonName) -> None:
        """Queue the removal of a visitor's name from all files and `tail`. Any thread may call this method."""
        self._waiting.append(person)
        self._wake.set()

    def flush(self, patience: float = 5.0) -> bool:
        """Wait up to `patience` [s] until the whole queue is written; return True if it was written."""
        written = threading.Event()
        self._waiting.append(written)  # queued, so that it is set only after everything queued before it
        self._wake.set()
        return written.wait(patience)

    def close(self, patience: float = 5.0) -> None:
        """Write the rest of the queue, for up to `patience` [s], and end the thread."""
        self._closing = True
        self._wake.set()
        if self._thread.started:
            self._thread.join(patience)

    def _run(self) -> None:
        self._end_file()  # after a fault of Lumen, a new file begins with a keyframe
        if not self.begun.is_set():
            self.tail.begin(self.folder.next_position() if self.folder else 0)
            self.begun.set()
        while True:
            self._wake.wait(WRITE_PERIOD)
            self._wake.clear()
            closing = self._closing
            while self._waiting:
                self._write_next()
            self._bring_to_disk(closing)
            if closing and not self._waiting:
                self._end_file()
                return

    def _write_next(self) -> None:
        """Write the queue as one frame. Each file is about one bundle, and begins with a keyframe."""
        lines, size = list[bytes](), 0
        if self._bytes > FILE_BYTES or time.strftime("%j") != self._day:
            self._end_file()
        while self._waiting and len(lines) < MAX_LINES and size < MAX_LINES_BYTES:
            told = self._waiting.popleft()
            if isinstance(told, threading.Event):
                self._put(lines)
                lines = []
                told.set()
                continue
            if isinstance(told, PersonName):
                self._put(lines)
                lines = []
                self._forget(told)
                continue
            if isinstance(told, Jumped) and self._pen.bundle not in ("", told.project.hash):
                self._put(lines)
                lines = []
                self._end_file()
            if self.folder and self._file is None:
                self._put(lines)
                lines = []
                if self._begin_file(self.folder, told):
                    lines += self._pen.keyframe(gone=self._gone) if isinstance(told, Stepped) else []
                    self._gone = 0
            written = self._pen.write(told)
            lines += written
            size += sum(map(len, written))
        self._put(lines)

    def _put(self, lines: list[bytes]) -> None:
        self.tail.add(lines)
        if self.folder is None or not lines:
            return
        if self._file is None:
            self._lose(len(lines))
            return
        try:
            frame = self._packer.pack(b"".join(lines))
            self._write_all(self._file, frame)
            self._bytes += len(frame)
        except OSError as error:
            self._fail(error)
            self._lose(len(lines))

    def _begin_file(self, folder: JournalFolder, told: Stepped | Jumped) -> bool:
        """Open the next file; return False if the disk refuses, or has just refused."""
        if time.monotonic() < self._retry:
            return False
        bundle = told.project.hash if isinstance(told, Jumped) else self._pen.bundle
        try:
            matcher = MATCHER if self._project and hears(self._project) else 0
            header = JournalHeader(self.tail.next, self.run, bundle, time.time(), self._story, matcher=matcher)
            self._file = folder.open(header)
        except OSError as error:
            self._fail(error)
            return False
        self._packer, self._bytes, self._day = FramePacker(), 0, time.strftime("%j")
        folder.prune(time.time())
        return True

    def _write_all(self, file: BinaryIO, data: bytes) -> None:
        while data:
            data = data[file.write(data) :]

    def _bring_to_disk(self, now: bool) -> None:
        if self._file is None or self._rehearsed:
            return
        if now or time.monotonic() - self._synced >= SYNC_PERIOD:
            self._synced = time.monotonic()
            try:
                os.fsync(self._file.fileno())
            except OSError as error:
                self._fail(error)

    def _fail(self, error: OSError) -> None:
        """Handle an error of the disk: entries are lost until a later attempt succeeds."""
        self._retry = time.monotonic() + RETRY_PERIOD
        if not self.trouble:
            self.trouble = f"the journal can't be written: {(error.strerror or str(error)).lower()}"
            _log.warning("%s: events from now on can't be replayed", self.trouble)
        self._end_file()

    def _lose(self, count: int) -> None:
        self.lost += count
        self._gone += count

    def _end_file(self) -> None:
        file, self._file = self._file, None
        if file:
            with suppress(OSError):
                file.close()

    def _forget(self, person: PersonName) -> None:
        self._end_file()
        self.tail.forget(person)
        for file in self.folder.folder.rglob(f"*{JOURNAL_SUFFIX}") if self.folder else ():
            try:
                redact(file, person)
            except ModuleError as error:
                _log.warning("the journal still contains data of a visitor that should be deleted: %s", error)
