"""The centre's counts: each incident counts once, despite kills and repeated messages."""

import random
from pathlib import Path

import pytest

from lumen.features.fleet.fleet_log import FleetLog
from lumen.features.fleet.settings import FleetMeasure
from lumen.features.rabbitmq.stream_reader import StreamEntry
from lumen.project.home import Home

NOW = 1_800_000_000.0
MEASURES = {"falls": FleetMeasure(event="fallen")}


def incident(offset: int, id: str = "", text: str = "it fell") -> StreamEntry:
    return StreamEntry(offset, "fleet.incident.itb.nao1", {"kind": "fell", "text": text}, id or f"id-{offset}")


def numbers(offset: int, robot: str, hours: float, falls: float, since: float = 0.0) -> StreamEntry:
    body = {"bundle": "a" * 64, "since": since, "counts": {"hours": hours, "falls": falls}}
    return StreamEntry(offset, f"fleet.numbers.itb.{robot}", body, f"id-{offset}")


def log_in(folder: Path) -> FleetLog:
    home = Home(folder)
    folder.mkdir(exist_ok=True)
    return FleetLog(home)


@pytest.mark.parametrize("seed", range(10))
def test_a_centre_that_is_killed_at_any_moment_counts_each_incident_once(tmp_path: Path, seed: int) -> None:
    draw = random.Random(seed)
    stream = [incident(offset, f"id-{draw.randrange(40)}") for offset in range(60)]
    log, killed = log_in(tmp_path), 0
    while log.next < len(stream):
        log.take(stream[log.next], NOW)
        if draw.random() < 0.2:
            log.save(now=True)
        elif draw.random() < 0.1:
            log, killed = log_in(tmp_path), killed + 1
    assert log.kinds == {"fell": len({entry.id for entry in stream})}
    assert killed


def test_what_a_robot_has_counted_is_its_last_word_and_not_added_up(tmp_path: Path) -> None:
    log = log_in(tmp_path)
    for offset, entry in enumerate(
        [
            numbers(0, "nao1", 1.0, 0.0),
            numbers(1, "nao1", 2.0, 1.0),
            numbers(2, "nao2", 2.0, 3.0),
            numbers(3, "nao1", 4.0, 0.0, since=9.0),
        ]
    ):
        log.take(entry._replace(offset=offset), NOW)
    log.save(now=True)
    (row,) = log_in(tmp_path).numbers(MEASURES)
    assert row == {"bundle": "a" * 64, "robots": 2, "hours": 8.0, "measures": {"falls": 0.5}}


@pytest.mark.parametrize(
    "body", [None, [], {"kind": 1, "text": "x"}, {"bundle": "x", "since": 0, "counts": {"falls": "many"}}]
)
def test_what_is_neither_is_passed_over_and_not_read_again(body: object, tmp_path: Path) -> None:
    log = log_in(tmp_path)
    for key in ("fleet.incident.itb.nao1", "fleet.numbers.itb.nao1"):
        assert log.take(StreamEntry(6, key, body, "id"), NOW) == ""
    assert (log.next, list(log.incidents), log.numbers(MEASURES)) == (7, [], [])


def test_a_file_that_says_something_else_is_none(tmp_path: Path) -> None:
    (tmp_path / "log.json").write_text('{"next": "seven", "incidents": 3}')
    assert log_in(tmp_path).next == 0
