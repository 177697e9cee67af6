"""The journal and the visitors in an SQLite file that its owner alone may read."""

import json
import os
import re
import sqlite3
from collections.abc import Mapping, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import ModuleError

LOCK_TIMEOUT = 0.5
"""How long a locked database is waited for [s]."""
MAX_ROWS = 1_000
"""Rows of one answer."""

_TABLES = """
CREATE TABLE IF NOT EXISTS journal (
    id INTEGER PRIMARY KEY, time REAL NOT NULL, date TEXT NOT NULL, robot TEXT NOT NULL,
    visitor TEXT NOT NULL COLLATE NOCASE, kind TEXT NOT NULL, text TEXT NOT NULL, data TEXT NOT NULL
);
CREATE INDEX IF NOT EXISTS journal_time ON journal (time);
CREATE TABLE IF NOT EXISTS visitors (
    name TEXT PRIMARY KEY COLLATE NOCASE, first REAL NOT NULL, last REAL NOT NULL,
    visits INTEGER NOT NULL, data TEXT NOT NULL
);
"""


class JournalEntry(NamedTuple):
    """A row of the journal: when [s since 1970], what kind of thing, who the visitor was (empty: unknown), what."""

    time: float
    robot: str
    visitor: str
    kind: str
    text: str
    data: Mapping[str, Any] = {}


class Store:
    """The database in `file`; without one, in this process's own memory, and gone with it.

    Whatever SQLite can't do is a ModuleError in one line, and the next call tries again. What is deleted is
    overwritten.
    It belongs to the thread that uses it first.
    """

    def __init__(self, file: Path | None) -> None:
        self._file = file
        self._connection: sqlite3.Connection | None = None
        self._unclean = False

    def add(self, entries: Sequence[JournalEntry]) -> None:
        """Write all of them, or (ModuleError) none."""
        rows = [
            (e.time, _date(e.time), e.robot, _sound(e.visitor), _sound(e.kind), _sound(e.text), _json(e.data))
            for e in entries
        ]
        sql = "INSERT INTO journal (time, date, robot, visitor, kind, text, data) VALUES (?, ?, ?, ?, ?, ?, ?)"
        self._do(lambda db: db.executemany(sql, rows))

    def met(self, name: str, now: float, data: Mapping[str, Any] | None = None) -> None:
        """Somebody of that name came, once more or for the first time; what is known of them is added to."""
        name = _sound(name)
        known = self.visitor(name)
        known_data = _json({**(known["data"] if known else {}), **(data or {})})
        sql = """INSERT INTO visitors VALUES (?, ?, ?, 1, ?)
            ON CONFLICT (name) DO UPDATE SET last = excluded.last, visits = visits + 1, data = excluded.data"""
        self._do(lambda db: db.execute(sql, (name, now, now, known_data)))

    def visitor(self, name: str) -> dict[str, Any] | None:
        """What is known of somebody, None where nothing is."""
        sql = "SELECT * FROM visitors WHERE name = ?"
        rows = self._do(lambda db: db.execute(sql, (_sound(name),)).fetchall())
        return _visitor(rows[0]) if rows else None

    def visitors(self) -> list[dict[str, Any]]:
        """Everybody, who came last first."""
        sql = "SELECT * FROM visitors ORDER BY last DESC, name LIMIT ?"
        return [_visitor(row) for row in self._do(lambda db: db.execute(sql, (MAX_ROWS,)).fetchall())]

    def journal(self, *, since: float = 0.0, visitor: str = "", limit: int = 100) -> list[dict[str, Any]]:
        """The newest entries, the oldest of them first."""
        sql = "SELECT * FROM journal WHERE time >= ? AND (? = '' OR visitor = ?) ORDER BY time DESC, id DESC LIMIT ?"
        found = self._do(
            lambda db: db.execute(
                sql, (float(since), _sound(visitor), _sound(visitor), min(limit, MAX_ROWS))
            ).fetchall()
        )
        return [{**dict(row), "data": json.loads(row["data"])} for row in reversed(found)]

    def forget(self, name: str) -> tuple[int, int]:
        """Delete all that is known of somebody; how many visitors and journal entries that were.

        Of the journal: what was noted while they were there, and whatever names them. Raises ModuleError also where
        that is deleted and can still be read in the file, because another program looks at it as it was.
        """
        name = _sound(name)
        word = re.compile(rf"(?<!\w){re.escape(name.strip())}(?!\w)", re.IGNORECASE)

        def delete(db: sqlite3.Connection) -> tuple[int, int]:
            db.create_function("names", 1, lambda text: bool(word.search(text)))
            gone = db.execute("DELETE FROM visitors WHERE name = ? OR names(data)", (name.strip(),)).rowcount
            sql = "DELETE FROM journal WHERE visitor = ? OR names(visitor) OR names(text) OR names(data)"
            return gone, db.execute(sql, (name.strip(),)).rowcount

        found: tuple[int, int] = self._do(delete)
        self._unclean = True
        self._clean()
        return found

    def expire(self, before: float) -> int:
        """Delete what is older than that time [s since 1970], and who was not there since; how many rows."""
        sql = (("DELETE FROM journal WHERE time < ?"), ("DELETE FROM visitors WHERE last < ?"))
        gone = int(self._do(lambda db: sum(db.execute(one, (before,)).rowcount for one in sql)))
        self._unclean = self._unclean or gone > 0
        if self._unclean:
            self._clean()
        return gone

    def close(self) -> None:
        """Harmless when repeated."""
        if self._connection:
            with suppress(sqlite3.Error):
                self._connection.close()
            self._connection = None

    def _clean(self) -> None:
        """Leave nothing of what was deleted in the file that SQLite writes ahead."""
        busy = self._do(lambda db: db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0])
        if busy:
            raise ModuleError(
                f"{self._file} is read by another program, and keeps what was deleted until that is closed"
            )
        self._unclean = False

    def _do(self, work: Any) -> Any:
        try:
            db = self._connection or self._open()
            with db:
                return work(db)
        except (sqlite3.Error, OSError, OverflowError) as error:
            self.close()
            raise ModuleError(self._why(error)) from None

    def _open(self) -> sqlite3.Connection:
        if self._file:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            os.close(os.open(self._file, os.O_RDWR | os.O_CREAT, 0o600))
        db = sqlite3.connect(self._file or ":memory:", timeout=LOCK_TIMEOUT)
        self._connection = db
        db.row_factory = sqlite3.Row
        db.execute("PRAGMA secure_delete = ON")
        db.execute("PRAGMA journal_mode = WAL")
        db.executescript(_TABLES)
        return db

    def _why(self, error: Exception) -> str:
        file = self._file or "the database"
        text = str(error)
        if "locked" in text or "busy" in text:
            return f"{file} is locked by another program: close that, what happens meanwhile is kept and written then"
        if "not a database" in text or "malformed" in text:
            return f"{file} is no SQLite database, or is damaged: move it away, and a new one is begun"
        if (
            "no such column" in text
            or "has no column" in text
            or "values for" in text
            or "values were supplied" in text
        ):
            return f"{file} is a database of something else: move it away, and a new one is begun"
        return f"{file} can't be written: {getattr(error, 'strerror', None) or text}"


def _date(time: float) -> str:
    return datetime.fromtimestamp(time, UTC).isoformat(timespec="milliseconds")


def _visitor(row: sqlite3.Row) -> dict[str, Any]:
    return {**dict(row), "data": json.loads(row["data"])}


def _sound(text: str) -> str:
    """The text as a file can hold it: half characters, which JSON may bring, are replaced."""
    return text.encode("utf-8", "replace").decode()


def _json(data: Mapping[str, Any]) -> str:
    return _sound(json.dumps(data, ensure_ascii=False))
