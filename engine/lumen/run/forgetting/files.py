"""The files of an exhibition's home, without somebody."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from lumen.errors import JournalError, LumenError, ModuleError
from lumen.features.eyes.eyes import FACES_FILE
from lumen.features.mcap.files.rewriting import rewrite
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.redaction import redacted
from lumen.features.visitors.memory import DATABASE_FILE
from lumen.features.visitors.module import Store
from lumen.journal.forgotten_snapshots import forgetful_data
from lumen.journal.journal_file import JOURNAL_SUFFIX, read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, newest
from lumen.journal.redaction import names, redact
from lumen.language.counts import counted
from lumen.language.people import PersonName, name_key
from lumen.project.files import MAX_PROJECT_BYTES
from lumen.project.home import Home
from lumen.project.json_lines import forget_lines, line_names
from lumen.run.bundles import DamagedBundleError, unpacked
from lumen.run.forgetting.report import Forgetting, ForgottenPlace
from lumen.run.snapshot_store import SNAPSHOT_FILE

DRAFT_AGE = 5.0
"""After how long a draft of a file is one that a crash has left behind [s]."""
PATIENCE = 5.0
"""How long a running exhibition has to forget what it remembers [s]."""


def forget_in(folder: Path, name: str, found: Forgetting) -> None:
    """Forget somebody in all files of the home in `folder`, and add to `found` what came of it and what is left.

    What a running exhibition remembers it forgets itself: that is waited for.
    """
    _attempt(found, folder / DATABASE_FILE, lambda: _database(folder / DATABASE_FILE, name, found))
    _attempt(found, folder / FACES_FILE, lambda: _faces(folder / FACES_FILE, name, found))
    person, home = PersonName(name, map(name_key, found.others)), Home(folder)
    for file in sorted(folder.glob("*.jsonl*")):
        _attempt(found, file, lambda file=file: _lines(file, person, found))  # type: ignore[misc]
    if home.held():
        _await(lambda: not _names(folder / SNAPSHOT_FILE, person) and not _names_in_journal(folder, person))
    else:
        _snapshot(home, person, found)
    _attempt(found, folder / JOURNAL_FOLDER, lambda: _journal(folder, person, found))
    _recordings(home, person, found)
    _drafts(folder)
    found.left += _left(folder, person)
    found.elsewhere += _own_files(folder, person)


def _attempt(found: Forgetting, file: Path, work: Callable[[], None]) -> None:
    """One file that can't be written keeps no other from being forgotten."""
    try:
        if file.exists():
            work()
    except ModuleError as error:
        found.left.append(ForgottenPlace(file.name, str(error)))


def _database(file: Path, name: str, found: Forgetting) -> None:
    store = Store(file)
    try:
        gone = store.forget(name)
    finally:
        store.close()
    found.visitors += gone.visitors
    found.entries += gone.entries
    found.others = gone.others
    if gone.visitors or gone.entries:
        found.deleted.append(
            ForgottenPlace(file.name, f"visitors: {gone.visitors}, entries of the journal: {gone.entries}")
        )


def _faces(file: Path, name: str, found: Forgetting) -> None:
    from lumen.features.eyes.gallery import FaceGallery  # importing OpenCV is slow

    if gone := FaceGallery(file, time.time).forget(name):
        found.pictures += gone
        found.deleted.append(ForgottenPlace(file.name, f"pictures: {gone}"))


def _lines(file: Path, person: PersonName, found: Forgetting) -> None:
    if gone := forget_lines(file, person):
        found.deleted.append(ForgottenPlace(file.name, f"lines: {gone}"))


def _journal(folder: Path, person: PersonName, found: Forgetting) -> None:
    """What happened, but for the file that a running exhibition writes."""
    files, held = sorted((folder / JOURNAL_FOLDER).rglob(f"*{JOURNAL_SUFFIX}")), Home(folder).held()
    if named := sum(redact(file, person) for file in files if not (held and file == newest(folder))):
        found.deleted.append(ForgottenPlace(JOURNAL_FOLDER, f"the name, in entries: {named}"))


def _recordings(home: Home, person: PersonName, found: Forgetting) -> None:
    """What was recorded of the bus, wherever that is; what is being written, who writes it writes anew."""
    recordings, held = RecordingsFolder(home.folder), home.held()
    begun = {each.path.absolute(): each.written for each in recordings.begun()}
    files = dict.fromkeys([*begun, *(file.absolute() for file in recordings.files()), *recordings.parts()])
    for file in files:
        if begun.get(file) or (held and file.parent == recordings.ring):
            _await(lambda file=file: not _named_in_recording(file, person))  # type: ignore[misc]
            if _named_in_recording(file, person):
                found.left.append(ForgottenPlace(str(file), "it is being written, and still contains the name"))
        else:
            _attempt(found, file, lambda file=file: _recording(file, person, found))  # type: ignore[misc]


def _recording(file: Path, person: PersonName, found: Forgetting) -> None:
    try:
        gone, changed = redacted(file, person)
        if gone:
            rewrite([file], file, changed)
            said = f"the name: {counted(gone.messages, 'message')}, {counted(gone.files, 'attached file')}"
            found.deleted.append(ForgottenPlace(str(file), f"{said}; pictures and sounds: {gone.pictures}"))
    except LumenError as error:
        raise ModuleError(str(error)) from None


def _named_in_recording(file: Path, person: PersonName) -> bool:
    try:
        return bool(redacted(file, person)[0])
    except LumenError:
        return False


def _names_in_journal(folder: Path, person: PersonName) -> bool:
    """Whether the file says the name that a running exhibition writes, and nobody else can."""
    file = newest(folder)
    try:
        return file is not None and any(names(entry, person) for entry in read_journal(file).entries)
    except JournalError:
        return False


def _snapshot(home: Home, person: PersonName, found: Forgetting) -> None:
    """Where the behaviour stood when it ended without notice."""
    content = home.read(SNAPSHOT_FILE)
    if content is None or not line_names(content, person):
        return
    try:
        data = json.loads(content)
        scrubbed = json.dumps({**data, "snapshot": forgetful_data(data["snapshot"], person)}).encode()
    except (ValueError, TypeError, KeyError, RecursionError):
        scrubbed = b""
    if not scrubbed or line_names(scrubbed, person):
        home.remove(SNAPSHOT_FILE)
        found.deleted.append(ForgottenPlace(SNAPSHOT_FILE, "the file: the next run starts from the beginning"))
    elif why := home.write(SNAPSHOT_FILE, scrubbed):
        found.left.append(ForgottenPlace(SNAPSHOT_FILE, f"it can't be written: {why}"))
    else:
        found.deleted.append(ForgottenPlace(SNAPSHOT_FILE, "the name, in the context of the behaviour"))


def _drafts(folder: Path) -> None:
    """What a crash left half written may name anybody."""
    for draft in folder.rglob("*.new"):
        with suppress(OSError):  # whoever writes it has just done so
            if not Home(folder).held() or time.time() - draft.stat().st_mtime > DRAFT_AGE:
                draft.unlink()


def _left(folder: Path, person: PersonName) -> Iterator[ForgottenPlace]:
    """Files that still name the person."""
    for file in sorted(folder.rglob("*.json*")):
        if _names(file, person):
            held = file.name == SNAPSHOT_FILE and Home(folder).held()
            why = "the running exhibition has not forgotten the name" if held else "it still contains the name"
            yield ForgottenPlace(str(file.relative_to(folder)), why)
    if Home(folder).held() and _names_in_journal(folder, person):
        yield ForgottenPlace(JOURNAL_FOLDER, "the running exhibition has not forgotten the name")


def _own_files(folder: Path, person: PersonName) -> Iterator[ForgottenPlace]:
    """Files of the exhibition itself, as they are kept for a start after a crash, that say the name."""
    for file in sorted(folder.glob("*.zip")):
        with suppress(OSError, DamagedBundleError):
            for member, content in unpacked(file.read_bytes(), 2 * MAX_PROJECT_BYTES).items():
                if person.is_named_in(content.decode("utf-8", "replace")):
                    yield ForgottenPlace(file.name, f"the exhibition's own file {member} contains the name")


def _names(file: Path, person: PersonName) -> bool:
    try:
        return any(line_names(line, person) for line in file.read_bytes().splitlines())
    except OSError:
        return False


def _await(condition: Callable[[], bool]) -> None:
    """Look again and again, as the condition is another process's work; no longer than PATIENCE."""
    deadline = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
