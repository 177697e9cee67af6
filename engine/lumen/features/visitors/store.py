"""The journal and the visitors in an SQLite file that only its owner can read."""

import json
import os
import sqlite3
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import ModuleError
from lumen.features.visitors.tables import NEWER_TABLES, check, prepare
from lumen.features.visitors.visit import JournalEnd
from lumen.language.iso_time import iso_time
from lumen.language.people import PersonName, name_key
from lumen.upkeep.own_folders import private_folder

LOCK_TIMEOUT = 0.5
"""The maximum wait for a locked database [s]."""
MAX_ROWS = 1_000
"""The maximum number of rows in one answer."""

_VISITOR = "name, first, last, visits, data"
_ENTRY = "id, time, date, robot, visit, visitor, kind, text, data"
_THEIRS = """SELECT id, visit FROM journal
    WHERE key = :key OR names(text) OR holds(data) OR visit > 0 AND visit IN (
        SELECT visit FROM journal GROUP BY visit
        HAVING sum(key = :key) > 0 OR sum(kind = 'recognised' AND same(text)) > 0 AND max(key) = '')"""


class JournalEntry(NamedTuple):
    """A row of the journal."""

    time: float
    """The entry's time [s since 1970]."""
    robot: str
    visitor: str
    """The visitor's name; empty if unknown."""
    kind: str
    """The kind of entry."""
    text: str
    data: Mapping[str, Any] = {}
    visit: int = 0
    """The visit's number, which all its entries share; 0 if unknown."""


class Forgotten(NamedTuple):
    """The counts of a person's deleted data."""

    visitors: int
    """The number of deleted visitors."""
    entries: int
    """The number of deleted journal entries."""
    visits: frozenset[int] = frozenset()
    """The numbers of the visits to which the deleted entries belonged."""
    others: tuple[str, ...] = ()
    """Names of other visitors that contain the name, as `Ana Maria` contains `Ana`."""


class Store:
    """The database in `file`, or in this process's memory if `file` is None.

    SQLite's errors become one-line ModuleErrors, and the next call tries again. Deleted data is overwritten. Only the
    thread that first uses the store can use it.
    """

    def __init__(self, file: Path | None) -> None:
        self._file = file
        self._connection: sqlite3.Connection | None = None
        self._unclean = False

    def add(self, entries: Sequence[JournalEntry]) -> None:
        """Write all entries. Raises ModuleError, and writes no entry, if that fails."""
        rows = [
            (
                *(
                    e.time,
                    iso_time(e.time, offset=True),
                    e.robot,
                    _sound(e.visitor),
                    _sound(e.kind),
                    _sound(e.text),
                    _json(e.data),
                ),
                *(name_key(e.visitor), e.visit),
            )
            for e in entries
        ]
        sql = """INSERT INTO journal (time, date, robot, visitor, kind, text, data, key, visit)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"""
        self._do(lambda db: db.executemany(sql, rows))

    def met(self, name: str, now: float, data: Mapping[str, Any] | None = None) -> None:
        """Count a visit of the person with this name at `now` [s since 1970]; add `data` to the person's data."""
        name = _sound(name)
        known = self.visitor(name)
        known_data = _json({**(known["data"] if known else {}), **(data or {})})
        sql = """INSERT INTO visitors (key, name, first, last, visits, data) VALUES (?, ?, ?, ?, 1, ?)
            ON CONFLICT (key) DO UPDATE SET last = excluded.last, visits = visits + 1, data = excluded.data"""
        self._do(lambda db: db.execute(sql, (name_key(name), name, now, now, known_data)))

    def visitor(self, name: str) -> dict[str, Any] | None:
        """Return the stored data of a visitor; None if the visitor is unknown."""
        sql = f"SELECT {_VISITOR} FROM visitors WHERE key = ?"
        rows = self._do(lambda db: db.execute(sql, (name_key(name),)).fetchall())
        return _visitor(rows[0]) if rows else None

    def visitors(self) -> list[dict[str, Any]]:
        """Return the visitors, the most recent first, at most `MAX_ROWS`."""
        sql = f"SELECT {_VISITOR} FROM visitors ORDER BY last DESC, name LIMIT ?"
        return [_visitor(row) for row in self._do(lambda db: db.execute(sql, (MAX_ROWS,)).fetchall())]

    def journal(self, *, since: float = 0.0, visitor: str = "", limit: int = 100) -> list[dict[str, Any]]:
        """Return the newest entries since a time [s since 1970], the oldest of them first.

        At most `limit` entries are returned, and at most `MAX_ROWS`. With a `visitor`, only entries of their visits are
        returned.
        """
        sql = f"""SELECT {_ENTRY} FROM journal WHERE time >= :since AND (:key = '' OR key = :key OR visit IN
            (SELECT visit FROM journal WHERE key = :key AND visit > 0)) ORDER BY time DESC, id DESC LIMIT :limit"""
        given = {"since": float(since), "key": name_key(visitor), "limit": min(limit, MAX_ROWS)}
        found = self._do(lambda db: db.execute(sql, given).fetchall())
        return [{**dict(row), "data": json.loads(row["data"])} for row in reversed(found)]

    def end(self) -> JournalEnd:
        """Return the journal's last visit, with the time of its newest entry; `JournalEnd()` without visits."""
        sql = "SELECT visit, time, visitor FROM journal WHERE visit > 0 ORDER BY id DESC LIMIT 1"
        rows = self._do(lambda db: db.execute(sql).fetchall())
        return JournalEnd(*rows[0]) if rows else JournalEnd()

    def forget(self, name: str) -> Forgotten:
        """Delete everything about a person: their row, their whole visits, and all entries and data that name them.

        A visit is theirs if the behaviour knew their name, or if it knew no name and their face was recognised. Raises
        ModuleError on failure, and if another program has the file open, which keeps the deleted data readable in it.
        """
        found: Forgotten = self._do(lambda db: _delete(db, name_key(name)))
        self._unclean = True
        self._clean()
        return found

    def expire(self, before: float) -> int:
        """Delete entries before a time [s since 1970] and visitors not seen since; return the number of rows."""
        sql = (("DELETE FROM journal WHERE time < ?"), ("DELETE FROM visitors WHERE last < ?"))
        gone = int(self._do(lambda db: sum(db.execute(one, (before,)).rowcount for one in sql)))
        self._unclean = self._unclean or gone > 0
        if self._unclean:
            self._clean()
        return gone

    def close(self) -> None:
        """Close the database; further calls do nothing."""
        if self._connection:
            with suppress(sqlite3.Error):
                self._connection.close()
            self._connection = None

    def _clean(self) -> None:
        """Remove deleted data from SQLite's write-ahead log.

        Raises ModuleError if another program has the file open.
        """
        busy = self._do(lambda db: db.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0])
        if busy:
            raise ModuleError(
                f"{self._file} is open in another program: close that program to remove the deleted "
                "entries from the file"
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
            private_folder(self._file.parent)
            os.close(os.open(self._file, os.O_RDWR | os.O_CREAT, 0o600))
        db = sqlite3.connect(self._file or ":memory:", timeout=LOCK_TIMEOUT)
        self._connection = db
        db.row_factory = sqlite3.Row
        check(db)
        db.execute("PRAGMA secure_delete = ON")
        db.execute("PRAGMA journal_mode = WAL")
        prepare(db)
        return db

    def _why(self, error: Exception) -> str:
        file = self._file or "the database"
        text = str(error)
        if "locked" in text or "busy" in text:
            return (
                f"{file} is locked by another program: close that program; Lumen keeps new entries and "
                "writes them afterwards"
            )
        if text.startswith(NEWER_TABLES):
            return f"{file} was written by a newer Lumen: use that version, or move the file away to start a new one"
        if "not a database" in text or "malformed" in text:
            return f"{file} is not an SQLite database or is damaged: move it away to start a new one"
        if (
            "no such column" in text
            or "has no column" in text
            or "values for" in text
            or "values were supplied" in text
        ):
            return f"{file} is a database of another program: move it away to start a new one"
        return f"{file} cannot be written: {getattr(error, 'strerror', None) or text}"


def _delete(db: sqlite3.Connection, key: str) -> Forgotten:
    """Delete the data of the person with this key, as `Store.forget` describes; return the counts."""
    known = {row["key"]: row["name"] for row in db.execute("SELECT key, name FROM visitors").fetchall()}
    alone = PersonName(key)
    others = {other: known[other] for other in known if other != key and alone.is_named_in(other)}
    person = PersonName(key, others)
    db.create_function("names", 1, person.is_named_in)
    db.create_function("holds", 1, lambda data: person.is_in(json.loads(data)))
    db.create_function("same", 1, lambda text: name_key(text) == key)
    gone = db.execute("DELETE FROM visitors WHERE key = ?", (key,)).rowcount
    for row in db.execute("SELECT key, data FROM visitors WHERE holds(data)").fetchall():
        data = _json(person.scrubbed(json.loads(row["data"])))
        db.execute("UPDATE visitors SET data = ? WHERE key = ?", (data, row["key"]))
    rows = db.execute(_THEIRS, {"key": key}).fetchall()
    db.executemany("DELETE FROM journal WHERE id = ?", [(row["id"],) for row in rows])
    return Forgotten(gone, len(rows), frozenset(int(row["visit"]) for row in rows), tuple(others.values()))


def _visitor(row: sqlite3.Row) -> dict[str, Any]:
    return {**dict(row), "data": json.loads(row["data"])}


def _sound(text: str) -> str:
    """Return the text with lone surrogates, which JSON may contain, replaced."""
    return text.encode("utf-8", "replace").decode()


def _json(data: Mapping[str, Any]) -> str:
    return _sound(json.dumps(data, ensure_ascii=False))
