"""`lumen diff`: list the changes from one version of a project to another, and the outcome of a reload."""

import argparse
import json
from pathlib import Path
from typing import Any

from lumen.cli.progress import progress
from lumen.cli.replay_text import replay_lines
from lumen.cli.terminal import coloured, paint
from lumen.insight.changes import Change, Risk, changes, live, risk, summary
from lumen.run.reload.against import MigrationOutcome, MigrationPreview, outcome_of, preview
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.replaying.other_files import against
from lumen.run.replaying.replay_report import ReplayReport
from lumen.run.versions import LIVE, Version, version

BOUND = 10_000
COLOURS = {"refused": "red", "waits": "yellow", "moved": "blue", "kept": "green"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen diff` to its parser."""
    which = f"a folder, a revision of this project (HEAD~1), or `{LIVE}`: the files that are running now"
    parser.add_argument("old", metavar="OLD", help=which)
    parser.add_argument(
        "new", metavar="NEW", nargs="?", help="the other version, in the same form (default: this folder or one above)"
    )
    parser.add_argument(
        "--configurations", action="store_true", help="show the outcome of a reload in every configuration"
    )
    parser.add_argument("--visits", action="store_true", help="play every recorded visit with NEW")
    parser.add_argument(
        "--bound", type=int, metavar="N", default=BOUND, help=f"explore at most N configurations (default: {BOUND:,})"
    )
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Print the differences; return 1 if a reload would be refused, now or in an explored configuration, else 0."""
    old, new = version(options.old), version(options.new)
    found = changes(old.project, new.project)
    visits = _visits(new) if options.visits else None
    running = outcome_of(old.project, live(old.project, new.project), old.snapshot) if old.snapshot else None
    everywhere = _fates(old, new, options.bound) if options.configurations else None
    if options.format == "json":
        body = _json(old, new, found, running, everywhere) | ({"visits": visits.to_json()} if visits else {})
        print(json.dumps(body, indent=2, ensure_ascii=False))
    else:
        print("\n".join(_text(found, running, everywhere, coloured())))
        if visits:
            print("\n".join(replay_lines(visits, other=True)))
    said = (*(everywhere.rows if everywhere else ()), *([running] if running else ()))
    return int(any(fate.outcome == "refused" for fate in said))


def _visits(new: Version) -> ReplayReport:
    """Replay the recorded visits of the project in this folder with the new files, and compare."""
    root = Path(new.project.root)
    robot = new.project.one_of_several
    return against(chosen(root, None, all=True, robot=robot).entries(), KeptBundles(root, robot), new.project)


def _fates(old: Version, new: Version, bound: int) -> MigrationPreview:
    with progress(at_most=True) as tell:
        return preview(
            old.project,
            live(old.project, new.project),
            bound,
            lambda walked, waiting: tell(walked, bound, f"configurations, {waiting:,} more to explore"),
        )


def _text(
    found: tuple[Change, ...], running: MigrationOutcome | None, everywhere: MigrationPreview | None, colour: bool
) -> list[str]:
    lines = []
    file = ""
    for change in found:
        if change.file != file:
            file = change.file
            lines.append(paint(file, "bold", on=colour))
        mark = f" ({change.risk})" if change.risk is not Risk.COSMETIC else ""
        lines.append(f"  {change}{mark}")
    count = f"{len(found)} change{'s' * (len(found) != 1)}, risk: {risk(found)}" if found else summary(found)
    lines.append(paint(count, "bold", on=colour))
    if running:
        lines += ["", f"now: {_row(running, colour)}"]
    if everywhere:
        lines += ["", *_table(everywhere, colour)]
    return lines


def _table(everywhere: MigrationPreview, colour: bool) -> list[str]:
    lines = [_row(fate, colour) for fate in everywhere.rows]
    counts = {outcome: sum(fate.count for fate in everywhere.rows if fate.outcome == outcome) for outcome in COLOURS}
    told = ", ".join(f"{number:,} {outcome}" for outcome, number in counts.items() if number)
    more = (
        f"; {everywhere.waiting:,} were not explored further: pass a larger `--bound N`" if everywhere.waiting else ""
    )
    return [*lines, paint(f"{everywhere.configurations:,} configurations: {told}{more}", "bold", on=colour)]


def _row(fate: MigrationOutcome, colour: bool) -> str:
    told = f": {fate.told}" if fate.told else f": to {', '.join(fate.after)}" if fate.outcome == "moved" else ""
    return f"{paint(f'{fate.outcome:<8}', COLOURS[fate.outcome], on=colour)}{', '.join(fate.states)}{told}"


def _json(
    old: Version,
    new: Version,
    found: tuple[Change, ...],
    running: MigrationOutcome | None,
    everywhere: MigrationPreview | None,
) -> dict[str, Any]:
    body: dict[str, Any] = {
        "old": {"name": old.name, "hash": old.project.hash},
        "new": {"name": new.name, "hash": new.project.hash},
        "summary": summary(found),
        "risk": str(risk(found)),
        "changes": [
            {"kind": c.kind, "about": c.about, "file": c.file, "risk": str(c.risk), "sentence": c.sentence}
            for c in found
        ],
    }
    if running:
        body["now"] = _fate(running)
    if everywhere:
        body["configurations"] = [_fate(fate) for fate in everywhere.rows]
        body["complete"] = not everywhere.waiting
    return body


def _fate(fate: MigrationOutcome) -> dict[str, Any]:
    row = {"states": fate.states, "outcome": fate.outcome, "after": fate.after, "told": fate.told, "count": fate.count}
    return {key: list(value) if isinstance(value, tuple) else value for key, value in row.items()}
