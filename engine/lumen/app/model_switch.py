"""Whether the language model may speak: switched by people, and kept until somebody switches it again."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lumen.app.raised_events import refusal
from lumen.language.modules import ANSWERS
from lumen.language.projects import Project
from lumen.runtime.home import Home
from lumen.runtime.questions import Questions

SILENCED_FILE = "model-silenced.json"
UNREADABLE = f"a person whom {SILENCED_FILE} does not name"


class ModelSwitch:
    """Silences the model, or lets it speak again: at once, also in the middle of an answer.

    `record` keeps an entry of the journal of files. Once it has a `home`, it is kept there, whatever ends the run.
    """

    def __init__(
        self, questions: Questions, project: Callable[[], Project], record: Callable[[Mapping[str, Any]], None]
    ) -> None:
        self._questions, self._project, self._record = questions, project, record
        self._home: Home | None = None

    def keep(self, folder: Path) -> None:
        """Go on with what was switched in a run before, and keep in this folder what is from now on."""
        self._home = Home(folder)
        if (folder / SILENCED_FILE).exists():  # also where nobody can read who it was
            found = self._home.read_json(SILENCED_FILE)
            self._questions.silence(str((found.get("by") if isinstance(found, dict) else "") or UNREADABLE))

    @property
    def state(self) -> str | None:
        """`on` or `off`; None where the exhibition has no model."""
        if ANSWERS not in self._project().modules:
            return None
        return "off" if self._questions.silenced else "on"

    def switch(self, by: str, *, on: bool) -> dict[str, Any]:
        """Let it speak, or not; the answer for who asked."""
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
