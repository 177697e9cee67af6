"""Vectors from any server with OpenAI-compatible `/v1/embeddings`."""

import json
from collections.abc import Callable, Sequence

from lumen.errors import ModuleError
from lumen.features.answers.http_stream import answered
from lumen.features.answers.model_settings import ServerSettings
from lumen.features.answers.vectors import KnownText, TextVector, unit

BATCH = 32
"""The maximum number of texts in one request."""
MAX_BYTES = 4_000_000
"""The maximum size of a response [bytes]: 32 vectors of 4,096 numbers as text."""


class ServerVectors:
    """Requests vectors from a server in batches; requests do not distinguish questions from answers."""

    is_here = False

    def __init__(self, settings: ServerSettings) -> None:
        self.settings = settings
        self.batch = BATCH

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Return the vectors of these texts.

        Raises ModuleError if the server can't be reached, its response is invalid or late, or the key is missing.
        """
        body = {"model": self.settings.name, "input": [text for text, _ in texts]}
        with answered(self.settings.url, body, self.settings.secret(), deadline, wanted, MAX_BYTES) as (_, pieces):
            content = b"".join(pieces)
        try:
            found = {row["index"]: unit(row["embedding"]) for row in json.loads(content)["data"]}
            return [found[i] for i in range(len(texts))]
        except (ValueError, TypeError, KeyError, RecursionError, OverflowError):
            raise ModuleError("the embeddings server's answer is not a list of embeddings") from None
