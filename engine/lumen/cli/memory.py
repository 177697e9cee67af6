"""`lumen memory`: who and what the database module knows, and forgetting somebody for good."""

import argparse
import json
import time
from datetime import datetime
from pathlib import Path

from lumen.errors import UsageError
from lumen.loading.packaged import find_project
from lumen.modules.eyes.eyes import FACES_FILE
from lumen.modules.memory import Store
from lumen.modules.memory.memory import DATABASE_FILE
from lumen.runtime.home import home_of

WHATS = ("visitors", "journal", "forget")


def configure(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("what", choices=WHATS, help="list the visitors or the journal, or forget a visitor for good")
    add("name", nargs="?", metavar="NAME", help="forget: whom; journal: only what is about them")
    add("--project", metavar="PROJECT", help="its folder; default: here or above, else the shipped one")
    add("--limit", metavar="N", type=int, default=50, help="journal: the newest so many entries (default: 50)")
    add("--format", choices=("text", "json"), default="text", help="how to print it (default: text)")


def run(options: argparse.Namespace) -> int:
    file = home_of(find_project(options.project)) / DATABASE_FILE
    if not file.exists():
        raise UsageError(f"nothing is remembered: there is no {file}")
    store = Store(file)
    try:
        return _run(options, store, file)
    finally:
        store.close()


def _run(options: argparse.Namespace, store: Store, file: Path) -> int:
    """Raises UsageError where a name is missing or not known, ModuleError where the database can't be used."""
    if options.what == "forget":
        if not (options.name or "").strip():
            raise UsageError("say whom: `lumen memory forget NAME`")
        faces = _faces(options.name, file.with_name(FACES_FILE))
        visitors, entries = store.forget(options.name)
        told = f"forgot {options.name}: {visitors} visitors, {entries} entries, {faces} pictures"
        print(
            json.dumps({"visitors": visitors, "entries": entries, "pictures": faces})
            if options.format == "json"
            else told
        )
        return 0 if visitors or entries or faces else 1
    rows = (
        store.visitors()
        if options.what == "visitors"
        else store.journal(visitor=options.name or "", limit=options.limit)
    )
    if options.format == "json":
        print(json.dumps(rows, ensure_ascii=False))
        return 0
    for row in rows:
        print(_visitor(row) if options.what == "visitors" else _entry(row))
    print(f"{len(rows)} {'visitors' if options.what == 'visitors' else 'entries'}; {file}")
    return 0


def _faces(name: str, file: Path) -> int:
    """Delete the pictures that the eyes keep under that name; how many. Raises ModuleError where that can't be done."""
    if not file.exists():
        return 0
    from lumen.modules.eyes.gallery import FaceGallery  # OpenCV takes its time to import

    return FaceGallery(file, time.time).forget(name)


def _visitor(row: dict[str, object]) -> str:
    return _plain(f"{_when(row['last'])}  {row['name']}, visits: {row['visits']}")


def _entry(row: dict[str, object]) -> str:
    about = f" [{row['visitor']}]" if row["visitor"] else ""
    return _plain(f"{_when(row['time'])}  {row['kind']:<10} {row['text']}{about}")


def _when(moment: object) -> str:
    return datetime.fromtimestamp(float(str(moment))).isoformat(" ", "seconds")


def _plain(text: str) -> str:
    """The text on one line, without signs that would steer the terminal."""
    return "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
