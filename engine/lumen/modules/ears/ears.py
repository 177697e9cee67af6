"""Listens to recordings, and publishes what was said in them."""

from collections.abc import Callable, Mapping
from datetime import UTC, datetime

from lumen.errors import ModuleError
from lumen.language.modules import EARS
from lumen.language.projects import Project
from lumen.modules.ears.expected import expected
from lumen.modules.ears.recogniser import Recogniser
from lumen.modules.module import Module
from lumen.modules.sound import sound_of
from lumen.ports import Bus, Message, MessageHandler


class Ears(Module):
    """The speech half of the audio module: the robot's recordings, and sounds that others send, become texts.

    A recogniser of one's own may be handed in; else it is PocketSphinx. Raises ModuleError where that is not there.
    """

    name = EARS

    def __init__(
        self, project: Project, bus: Bus, tell: Callable[[str], None], recogniser: Recogniser | None = None
    ) -> None:
        super().__init__(project, bus, tell)
        self._recogniser = recogniser or _sphinx()
        self._recogniser.expect(expected(project))

    def hears(self) -> Mapping[str, MessageHandler]:
        return {"recording": self._sound, "wav_stream": self._sound}

    def use(self, project: Project) -> None:
        super().use(project)
        self._recogniser.expect(expected(project))

    def _sound(self, message: Message) -> None:
        body = message.body if isinstance(message.body, dict) else {}
        language = str(body.get("language") or self._recogniser.languages[0])
        if language.partition("-")[0] not in self._recogniser.languages:
            known = ", ".join(self._recogniser.languages)
            raise ModuleError(
                f"nobody understands the language `{language[:20]}` here, only {known}: type what was said"
            )
        text = self._recogniser.recognise(sound_of(body.get("content")))
        if text:
            date = datetime.now(UTC).isoformat(timespec="seconds")
            name = str(body.get("name", ""))
            self.publish("heard", {"name": name, "result": text, "date": date, "language": language})
        self.well()


def _sphinx() -> Recogniser:
    from lumen.modules.ears.shared_sphinx import SharedSphinx  # nobody who brings another needs it

    return SharedSphinx()
