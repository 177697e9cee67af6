"""Delete a person from the files in an exhibition's home."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from lumen.errors import JournalError, LumenError, ModuleError
from lumen.feature import resolve, rows
from lumen.journal.forgotten_snapshots import forgetful_data
from lumen.journal.journal_file import JOURNAL_SUFFIX, read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, newest
from lumen.journal.redaction import names, redact
from lumen.language.people import PersonName, name_key
from lumen.project.broken_features import faults_reported
from lumen.project.files import MAX_PROJECT_BYTES
from lumen.project.home import Home
from lumen.project.json_lines import forget_lines, line_names
from lumen.run.bundles import DamagedBundleError, unpacked
from lumen.run.forgetting.added import Forgetting, ForgottenPlace
from lumen.run.snapshot_store import SNAPSHOT_FILE

DRAFT_AGE = 5.0
"""The age [s] from which an unfinished draft of a file counts as left behind by a crash."""
PATIENCE = 5.0
"""The longest wait until a running exhibition has deleted the name from its own files [s]."""


def forget_in(folder: Path, name: str, found: Forgetting) -> None:
    """Forget a person in all files of the home in `folder`, and add the deleted and the remaining data to `found`.

    A running exhibition changes its own files; the function waits for that, for at most PATIENCE.
    """
    for feature, where in rows("file_forgetters"):
        with faults_reported(
            feature,
            f"its `{where}`",
            lambda fault: found.left.append(ForgottenPlace("a package", fault.message)),
            LumenError,
        ):
            resolve(where)(folder, name, found)
    person = PersonName(name, map(name_key, found.others))
    _drafts(folder)
    found.left += _left(folder, person)
    found.elsewhere += _own_files(folder, person)


def forget_inputs(folder: Path, name: str, found: Forgetting) -> None:
    """Forget a person in the `.jsonl` files, the behaviour's snapshot and the journal, and add the result to `found`.

    A running exhibition changes the snapshot and the newest file of the journal; wait for that, for at most PATIENCE.
    """
    person, home = PersonName(name, map(name_key, found.others)), Home(folder)
    for file in sorted(folder.glob("*.jsonl*")):
        attempt(found, file, lambda file=file: _lines(file, person, found))  # type: ignore[misc]
    if home.held():
        await_others(lambda: not _names(folder / SNAPSHOT_FILE, person) and not _names_in_journal(folder, person))
    else:
        _snapshot(home, person, found)
    attempt(found, folder / JOURNAL_FOLDER, lambda: _journal(folder, person, found))


def attempt(found: Forgetting, file: Path, work: Callable[[], None]) -> None:
    """Do `work` if the file exists; if it raises ModuleError, record the file in `found.left` instead of raising."""
    try:
        if file.exists():
            work()
    except ModuleError as error:
        found.left.append(ForgottenPlace(file.name, str(error)))


def _lines(file: Path, person: PersonName, found: Forgetting) -> None:
    if gone := forget_lines(file, person):
        found.deleted.append(ForgottenPlace(file.name, f"lines: {gone}"))


def _journal(folder: Path, person: PersonName, found: Forgetting) -> None:
    """Redact the name in the journal's files, except in the one that a running exhibition writes."""
    files, held = sorted((folder / JOURNAL_FOLDER).rglob(f"*{JOURNAL_SUFFIX}")), Home(folder).held()
    if named := sum(redact(file, person) for file in files if not (held and file == newest(folder))):
        found.deleted.append(ForgottenPlace(JOURNAL_FOLDER, f"the name, in entries: {named}"))


def _names_in_journal(folder: Path, person: PersonName) -> bool:
    """Return whether the newest file of the journal, which only a running exhibition writes, has the name."""
    file = newest(folder)
    try:
        return file is not None and any(names(entry, person) for entry in read_journal(file).entries)
    except JournalError:
        return False


def _snapshot(home: Home, person: PersonName, found: Forgetting) -> None:
    """Remove the name from the snapshot of a crashed run; delete the snapshot if the name can't be removed."""
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
    """Delete the half-written drafts of a crash, because they may contain the name.

    While an exhibition runs, only drafts older than DRAFT_AGE are deleted.
    """
    for draft in folder.rglob("*.new"):
        with suppress(OSError):  # its writer may just have renamed it
            if not Home(folder).held() or time.time() - draft.stat().st_mtime > DRAFT_AGE:
                draft.unlink()


def naming_inputs(folder: Path, name: str) -> set[str]:
    """Return which files of a running exhibition name a person: its snapshot and its journal. Empty if none runs."""
    person = PersonName(name)
    named = {SNAPSHOT_FILE: _names(folder / SNAPSHOT_FILE, person), JOURNAL_FOLDER: _names_in_journal(folder, person)}
    return {file for file, names in named.items() if names and Home(folder).held()}


def _left(folder: Path, person: PersonName) -> Iterator[ForgottenPlace]:
    """Yield the files that still contain the name."""
    for file in sorted(folder.rglob("*.json*")):
        if _names(file, person):
            held = file.name == SNAPSHOT_FILE and Home(folder).held()
            why = "the running exhibition has not forgotten the name" if held else "it still contains the name"
            yield ForgottenPlace(str(file.relative_to(folder)), why)
    if Home(folder).held() and _names_in_journal(folder, person):
        yield ForgottenPlace(JOURNAL_FOLDER, "the running exhibition has not forgotten the name")


def _own_files(folder: Path, person: PersonName) -> Iterator[ForgottenPlace]:
    """Yield the exhibition's own files that contain the name, in the bundles kept for a start after a crash."""
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


def await_others(condition: Callable[[], bool]) -> None:
    """Poll the condition, which another process must meet, for at most PATIENCE."""
    deadline = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
