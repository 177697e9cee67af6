"""The mood of visitors, by their words."""

from collections.abc import Mapping

from lumen.ports import Message, MessageHandler
from lumen.run.module import Module


class Mood(Module):
    """Publishes on the route `mood` how many cheerful words a sentence has."""

    name = "mood"

    def hears(self) -> Mapping[str, MessageHandler]:
        return {"heard": self._sentence}

    def _sentence(self, message: Message) -> None:
        cheerful = self.settings.options.get("cheerful", ())
        words = str(message.body["result"]).lower().split()
        self.publish("mood", {"cheer": sum(word in cheerful for word in words)})
