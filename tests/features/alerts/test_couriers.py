"""The frequency of alerts: repeats once per interval, with a count; after quiet hours; again if sending failed."""

import itertools
import threading
import time
from collections.abc import Callable, Iterator
from datetime import time as TimeOfDay  # noqa: N812
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.errors import UndeliveredError
from lumen.features.alerts import courier as couriers
from lumen.features.alerts.alert import Alert, Origin
from lumen.features.alerts.courier import MAX_PENDING_ALERTS, Courier, Ration
from lumen.features.alerts.desk import AlertDesk
from lumen.features.alerts.settings import Alerts, Program, QuietHours, Recipient, Webhook
from tests.features.alerts.servers import Web
from tests.waiting import HANG, finished, until

FELL, STOPPED = Alert("fallen", "it fell"), Alert("stopped", "a person stopped it")
NIGHT = QuietHours(TimeOfDay(22), TimeOfDay(7))


def given_out(ration: Ration, now: float, *, quiet: bool = False) -> list[tuple[str, int]]:
    return [(alert.kind, alert.times) for alert in ration.due(now, quiet=quiet)]


def test_the_same_is_told_once_and_what_was_held_back_is_counted() -> None:
    ration = Ration(900.0)
    ration.take(FELL)
    assert given_out(ration, 0.0) == [("fallen", 1)]
    for at in (10.0, 20.0):
        ration.take(FELL._replace(at=at, first=at))
        ration.take(STOPPED)
    assert given_out(ration, 20.0) == [("stopped", 2)], "another kind does not wait"
    assert given_out(ration, 899.0) == []
    [told] = ration.due(900.0, quiet=False)
    assert (told.times, told.first, told.at) == (2, 10.0, 20.0)
    assert given_out(ration, 5_000.0) == []


def test_two_parts_that_are_lost_are_two() -> None:
    ration = Ration(900.0)
    for part in ("robot", "memory", "robot"):
        ration.take(Alert("lost", f"the {part} is gone", part))
    assert sorted(alert.times for alert in ration.due(0.0, quiet=False)) == [1, 2]


def test_in_quiet_hours_it_waits() -> None:
    ration = Ration(900.0)
    ration.take(FELL)
    ration.take(FELL)
    assert given_out(ration, 0.0, quiet=True) == []
    assert ration.wait(0.0) is not None
    assert given_out(ration, 40_000.0) == [("fallen", 2)]
    assert ration.wait(40_000.0) is None


@pytest.mark.parametrize(
    ("hours", "quiet", "loud"),
    [
        (NIGHT, [(22, 0), (23, 59), (0, 0), (6, 59)], [(7, 0), (21, 59), (12, 0)]),
        (QuietHours(TimeOfDay(12), TimeOfDay(13, 30)), [(12, 0), (13, 29)], [(11, 59), (13, 30), (0, 0)]),
    ],
)
def test_quiet_hours(hours: QuietHours, quiet: list[tuple[int, int]], loud: list[tuple[int, int]]) -> None:
    assert all(hours.hold(TimeOfDay(*at)) for at in quiet)
    assert not any(hours.hold(TimeOfDay(*at)) for at in loud)


@given(st.lists(st.tuples(st.floats(0.0, 100.0), st.sampled_from("ab"), st.booleans()), max_size=40))
def test_nothing_is_lost_and_nothing_told_too_often(days: list[tuple[float, str, bool]]) -> None:
    ration, now, told = Ration(150.0), 0.0, list[tuple[float, str, int]]()
    for pause, kind, quiet in days:
        now += pause
        ration.take(Alert(kind, "x"))
        told += [(now, alert.kind, alert.times) for alert in ration.due(now, quiet=quiet)]
    held = sum(alert.times for alert in ration.remaining())
    assert sum(times for _, _, times in told) + held == len(days)
    for kind in "ab":
        at = [now for now, other, _ in told if other == kind]
        assert all(later - earlier >= 150.0 for earlier, later in itertools.pairwise(at))


class Stand:
    """Couriers whose deliveries are counted; each of `faults` makes one delivery fail."""

    def __init__(self) -> None:
        self.arrived: list[Alert] = []
        self.told: list[str] = []
        self.faults: list[UndeliveredError] = []
        self.tries = 0
        self.hour = TimeOfDay(12)
        self.gate = threading.Event()
        self.gate.set()
        self.couriers: list[Courier] = []

    def courier(self, *kinds: str, interval: float = 900.0, quiet: QuietHours | None = None) -> Courier:
        recipient = Recipient(Program(("x",)), kinds or ("fallen", "stopped"), quiet)
        self.couriers.append(Courier(recipient, interval, self._deliver, self.told.append, day=lambda: self.hour))
        return self.couriers[-1]

    def _deliver(self, alert: Alert) -> None:
        self.tries += 1
        self.gate.wait(HANG)
        if self.faults:
            raise self.faults.pop(0)
        self.arrived.append(alert)


@pytest.fixture
def stand(monkeypatch: pytest.MonkeyPatch) -> Iterator[Stand]:
    monkeypatch.setattr(couriers, "FIRST_RETRY", 0.01)
    one = Stand()
    yield one
    one.gate.set()
    for courier in one.couriers:
        courier.end(time.monotonic())
        courier.join()


def test_what_did_not_arrive_is_tried_again_and_said_once(stand: Stand) -> None:
    stand.faults = [UndeliveredError("it is not there") for _ in range(3)]
    stand.courier().put(FELL)
    until(lambda: stand.arrived)
    assert (stand.tries, stand.told) == (4, ["it is not there"])


def test_what_will_never_arrive_is_not_tried_again(stand: Stand) -> None:
    stand.faults = [UndeliveredError("it says no", final=True)]
    courier = stand.courier()
    courier.put(FELL)
    courier.put(STOPPED)
    until(lambda: stand.arrived)
    assert [alert.kind for alert in stand.arrived] == ["stopped"]


def test_only_what_is_wanted(stand: Stand) -> None:
    courier = stand.courier("stopped")
    courier.put(FELL)
    courier.put(STOPPED)
    until(lambda: stand.arrived)
    assert [alert.kind for alert in stand.arrived] == ["stopped"]


def test_who_tells_waits_for_nobody_and_the_memory_is_bounded(stand: Stand) -> None:
    stand.gate.clear()
    courier = stand.courier()
    courier.put(FELL)
    until(lambda: stand.tries)
    for number in range(10 * MAX_PENDING_ALERTS):
        courier.put(Alert("stopped", "x", str(number)))
    assert stand.tries == 1, "the first is still under way"
    assert len(courier._received) == MAX_PENDING_ALERTS
    stand.gate.set()
    until(lambda: len(stand.arrived) == 1 + MAX_PENDING_ALERTS)


def test_the_end_tells_what_was_held_back(stand: Stand) -> None:
    courier = stand.courier()
    courier.put(FELL)
    until(lambda: stand.arrived)
    courier.put(FELL)
    courier.put(FELL)
    courier.end(time.monotonic() + 20.0)
    courier.join()
    assert [alert.times for alert in stand.arrived] == [1, 2]


def test_the_end_waits_no_longer_than_it_says_and_is_quiet_at_night(stand: Stand) -> None:
    stand.faults = [UndeliveredError("it is not there") for _ in range(1_000)]
    courier = stand.courier()
    courier.put(FELL)
    until(lambda: stand.tries)
    courier.end(time.monotonic() + 0.1)
    joining = threading.Thread(target=courier.join)
    joining.start()
    finished(joining)
    until(lambda: not courier._thread.is_alive())  # it may be in a last attempt
    stand.hour, tries = TimeOfDay(23), stand.tries
    night = stand.courier(quiet=NIGHT)
    night.put(STOPPED)
    night.end(time.monotonic() + 20.0)
    night.join()
    assert (stand.arrived, stand.tries) == ([], tries)


def test_others_are_told_from_now_on(web: Callable[..., Web]) -> None:
    first, second = web(), web()
    told: list[str] = []

    def to(here: Web) -> Alerts:
        return Alerts((Recipient(Webhook(here.url)),))

    desk = AlertDesk(to(first), Origin("hall", "NAO"), Path(), told.append)
    desk("fallen", "it fell")
    first.told("fallen")
    desk.use(to(first))
    desk.use(to(second))
    desk("fallen", "it fell again")
    assert second.told("fallen")[0]["text"] == "NAO: it fell again"
    desk.close()
    desk.close()
    desk("stopped", "nobody hears this")
    assert (len(first.bodies), len(second.bodies), told) == (1, 1, [])
