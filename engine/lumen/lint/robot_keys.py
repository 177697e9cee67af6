"""Rewriting of routes with keys of 2015: their new keys contain the robot's name, and the old key becomes the alias.

No version of the vocabulary requires the new keys: for one robot the old keys are right. Two robots on one broker need
the new keys.
"""

from collections.abc import Mapping

from lumen.errors import UsageError
from lumen.language.routing_keys import DEFAULT_ALIASES, DEFAULT_KEYS
from lumen.language.text_lines import lines_and_breaks
from lumen.lint.fixes import Edit, edited
from lumen.lint.upgrading import Rewriting
from lumen.project.document import Document
from lumen.project.project_folders import MAIN_FILE
from lumen.project.yaml_reader import parse

NEW_KEYS: Mapping[str, str] = {alias: DEFAULT_KEYS[name] for name, alias in DEFAULT_ALIASES.items()}
"""The current keys, by the keys of 2015 that they replace."""


def with_robot_keys(files: Mapping[str, bytes]) -> tuple[dict[str, bytes], list[Rewriting]]:
    """Return the files with `{robot}` in the keys of their routes, and the rewritten places, as they were before.

    Raises UsageError if lumen.yaml can't be read, or its layout requires rewriting by hand.
    """
    document, old = _main(files), old_keys(files)
    done = {name: _rewriting(document, name, key) for name, key in old.items()}
    edits = [Edit(each.place, each.text) for each in dict.fromkeys(done.values())]
    after = {**files, MAIN_FILE: edited(files[MAIN_FILE], edits)}
    _check(after[MAIN_FILE], document, old)
    return after, list(done.values())


def old_keys(files: Mapping[str, bytes]) -> dict[str, str]:
    """Return the keys of 2015 that a project's routes have without an alias, by the names of the routes.

    Raises UsageError if lumen.yaml can't be read.
    """
    document = _main(files)
    routes = document.data.get("routes") if isinstance(document.data, Mapping) else None
    rows = routes.items() if isinstance(routes, Mapping) else ()
    return {
        name: row["key"]
        for name, row in rows
        if isinstance(row, Mapping) and "alias" not in row and row.get("key") in NEW_KEYS
    }


def _main(files: Mapping[str, bytes]) -> Document:
    document = parse(MAIN_FILE, files[MAIN_FILE])[0] if MAIN_FILE in files else None
    if document is None:
        raise UsageError(f"{MAIN_FILE} can't be read, so nothing is rewritten: run `lumen lint` to see why")
    return document


def _rewriting(document: Document, name: str, key: str) -> Rewriting:
    route, value = document.spans[("routes", name)].value, document.spans[("routes", name, "key")].value
    lines, breaks = lines_and_breaks(document.text)
    within_braces = lines[route.line - 1][route.column - 1 :].startswith("{")
    column = document.place(("routes", name, "key"), key=True).column
    line_break = breaks[value.line - 1] or "\n"
    between = ", " if within_braces else line_break + " " * (column - 1)
    why = f"the key of `{name}` now contains the robot's name; its alias is the old key `{key}`"
    return Rewriting(value, why, f'"{NEW_KEYS[key]}"{between}alias: {key}')


def _check(content: bytes, before: Document, old: Mapping[str, str]) -> None:
    """Raise UsageError if the edited text does not have the intended meaning, which happens with YAML anchors."""
    now = parse(MAIN_FILE, content)[0]
    wanted = dict(before.data)
    if old:
        wanted["routes"] = {
            name: {**row, "key": NEW_KEYS[old[name]], "alias": old[name]} if name in old else row
            for name, row in wanted["routes"].items()
        }
    if now is None or now.data != wanted:
        name, key = next(iter(old.items()))
        raise UsageError(
            f"{MAIN_FILE}: the route `{name}` can't be rewritten automatically:"
            f' write `key: "{NEW_KEYS[key]}", alias: {key}` in it'
        )
