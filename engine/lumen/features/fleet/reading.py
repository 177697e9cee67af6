"""Reads fleet.yaml into a `Fleet`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lumen.features.fleet.settings import DEFAULT_PAUSE, Fleet, RolloutPlan, StepTarget, step_target
from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath
from lumen.project.built_file import BuiltFile, read_file
from lumen.project.document_report import DocumentReport
from lumen.project.files import MAX_FILE_BYTES
from lumen.project.project_folders import FLEET_FILE
from lumen.project.routes import duration
from lumen.project.sections import read_fields
from lumen.upkeep.regular_files import read_regular

BAD_SHARE = Code("bad-share", "fleet", ERROR, "a rollout step is not a valid share of the robots")


def build_fleet(data: Any, report: DocumentReport, *, name: str) -> Fleet | None:
    """Return the fleet in the data of fleet.yaml; None if the data is not a map.

    The data has the shape of fleet.schema.json, but may lack any key.
    """
    if not isinstance(data, Mapping):
        return None
    centre, rollout = data.get("centre", {}).get("broker", ""), _rollout(data.get("rollout", {}), report)
    return read_fields(Fleet, data, centre=centre, rollout=rollout)


def read_fleet(root: Path) -> tuple[BuiltFile[Fleet] | None, list[Diagnostic]]:
    """Return the fleet in a folder and the findings about it; None if fleet.yaml is missing or unreadable."""
    try:
        content = read_regular(root / FLEET_FILE, MAX_FILE_BYTES)
    except OSError:
        return None, []
    return read_file(FLEET_FILE, content, "fleet", build_fleet)


def _rollout(data: Mapping[str, Any], report: DocumentReport) -> RolloutPlan:
    where: NodePath = ("rollout",)
    rows = [_step(row, report, (*where, "steps", i)) for i, row in enumerate(data.get("steps", ()))]
    steps = tuple(row for row in rows if row is not None)
    pause = duration(data, "pause", report, where)
    return RolloutPlan(
        steps or RolloutPlan().steps,
        DEFAULT_PAUSE if pause is None else pause,
        str(data.get("abort-if", "")),
        bool(data.get("try", False)),
    )


def _step(row: Mapping[str, Any], report: DocumentReport, where: NodePath) -> StepTarget | None:
    target = step_target(row["to"])
    if target is None:
        hint = "write a share of more than 0 % and at most 100 %, such as `10%`, the name of a group, or `all`"
        report(BAD_SHARE, (*where, "to"), f"`{row['to']}` is not a share of the robots", hint)
    return target
