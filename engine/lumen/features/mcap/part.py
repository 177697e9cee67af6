"""The part that records a running exhibition: all of it into a requested file, and its last minutes into a ring."""

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from lumen.bus.validated import ValidatedBus
from lumen.errors import LumenError, RecordingError, UsageError
from lumen.extras import MissingExtraError
from lumen.features.mcap.files.reading import read_recording
from lumen.features.mcap.files.recorded import Recorded, RecordedNotes
from lumen.features.mcap.files.recording_file import demand_recording, renamed, writable
from lumen.features.mcap.notes import NOTES, bundle_files, journal_files, notes_of
from lumen.features.mcap.recorder import Recorder, RecordingTape
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.recovering import RecordingRescue
from lumen.features.mcap.ring import PIECE_PERIOD, RingTape
from lumen.features.mcap.robot_view import RobotView
from lumen.features.mcap.tape_file import FileTape
from lumen.language.counts import counted
from lumen.language.projects import Project
from lumen.language.retention import RecordingSettings
from lumen.project.home import home_of
from lumen.run.parts.part import Part
from lumen.run.services import Services

Telling = Callable[[str], None]


class RecordingPart(Part):
    """Records the bus, and repairs incomplete recordings of earlier runs; the first part, because it is closed last.

    `ring`, which only the run that owns the home can set, allows both the repair and, if the project has
    `record: {ring: …}`, the ring. Raises UsageError if `file` can't be written, MissingExtraError without the extra.
    """

    patient = True

    def __init__(
        self,
        project: Project,
        bus: ValidatedBus,
        tell: Telling,
        file: Path | None,
        *,
        ring: bool,
        patient: bool = False,
    ) -> None:
        self._project, self._tell, self._root = project, tell, Path(project.root)
        self._said = project.section(RecordingSettings)
        self._robot = project.one_of_several
        self._folder = RecordingsFolder(home_of(self._root, self._robot))
        self._view = RobotView(project, tell) if file or (ring and self._said.ring) else None
        self._rescue = RecordingRescue(self._folder, tell, self._rescued) if ring else None
        self._file = self._begin(file) if file else None
        self._ring = self._ringing() if ring and self._said.ring else None
        tapes: list[RecordingTape] = [tape for tape in (self._file, self._ring) if tape]
        self._recorder = (
            Recorder(bus.unchecked, project, tapes, camera=self._said.camera, patient=patient, extra=self._view)
            if tapes
            else None
        )
        if self._recorder:
            self._recorder.start()

    @property
    def trouble(self) -> str:
        """The reason why a tape fails; empty if none fails."""
        return self._recorder.trouble if self._recorder else ""

    def marking(self) -> str:
        """Return a sentence about where this moment is recorded; empty without a ring or a working file."""
        if self._ring:
            return f"the last {self._said.ring / 60:g} min and the next minute are kept in {self._folder.path}"
        return f"everything is recorded into {self._file.path}" if self._file and not self._file.trouble else ""

    def use(self, project: Project) -> None:
        """Use the message schemas of another bundle from now on."""
        self._project = project
        if self._recorder:
            self._recorder.use(project)

    def summary(self) -> Iterator[str]:
        """Yield a line about the recorded file, or its error; nothing without a file."""
        if self._file:
            yield self._file.trouble or f"recorded: {self._file.path}, {counted(self._file.messages, 'message')} so far"

    def close(self) -> None:
        """Finish the recordings, report dropped messages, and wait for repairs."""
        if self._recorder:
            self._recorder.close()
            if dropped := self._recorder.dropped:
                self._tell(f"{counted(dropped, 'message')} could not be recorded: the disk was too slow")
        if self._rescue:
            self._rescue.close()

    def _begin(self, file: Path) -> FileTape:
        try:
            path = writable(file)
            if other := renamed(file, path):
                self._tell(other)
            first: list[Recorded] = [
                notes_of(self._project),
                *bundle_files(self._root, [self._project.hash], self._robot),
            ]
            first += self._view.look(time.time()) if self._view else ()
            return FileTape(
                path, self._folder, first, lambda began: journal_files(self._root, began, time.time(), self._robot)
            )
        except MissingExtraError:
            raise
        except (OSError, LumenError) as error:
            raise UsageError(f"{file} can't be recorded: {getattr(error, 'strerror', None) or error}") from None

    def _ringing(self) -> RingTape | None:
        """Return the ring; if a package is missing, report that and return None."""
        try:
            demand_recording()
            return RingTape(
                self._folder,
                self._said,
                lambda: [notes_of(self._project)],
                self._kept,
                lambda path: self._tell(f"kept: {path}"),
            )
        except LumenError as error:
            self._tell(str(error))
            return None

    def _kept(self, began: float, ended: float, pieces: Sequence[Path]) -> Iterable[Recorded]:
        """Return the project's files, the journal and the robot's shape, which explain a recording of these pieces."""
        look = self._view.look(began) if self._view else ()
        return [*self._explaining(pieces), *journal_files(self._root, began, ended, self._robot), *look]

    def _rescued(self, pieces: Sequence[Path]) -> Iterable[Recorded]:
        """Return the project's files, the journal and the robot's shape for the pieces that an earlier run left."""
        times = [piece.stat().st_mtime for piece in pieces]
        return self._kept(min(times) - PIECE_PERIOD, max(times), pieces)

    def _explaining(self, pieces: Sequence[Path]) -> Iterable[Recorded]:
        """Return the files of each bundle that ran during these pieces; skip unreadable pieces."""
        hashes = list[str]()
        for piece in pieces:
            with suppress(RecordingError):
                notes = (
                    item for item in read_recording(piece) if isinstance(item, RecordedNotes) and item.name == NOTES
                )
                hashes += [dict(found.words).get("bundle", "") for found in notes]
        return bundle_files(self._root, hashes, self._robot)


def make(services: Services) -> RecordingPart:
    """Make the part that records the bus and repairs incomplete recordings of earlier runs."""
    plan = services.plan
    file, patient = plan.options.get("record"), plan.story is not None and not plan.roles
    tell = services.tell("recording")
    return RecordingPart(plan.project, services.bus, tell, file, ring=services.lasts, patient=patient)
