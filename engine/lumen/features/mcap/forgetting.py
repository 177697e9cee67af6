"""Removes a person from all recordings; a process that is writing a recording rewrites it itself."""

from pathlib import Path

from lumen.errors import LumenError, ModuleError
from lumen.features.mcap.files.rewriting import rewrite
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.features.mcap.redaction import redacted
from lumen.language.counts import counted
from lumen.language.people import PersonName, name_key
from lumen.project.home import Home
from lumen.run.forgetting.added import Forgetting, ForgottenPlace
from lumen.run.forgetting.files import attempt, await_others


def forget_recordings(folder: Path, name: str, found: Forgetting) -> None:
    """Remove a person from all recordings in a project's state folder and those noted there; add results to `found`.

    A recording that another process is writing is left to that process, and reported if it still contains the name.
    """
    recordings, held = RecordingsFolder(folder), Home(folder).held()
    person = PersonName(name, map(name_key, found.others))
    begun = {each.path.absolute(): each.written for each in recordings.begun()}
    files = dict.fromkeys([*begun, *(file.absolute() for file in recordings.files()), *recordings.parts()])
    for file in files:
        if begun.get(file) or (held and file.parent == recordings.ring):
            await_others(lambda file=file: not _named_in_recording(file, person))  # type: ignore[misc]
            if _named_in_recording(file, person):
                found.left.append(ForgottenPlace(str(file), "it is being written, and still contains the name"))
        else:
            attempt(found, file, lambda file=file: _recording(file, person, found))  # type: ignore[misc]


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
