"""Motions from files and dicts: sample their joint angles."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Self

from lumen.errors import ProjectError
from lumen.language import motions
from lumen.language.diagnostics import has_errors
from lumen.motion.limits import Excess, beyond_limits, overspeed
from lumen.motion.trajectories import Trajectory
from lumen.project.building import motion_parts
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft, body_of
from lumen.project.files import read_files
from lumen.project.motions import build_motion, countable
from lumen.project.packaged import find_project, shipped_root
from lumen.project.plain import derived, read_document
from lumen.project.project_folders import MAIN_FILE
from lumen.project.schema import check_schema
from lumen.upkeep.arguments import need_map, need_number, need_numbers, need_path, need_text

__all__ = ["Excess", "Motion", "Trajectory", "beyond_limits", "overspeed"]


class Motion(motions.MotionDefinition):
    """A motion whose joint angles can be sampled; it is compiled at the first sample."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the motion in a file, for the robot of the file's project, otherwise of the project here or above.

        It may play the other motions of that project. Raises UsageError if the file can't be read, ProjectError if it
        has mistakes.
        """
        path = need_path(path)
        return cls._build(read_document(path), path.stem, motion_parts(read_files(_home(path))))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], name: str = "motion") -> Self:
        """Return the motion in a dict with the structure of a file, for the default robot.

        Raises ProjectError if it has mistakes.
        """
        need_text(name, "the name of a motion")
        need_map(data, "the data of a motion")
        return cls._build(Document(name, data), name, motion_parts(read_files(shipped_root())))

    @classmethod
    def _build(cls, document: Document, name: str, around: ProjectDraft) -> Self:
        report, body = DocumentReport(document), body_of(around)
        if not countable(document.data, report):
            raise ProjectError(report.diagnostics)
        data = check_schema(document, "motion", report)
        others = {other: motion for other, motion in around.motions.items() if other != name}
        broken = around.names["motions"]
        motion = build_motion(data, report, name=name, body=body, motions=others, broken=broken)
        if motion is None or has_errors(report.diagnostics):
            raise ProjectError(report.diagnostics)
        return derived(cls, motion)

    @cached_property
    def _trajectory(self) -> Trajectory:
        return Trajectory(self)

    def sample(self, t: float, start: Mapping[str, float] | None = None) -> dict[str, float]:
        """Return the angle [rad; a hand 0..1] at `t` [s] of every joint that the motion moves.

        It begins at the angles `start` [rad] if they are given, otherwise in its start posture. Raises UsageError for
        arguments that are not numbers.
        """
        need_number(t, "the time to sample at", finite=False)
        if start is not None:
            need_numbers(start, "`start`")
        return self._trajectory.sample(t) if start is None else Trajectory(self, start).sample(t)


def _home(path: Path) -> Path:
    """Return the project of a motion file: two folders up, otherwise the project here or above."""
    folder = path.absolute().parent
    beside = any((folder.parent / name).exists() for name in (MAIN_FILE, "models"))
    return folder.parent if folder.name == "motions" and beside else find_project()
