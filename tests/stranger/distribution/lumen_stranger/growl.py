"""A voice that growls each letter."""

from pathlib import Path

from lumen.language.gestures import WordTime
from lumen.run.audio_track import AudioTrack

TIME_OF_A_LETTER = 0.1
"""[s]."""


class Growl:
    """Writes what it growls into its file, if it has one."""

    words: tuple[WordTime, ...] = ()
    mute = False

    def __init__(self, language: str, file: Path | None, heard: AudioTrack | None = None) -> None:
        self._file, self._growls = file, list[str]()

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        self._growls.append(f"grrr {text}")
        return len(text) * TIME_OF_A_LETTER

    def end(self, now: float) -> None:
        pass

    def close(self) -> None:
        if self._file:
            self._file.write_text("\n".join(self._growls))
