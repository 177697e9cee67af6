"""Keep the outcomes of simulated motions under `.lumen/physics/`, to simulate each motion only once."""

import hashlib
import json
import os
import re
from collections.abc import Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.trials.cases import Case
from lumen.features.simulation.trials.trial import Outcome
from lumen.language.projects import Project
from lumen.ports import Perform
from lumen.project.engine_files import code_hash
from lumen.project.home import home_of
from lumen.project.lending import model_files
from lumen.project.project_folders import MODELS
from lumen.robot.motion_codec import encode_motion
from lumen.upkeep.own_folders import private_folder

CODE = (
    "lumen.features.simulation",
    "lumen.fuzzy",
    "lumen.language",
    "lumen.motion",
    "lumen.project",
    "lumen.robot",
)
"""The packages whose code affects a simulated motion's outcome; `lumen.project` builds the body and the passages."""


class OutcomeCache:
    """Keeps outcomes by the data that they depend on: the motion, the models, the imperfections and the engine's code.

    An unwritable folder or an unreadable file is ignored.
    """

    def __init__(self, project: Project, files: Mapping[str, bytes]) -> None:
        self._folder = home_of(Path(project.root)) / "physics"
        robot, hall = model_files(project)
        folders = {Path(project.root) / MODELS, robot, (robot / hall).parent}
        models = {path: path.read_bytes() for each in folders for path in sorted(each.rglob("*")) if path.is_file()}
        passages = {file: content for file, content in files.items() if file.startswith("models/passages/")}
        shapes = [content for path, content in models.items() if path.parent.name != "passages"]
        self._models = _digest(
            [*shapes, project.hall.encode(), repr(project.section(Imperfections)).encode(), _engine().encode()]
        )
        self._passages = _digest(passages.values())

    def recall(self, case: Case) -> dict[int, Outcome]:
        """Return a case's known outcomes by robot number; empty if none are known."""
        try:
            data = json.loads(self._file(case).read_text(encoding="utf-8"))
            return {int(number): Outcome.from_json(outcome) for number, outcome in data.items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return {}

    def keep(self, case: Case, outcomes: Mapping[int, Outcome]) -> None:
        """Keep a case's outcomes; delete the outcomes of its earlier versions. Ignore errors of the disk."""
        file = self._file(case)
        draft = file.with_suffix(f".{os.getpid()}")
        try:
            if not file.exists():
                private_folder(self._folder.parent)
                self._folder.mkdir(exist_ok=True)
                for old in self._folder.glob(f"{_name(case)}-*.json"):
                    old.unlink()
            text = json.dumps({number: outcome.to_json() for number, outcome in outcomes.items()})
            draft.write_text(text, encoding="utf-8")
            os.replace(draft, file)
        except OSError:
            draft.unlink(missing_ok=True)

    def _file(self, case: Case) -> Path:
        passages = self._passages if case.passage or case.before else ""
        parts = [encode_motion(case.motion), [_said(command) for command in case.before], _said(case.command)]
        digest = _digest([json.dumps(parts, sort_keys=True).encode(), self._models.encode(), passages.encode()])
        return self._folder / f"{_name(case)}-{digest[:20]}.json"


def _engine() -> str:
    return f"{code_hash(*CODE)} {version('mujoco')}"


def _said(command: object) -> Any:
    return encode_motion(command.motion) if isinstance(command, Perform) else repr(command)


def _name(case: Case) -> str:
    return re.sub(r"[^\w-]", "_", f"{case.motion.name}-{case.way}".replace(" ", "-"))


def _digest(contents: Iterable[bytes]) -> str:
    total = hashlib.sha256()
    for content in contents:
        total.update(hashlib.sha256(content).digest())
    return total.hexdigest()
