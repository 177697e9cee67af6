"""The switch that silences the language model; people set it, and it lasts until it is set again."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lumen.language.modules import ANSWERS
from lumen.language.projects import Project
from lumen.project.home import Home
from lumen.run.questions import Questions
from lumen.run.raised_events import refusal

SILENCED_FILE = "model-silenced.json"
UNREADABLE = f"a person whom {SILENCED_FILE} does not name"


class ModelSwitch:
    """The switch of the language model; it takes effect at once, also in the middle of an answer.

    `record` writes an entry of the journal. The choice is restored from `folder` and saved there; without a folder it
    ends with the run.
    """

    def __init__(
        self,
        questions: Questions,
        project: Callable[[], Project],
        record: Callable[[Mapping[str, Any]], None],
        folder: Path | None = None,
    ) -> None:
        self._questions, self._project, self._record = questions, project, record
        self._home = Home(folder) if folder else None
        if folder and self._home and (folder / SILENCED_FILE).exists():  # also if the name in it is unreadable
            found = self._home.read_json(SILENCED_FILE)
            self._questions.silence(str((found.get("by") if isinstance(found, dict) else "") or UNREADABLE))

    @property
    def state(self) -> str | None:
        """`on` or `off`; None if the exhibition has no model."""
        if ANSWERS not in self._project().modules:
            return None
        return "off" if self._questions.silenced else "on"

    def switch(self, by: str, *, on: bool) -> dict[str, Any]:
        """Let the model speak, or silence it; return the verdict."""
        if self.state is None:
            return refusal("this exhibition has no language model: lumen.yaml has no module `answers`")
        self._questions.silence("" if on else by)
        self._record({"model": self.state, "by": by})
        why = ""
        if self._home and on:
            self._home.remove(SILENCED_FILE)
        elif self._home:
            why = self._home.write_json(SILENCED_FILE, {"by": by})
        kept = {"text": f"until the next start only: {why}"} if why else {}
        return {"verdict": "done", "model": self.state, **kept}
