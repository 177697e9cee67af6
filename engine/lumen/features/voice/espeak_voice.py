"""espeak-ng through its C interface (`speak_lib.h`): converts text to samples, without a sound device."""

import ctypes
import ctypes.util
import threading
from functools import cache
from typing import Any

from lumen.errors import ModuleError
from lumen.language.gestures import WordTime
from lumen.run.sound import Sound

INSTALL_VOICE = "pip install 'lumen-robot[voice]', or install the package espeak-ng"
WORDS_PER_MINUTE = 175
"""The default pace of speech [words per minute]."""
MAX_TEXT_CHARACTERS = 1_000
"""The maximum number of characters of a text that are spoken; the rest is left out."""

_SYNCHRONOUS, _DONT_EXIT, _UTF8, _CHARACTERS, _RATE = 2, 0x8000, 1, 1, 1

_LIST_END, _WORD = 0, 1


class _Event(ctypes.Structure):
    """`espeak_EVENT`: `position` is a character's number in the text, from 1, and `audio` a time in the sound [ms]."""

    _fields_ = (
        ("type", ctypes.c_int), ("id", ctypes.c_uint), ("position", ctypes.c_int), ("length", ctypes.c_int),
        ("audio", ctypes.c_int), ("sample", ctypes.c_int), ("data", ctypes.c_void_p), ("name", ctypes.c_char * 8),
    )  # fmt: skip


_Callback = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event))


class Espeak:
    """The espeak-ng library. `espeak()` returns the only instance of a process.

    Any thread can use the instance. Raises ModuleError if the library or its data can't be loaded.
    """

    def __init__(self, library: str, data: str | None) -> None:
        try:
            self._library = ctypes.CDLL(library)
        except OSError as error:
            raise ModuleError(f"espeak-ng cannot be loaded ({error}): {INSTALL_VOICE}") from None
        self._lock = threading.Lock()
        self._parts: list[bytes] = []
        self._words: list[WordTime] = []
        self._heard = _Callback(self._hear)
        self.rate = self._library.espeak_Initialize(_SYNCHRONOUS, 0, data and data.encode(), _DONT_EXIT)
        if self.rate <= 0:
            raise ModuleError(f"espeak-ng cannot read its data in {data or 'its usual folder'}: {INSTALL_VOICE}")
        self._library.espeak_SetSynthCallback(self._heard)
        self._library.espeak_Synth.argtypes = [
            ctypes.c_char_p, ctypes.c_size_t, ctypes.c_uint, ctypes.c_int, ctypes.c_uint, ctypes.c_uint,
            ctypes.c_void_p, ctypes.c_void_p,
        ]  # fmt: skip

    def speak(self, text: str, language: str = "en", pace: int = WORDS_PER_MINUTE) -> Sound:
        """Return the text as sound in this language, at `pace` words per minute.

        Raises ModuleError if espeak-ng has no voice for the language or can't speak the text.
        """
        return self.timed(text, language, pace)[0]

    def timed(
        self, text: str, language: str = "en", pace: int = WORDS_PER_MINUTE
    ) -> tuple[Sound, tuple[WordTime, ...]]:
        """Return the text's sound and the times at which its words begin, empty if the voice does not report them.

        Raises ModuleError as `speak` does.
        """
        said = "".join(sign if sign.isprintable() else " " for sign in text[:MAX_TEXT_CHARACTERS])
        data = said.encode("utf-8", "replace") + b"\0"
        with self._lock:
            if self._library.espeak_SetVoiceByName((language or "en").lower().encode()):
                raise ModuleError(f"espeak-ng has no voice for the language `{language}`")
            self._library.espeak_SetParameter(_RATE, pace, 0)
            self._parts.clear()
            self._words.clear()
            if self._library.espeak_Synth(data, len(data), 0, _CHARACTERS, 0, _UTF8, None, None):
                raise ModuleError("espeak-ng could not speak a text")
            return Sound(self.rate, b"".join(self._parts)), tuple(self._words)

    def _hear(self, samples: Any, count: int, events: Any) -> int:
        if samples and count > 0:
            self._parts.append(ctypes.string_at(samples, 2 * count))
        number = 0
        while events and events[number].type != _LIST_END:
            if events[number].type == _WORD:
                self._words.append(WordTime(events[number].position - 1, events[number].audio / 1000))
            number += 1
        return 0


@cache
def espeak() -> Espeak:
    """Return the package `espeakng-loader`'s library, else the system's. Raises ModuleError if neither exists."""
    try:
        import espeakng_loader
    except ImportError:
        found = ctypes.util.find_library("espeak-ng")
        if found is None:
            raise ModuleError(f"there is no espeak-ng: {INSTALL_VOICE}") from None
        return Espeak(found, None)
    return Espeak(espeakng_loader.get_library_path(), espeakng_loader.get_data_path())
