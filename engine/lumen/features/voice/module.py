"""The text-to-speech module on the bus, which uses espeak-ng."""

import time
from collections.abc import Callable, Mapping

from lumen.errors import ModuleError
from lumen.features.voice.espeak_voice import Espeak, espeak
from lumen.language.iso_time import iso_time
from lumen.language.modules import VOICE
from lumen.language.projects import Project
from lumen.ports import Bus, Message, MessageHandler
from lumen.run.module import Module


class Voice(Module):
    """Answers each text on `lumen.audio.text.stream` with its speech. Raises ModuleError if espeak-ng is missing."""

    name = VOICE

    def __init__(self, project: Project, bus: Bus, tell: Callable[[str], None]) -> None:
        super().__init__(project, bus, tell)
        self._espeak = espeak()

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the handler for texts, by route."""
        return {"text_stream": self._text}

    def _text(self, message: Message) -> None:
        match message.body:
            case {"text": str(text), **rest}:
                pass
            case _:
                raise ModuleError(f"a message on {message.key} needs a `text`")
        sound = self._espeak.speak(text, str(rest.get("language") or self.project.languages[0]))
        date = iso_time(time.time(), "seconds", offset=True)
        body = {"name": str(rest.get("name", "")), "sound": sound.text(), "date": date}
        self.publish("text_to_speech", body)
        self.reply(message, body)
        self.well()


__all__ = ["Espeak", "Voice", "espeak"]
