"""`lumen alerts test`: check whether alert recipients can be reached."""

import argparse
import json

from lumen.errors import ProjectError, UsageError
from lumen.features.alerts.alert import Origin
from lumen.features.alerts.desk import AlertDesk
from lumen.features.alerts.settings import Alerts
from lumen.language.diagnostics import has_errors
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.main_file import main_settings
from lumen.project.project_folders import MAIN_FILE
from lumen.project.running_project import own_project


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen alerts` to the parser."""
    add = parser.add_argument
    add(
        "what",
        choices=("test",),
        help="send a test alert to each recipient under `alerts:` in lumen.yaml, even in quiet hours",
    )
    add("project", nargs="?", metavar="PROJECT", help="the project's folder (default: this folder or one above)")
    add("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Send a test alert to each recipient and print the results; return 0 if all alerts arrived, else 1.

    Raises ProjectError if lumen.yaml has errors, UsageError if there are no recipients.
    """
    root = own_project(options.project)
    found = [each for each in check_files(root, read_files(root))[1] if each.place.file == MAIN_FILE]
    if has_errors(found):  # else a recipient with a mistake would be left out silently
        raise ProjectError(found)
    settings = main_settings(root)
    if settings is None or not (alerts := settings.section(Alerts)).to:
        raise UsageError(f"no alert recipients: list them in {root / 'lumen.yaml'} under `alerts:`, `to:`")
    desk = AlertDesk(alerts, Origin(settings.name or root.name, settings.robot), root, lambda _: None)
    told = []
    for whom, why in desk.test():
        told.append({"to": whom, "arrived": not why, "reason": why})
        if options.format == "text":
            print(f"{'!!' if why else 'ok'} {whom}{': ' * bool(why)}{why}", flush=True)
    desk.close()
    if options.format == "json":
        print(json.dumps({"ok": all(one["arrived"] for one in told), "told": told}, ensure_ascii=False))
    return 0 if all(one["arrived"] for one in told) else 1
