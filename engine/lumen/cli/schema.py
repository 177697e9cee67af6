"""`lumen schema`: print the JSON Schemas of the YAML files, or the settings that make an editor use them."""

import argparse
import json
from pathlib import Path
from typing import Any

from lumen.cli.formats import configure_format
from lumen.cli.jsonc import added
from lumen.cli.writing import write_result
from lumen.errors import UsageError
from lumen.project.added_verbs import NO_VERBS
from lumen.project.building import draft
from lumen.project.files import MAX_FILE_BYTES, read_files
from lumen.project.packaged import find_project, schema_folder
from lumen.project.project_folders import KINDS, file_kinds
from lumen.project.schema import load_schema
from lumen.upkeep.regular_files import read_regular


def files() -> dict[str, tuple[str, ...]]:
    """Return the file patterns of a project for each kind of file."""
    return {
        kind: tuple(
            f"{path}/*{'.schema.json' if kind == 'message' else '.yaml'}" for path, of in KINDS.items() if of == kind
        )
        or (f"{kind}.yaml",)
        for kind in file_kinds()
    }


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen schema` to its parser."""
    add = parser.add_argument
    add(
        "kind",
        nargs="?",
        choices=file_kinds(),
        metavar="KIND",
        help=f"one of {', '.join(file_kinds())}; leave it out to list them",
    )
    add("--project", metavar="DIR", type=Path, help="with KIND: a project whose skills the schema lists as well")
    add("--vscode", action="store_true", help="print the VS Code settings that assign a schema to each file")
    configure_format(parser)
    add(
        "-o",
        "--output",
        metavar="FILE",
        type=Path,
        help="write to this file; with --vscode, other settings in it are kept",
    )


def run(options: argparse.Namespace) -> int:
    """Print a schema, the editor's settings, or the list of kinds; return 0.

    Raises UsageError if the file can't be written, or if the options contradict each other.
    """
    if options.project and not options.kind:
        raise UsageError("--project is for the schema of one kind: write KIND, such as `behavior`")
    if options.vscode and options.kind:
        raise UsageError("--vscode prints the settings for all kinds: leave out the kind")
    if options.vscode:
        ours = settings(find_project())
        text = _added(options.output, ours) if options.output else _json(ours)
        write_result(text, options.output, folders=True)
    elif options.kind:
        verbs = draft(read_files(find_project(options.project))).verbs if options.project else NO_VERBS
        write_result(_json(load_schema(options.kind, verbs)), options.output)
    else:
        write_result(_json(_kinds()) if options.format == "json" else _list(), options.output)
    return 0


def _kinds() -> dict[str, Any]:
    return {
        "kinds": [
            {"kind": kind, "files": list(patterns), "title": load_schema(kind).get("title", "")}
            for kind, patterns in files().items()
        ]
    }


def _list() -> str:
    wide = max(map(len, file_kinds()))
    rows = [(kind, ", ".join(patterns), load_schema(kind).get("title", "")) for kind, patterns in files().items()]
    return "\n".join(f"{kind:{wide}}  {patterns:40} {title}".rstrip() for kind, patterns, title in rows) + "\n"


def settings(root: Path) -> dict[str, Any]:
    """Return VS Code's settings that assign a schema to each file: the project's own copy, or else this Lumen's.

    A kind of file of another package is left out until the project has a copy: `lumen schema KIND -o FILE`.
    """
    found: dict[str, dict[str, Any]] = {"yaml.schemas": {}}
    for kind, patterns in files().items():
        own, file = f"schemas/{kind}.schema.json", schema_folder() / f"{kind}.schema.json"
        if not (root / own).is_file() and not file.is_file():
            continue  # a package has this schema, and no file does
        schema = f"./{own}" if (root / own).is_file() else file.as_uri()
        if kind == "message":
            match = [f"/{pattern}" for pattern in patterns]
            found["json.schemas"] = [{"fileMatch": match, "url": schema}]  # type: ignore[assignment]
        else:
            found["yaml.schemas"][schema] = list(patterns)
    return found


def _added(file: Path, ours: dict[str, Any]) -> str:
    """Return the content of a settings file with Lumen's settings added and its comments kept.

    Raises UsageError if it can't be read.
    """
    try:
        there = read_regular(file, MAX_FILE_BYTES).decode("utf-8-sig")
        return added(there, ours)
    except FileNotFoundError:
        return _json(ours)
    except (OSError, ValueError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or f"it is not JSON with comments ({error})"
        raise UsageError(f"can't add to {file}: {reason}; leave out -o, and copy the printed settings") from None


def _json(data: Any) -> str:
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
