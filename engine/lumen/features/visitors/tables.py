"""The database's tables, and their upgrade from an earlier version."""

import sqlite3

from lumen.language.people import name_key

VERSION = 2
"""The version of the tables; version 1 had no name keys and no visit numbers."""

NEWER_TABLES = "tables of version"
"""The beginning of the error message for a newer Lumen's tables."""

_TABLES = """
CREATE TABLE IF NOT EXISTS journal (
    id INTEGER PRIMARY KEY, time REAL NOT NULL, date TEXT NOT NULL, robot TEXT NOT NULL, visitor TEXT NOT NULL,
    kind TEXT NOT NULL, text TEXT NOT NULL, data TEXT NOT NULL,
    key TEXT NOT NULL DEFAULT '', visit INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX IF NOT EXISTS journal_time ON journal (time);
CREATE INDEX IF NOT EXISTS journal_visit ON journal (visit);
CREATE TABLE IF NOT EXISTS visitors (
    key TEXT PRIMARY KEY, name TEXT NOT NULL, first REAL NOT NULL, last REAL NOT NULL,
    visits INTEGER NOT NULL, data TEXT NOT NULL
);
"""
_FIRST = {
    "journal": {"id", "time", "date", "robot", "visitor", "kind", "text", "data"},
    "visitors": {"name", "first", "last", "visits", "data"},
}
_NOW = {"journal": _FIRST["journal"] | {"key", "visit"}, "visitors": _FIRST["visitors"] | {"key"}}


def check(db: sqlite3.Connection) -> None:
    """Raise sqlite3.OperationalError if tables with these names belong to another program or a newer Lumen.

    This writes nothing.
    """
    if (written := db.execute("PRAGMA user_version").fetchone()[0]) > VERSION:
        raise sqlite3.OperationalError(f"{NEWER_TABLES} {written}")
    for table in _NOW:
        if _columns(db, table) not in (set(), _FIRST[table], _NOW[table]):
            raise sqlite3.OperationalError(f"no such column in {table}")


def prepare(db: sqlite3.Connection) -> None:
    """Create missing tables, or upgrade version 1 completely. Raises sqlite3.Error, without an upgrade, on failure."""
    if _columns(db, "visitors") == _FIRST["visitors"]:
        with db:
            db.execute("BEGIN IMMEDIATE")
            _bring_up(db)
    db.executescript(_TABLES)
    db.execute(f"PRAGMA user_version = {VERSION}")


def _bring_up(db: sqlite3.Connection) -> None:
    """Upgrade version 1: merge visitors whose names have the same key, and assign older entries to no visit (0)."""
    db.create_function("name_key", 1, name_key)
    db.execute("ALTER TABLE journal ADD COLUMN key TEXT NOT NULL DEFAULT ''")
    db.execute("ALTER TABLE journal ADD COLUMN visit INTEGER NOT NULL DEFAULT 0")
    db.execute("UPDATE journal SET key = name_key(visitor)")
    db.execute("ALTER TABLE visitors RENAME TO known")
    db.execute(_TABLES[_TABLES.index("CREATE TABLE IF NOT EXISTS visitors") :].strip().rstrip(";"))
    db.execute("""INSERT INTO visitors
        SELECT name_key(name), name, min(first), max(last), sum(visits), data FROM known GROUP BY name_key(name)""")
    db.execute("DROP TABLE known")


def _columns(db: sqlite3.Connection, table: str) -> set[str]:
    return {row[1] for row in db.execute(f"PRAGMA table_info({table})").fetchall()}
