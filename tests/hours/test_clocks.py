"""Times of day if a clock is set, an engine was away, or files are saved."""

from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.errors import SnapshotError, UsageError
from lumen.insight.exploration import explore
from lumen.insight.migration import MigrationPlan, migrate
from lumen.language.events import Event
from lumen.run.resuming import resume
from lumen.run.wall_clock_watch import WallClockWatch
from lumen.statechart import Interpreter, Machine, Snapshot, deserialize, elapse, initial, serialize, step
from tests.tables import for_each

HALL = {
    "context": {"rounds": 0},
    "states": {
        "open": {"at": {"18:00": "closed", "11:00": {"actions": {"assign": {"rounds": "context.rounds + 1"}}}}},
        "closed": {"at": {"09:00": "open"}},
    },
}


def when(text: str) -> float:
    """Return that time of Berlin's clock in s since 1970."""
    return datetime.fromisoformat(f"{text}+02:00").timestamp()


def overdue(machine: Machine, snapshot: Snapshot, now: float = 0.0) -> Snapshot:
    """Return the snapshot after everything has come that is due until then."""
    found = [snapshot]
    for taken in elapse(machine, lambda: found[-1], now):
        found.append(taken.snapshot)  # noqa: PERF401 - the next one needs it
    return found[-1]


class Hall:
    """A behaviour in real time: `pass_until` advances the machine's clock, `set` sets it."""

    def __init__(self, begin: str, data: dict[str, Any] = HALL, zone: str = "Europe/Berlin") -> None:
        self.machine, self.zone = Machine.from_dict(data), zone
        self.now, self.wall = 0.0, when(begin)
        self.watch = WallClockWatch(lambda: self.zone, real=True, clock=lambda: self.wall)
        self.snapshot: Snapshot = initial(self.machine, epoch=self.wall, timezone=zone).snapshot

    def pass_until(self, text: str) -> None:
        self.now += when(text) - self.wall
        self.wall = when(text)
        self.tick()

    def set(self, text: str) -> None:
        self.wall = when(text)
        self.tick()

    def tick(self) -> None:
        if event := self.watch.tick(lambda: self.now, self.snapshot):
            self.snapshot = step(self.machine, self.snapshot, event).snapshot
        self.snapshot = overdue(self.machine, self.snapshot, self.now)

    @property
    def where(self) -> tuple[str, int]:
        [state] = self.snapshot.configuration
        return state, self.snapshot.context["rounds"]

    @property
    def next(self) -> list[str]:
        berlin = [datetime.fromtimestamp(self.snapshot.epoch + t.due, UTC).timestamp() for t in self.snapshot.timers]
        return sorted(f"{datetime.fromtimestamp(at + 7200, UTC):%d %H:%M}" for at in berlin)


def test_a_clock_that_is_right_says_nothing() -> None:
    hall = Hall("2026-06-01T10:00")
    hall.now, hall.wall = 3600.0, when("2026-06-01T11:00") + 0.9
    assert hall.watch.tick(lambda: hall.now, hall.snapshot) is None


def test_a_process_that_is_suspended_between_two_readings_is_no_jump() -> None:
    hall = Hall("2026-03-30T17:00")
    asked: list[float] = []

    def now() -> float:
        asked.append(hall.now)
        return hall.now

    def wall() -> float:
        if len(asked) == 1:
            hall.now, hall.wall = hall.now + 3.0, hall.wall + 3.0
        return hall.wall

    assert WallClockWatch(lambda: hall.zone, real=True, clock=wall).tick(now, hall.snapshot) is None
    assert len(asked) > 2


def test_what_a_clock_is_set_forward_over_comes_at_once() -> None:
    hall = Hall("2026-06-01T17:30")
    hall.set("2026-06-01T18:10")
    assert hall.where == ("closed", 0)
    assert hall.next == ["02 09:00"]


def test_what_a_clock_goes_back_over_does_not_come_twice() -> None:
    hall = Hall("2026-06-01T10:59")
    hall.pass_until("2026-06-01T11:00")
    assert hall.where == ("open", 1)
    hall.set("2026-06-01T10:30")
    hall.pass_until("2026-06-01T11:30")
    assert hall.where == ("open", 1)
    assert hall.next == ["01 18:00", "02 11:00"]


def test_a_timer_is_as_long_as_before_and_a_time_of_day_where_it_was() -> None:
    hall = Hall(
        "2026-06-01T17:00",
        {"context": {"rounds": 0}, "states": {"a": {"at": {"18:00": "b"}, "after": {"2h": "c"}}, "b": None, "c": None}},
    )
    hall.set("2026-06-01T16:30")
    hall.pass_until("2026-06-01T17:59:59")
    assert hall.where == ("a", 0)
    hall.pass_until("2026-06-01T18:00")
    assert hall.where == ("b", 0)


def test_a_machine_that_began_years_ago_waits_anew() -> None:
    hall = Hall("1970-01-01T10:00")
    hall.set("2026-06-01T08:00")
    assert hall.where == ("open", 0)
    assert hall.next == ["01 11:00", "01 18:00"]


def test_in_the_evening_a_museum_is_closed_whatever_the_clock_believed() -> None:
    hall = Hall("1970-01-01T10:00")
    hall.set("2026-06-01T19:00")
    assert hall.where == ("closed", 1)
    assert hall.next == ["02 09:00"]


def test_a_clock_that_was_years_ahead_is_not_waited_for() -> None:
    hall = Hall("2031-01-01T10:00")
    hall.set("2026-06-01T10:00")
    assert hall.next == ["01 11:00", "01 18:00"]


def test_another_time_zone_counts_from_now_on() -> None:
    hall = Hall("2026-06-01T10:00")
    hall.zone = "Asia/Jakarta"  # five hours ahead
    hall.tick()
    assert hall.snapshot.timezone == "Asia/Jakarta"
    assert hall.next == ["01 13:00", "02 06:00"]


def test_an_invoked_behaviour_hears_of_the_clock_too() -> None:
    outer = {"states": {"a": {"invoke": {"behavior": "inner"}}}}
    machine = Machine.from_dict(outer, behaviors={"inner": HALL})
    before = initial(machine, epoch=when("2026-06-01T17:30"), timezone="Europe/Berlin").snapshot
    data = {"epoch": when("2026-06-01T18:10"), "timezone": "Europe/Berlin"}
    after = overdue(machine, step(machine, before, Event("clock set", data, 0.0, "clock set")).snapshot)
    assert after.invoked["inner"].snapshot.configuration == {"closed"}


def test_nobody_else_can_set_it() -> None:
    it = Interpreter(Machine.from_dict({"states": {"a": {"on": {"*": "b"}}, "b": None}}))
    it.start()
    it.send("clock set", {"epoch": 5.0, "timezone": ""})
    assert it.configuration == {"b"}
    assert it.snapshot()["epoch"] == 0.0


def test_what_passed_while_the_engine_was_away_comes_when_it_is_back() -> None:
    hall = Hall("2026-06-01T17:55")
    project: Any = SimpleNamespace(machine=hall.machine, controllers=())
    found: Any = resume(project, project, hall.snapshot, away=360.0, tracking=(), unchanged=60.0)
    snapshot = overdue(hall.machine, found.snapshot)
    assert snapshot.configuration == {"closed"}
    assert snapshot.epoch == when("2026-06-01T18:02")


@pytest.mark.parametrize("timers", ["deadline", "remaining", "restart"])
def test_a_snapshot_goes_on_to_the_same_time_of_day(timers: Any) -> None:
    it = Interpreter(Machine.from_dict(HALL), epoch=when("2026-06-01T17:00"), timezone="Europe/Berlin")
    it.start()
    it.clock.advance(1800.0)  # type: ignore[attr-defined]  # a virtual clock
    again = Interpreter.restore(it.machine, it.snapshot(), timers=timers)
    again.clock.advance(1799.0)  # type: ignore[attr-defined]
    assert again.configuration == {"open"}
    again.clock.advance(1.0)  # type: ignore[attr-defined]
    assert again.configuration == {"closed"}


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("timezone", "Mars/Olympus", "`timezone` there is no time zone `Mars/Olympus`"),
        ("event", "at.12:00.open", "is not an `at` of `open`"),
    ],
)
def test_a_damaged_snapshot_is_refused(key: str, value: str, told: str) -> None:
    it = Interpreter(Machine.from_dict(HALL), timezone="Europe/Berlin")
    it.start()
    data = it.snapshot()
    (data if key in data else data["timers"][0])[key] = value
    with pytest.raises(SnapshotError, match=told):
        Interpreter.restore(it.machine, data)


def test_a_time_zone_that_does_not_exist() -> None:
    with pytest.raises(UsageError, match="Europe/Berlin"):
        Interpreter(Machine.from_dict(HALL), timezone="Mars/Olympus").start()


@for_each(
    ("at", "comes"),
    [
        ({"18:00": "closed"}, ["01 18:00"]),
        ({" 18:00 ": "closed"}, ["01 18:00"]),
        ({"17:00": "closed", "18:00": "closed"}, ["01 17:00", "01 18:00"]),
        ({"mon 9:00": "closed"}, ["08 09:00"]),
        ({}, []),
    ],
)
def test_what_was_saved_is_waited_for_from_now_on(at: dict[str, str], comes: list[str]) -> None:
    hall = Hall("2026-06-01T10:00", {**HALL, "states": {"open": {"at": {"18:00": "closed"}}, "closed": None}})
    new = Machine.from_dict({**HALL, "states": {"open": {"at": at}, "closed": None}})
    planned = migrate(hall.machine, new, hall.snapshot, at=60.0)
    assert isinstance(planned, MigrationPlan)
    hall.snapshot = planned.snapshot
    assert hall.next == comes
    assert deserialize(new, serialize(new, planned.snapshot)) == planned.snapshot


def test_exploring_comes_upon_what_happens_at_a_time() -> None:
    data = {"states": {"open": {"at": {"18:00": "closed"}}, "closed": {"at": {"sat 09:00": "open"}}, "never": None}}
    found = explore(Machine.from_dict(data), {}, epoch=when("2026-06-01T10:00"), timezone="Europe/Berlin")
    assert found.complete
    assert found.never_entered == ("never",)
    assert not found.never_taken
