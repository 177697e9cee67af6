"""The page Day has all entries of a day at the exhibition, whatever the time zone of the machine."""

import time
from collections.abc import Iterator
from datetime import date, datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import pytest

from lumen.features.console.kept_days import KeptDays
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.journal.journal_file import FramePacker, JournalHeader, line_of
from lumen.journal.journal_folder import JOURNAL_FOLDER, JournalFolder
from lumen.language.events import Event
from lumen.project.home import home_of
from tests.explaining.guide import guide_in


@pytest.fixture
def machine_in_utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with monkeypatch.context() as here:
        here.setenv("TZ", "UTC")
        time.tzset()
        yield
    time.tzset()


def write_days(root: Path, zone: str) -> None:
    """Write the journal of three days: a sentence each half hour from 9:00 to 19:30 at the exhibition."""
    first = datetime(2026, 11, 24, 9, tzinfo=ZoneInfo(zone))
    said = [first + timedelta(days=day, minutes=30 * half) for day in range(3) for half in range(22)]
    files: dict[date, list[RecordedEntry]] = {}
    for position, moment in enumerate(said, 1):
        at = (moment - first).total_seconds()
        entries = files.setdefault(
            datetime.fromtimestamp(moment.timestamp()).date(), []
        )  # as the writer, by the machine
        if not entries:
            snapshot = {"epoch": first.timestamp(), "timezone": zone}
            entries.append(JournalJump(position + len(files) - 2, "keyframe", at, "hash", "guide", snapshot))
        entries.append(JournalInput(position + len(files) - 1, "heard", Event("heard", {"result": "hello"}, at)))
    for entries in files.values():
        began = first.timestamp() + entries[1].event.at  # type: ignore[union-attr]
        with JournalFolder(home_of(root) / JOURNAL_FOLDER, 30.0, 100.0).open(
            JournalHeader(entries[0].position, "run", "hash", began)
        ) as file:
            file.write(FramePacker().pack(b"".join(map(line_of, entries))))


@pytest.mark.parametrize("zone", ["America/Los_Angeles", "Europe/Berlin", "Australia/Sydney"])
@pytest.mark.usefixtures("machine_in_utc")
def test_a_day_is_whole_in_the_time_zone_of_the_exhibition(tmp_path: Path, zone: str) -> None:
    root = guide_in(tmp_path)
    write_days(root, zone)
    days = KeptDays(root)
    for wanted in (None, date(2026, 11, 26), date(2026, 11, 25)):
        found = days.day(wanted)
        assert found
        assert found.day == (wanted or date(2026, 11, 26))
        assert sum(found.asked.values()) == 22
        assert found.dates == [date(2026, 11, day) for day in (24, 25, 26)]
