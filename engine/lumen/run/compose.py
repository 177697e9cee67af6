"""Build an exhibition from its plan: the parts that it needs, in the order of their rows."""

import logging
import time
from collections.abc import Sequence
from contextlib import ExitStack
from functools import cache

from lumen.errors import LumenError
from lumen.feature import Feature, PartRow, distribution_of, resolve, rows
from lumen.feature.checking import ordered
from lumen.project.broken_features import blamed
from lumen.run.claiming import CLAIM_INTERVAL
from lumen.run.parts.added import AddedPart
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.services import Services

_log = logging.getLogger(__name__)


def compose(plan: Plan) -> Services:
    """Build an exhibition from a plan: all parts except those that are made after the claim (`start`).

    Raises BusError if the bus can't be reached, and any error of a part's maker; everything made so far is then closed.
    If code of an installed package fails, its part is left out and the failure is logged; to prevent the start, the
    package raises a LumenError.
    """
    services = Services(plan)
    _make(services, claimed=False)
    return services


def start(exhibitions: Sequence[Services]) -> None:
    """Start exhibitions: claim their robots' roles, make the remaining parts, and begin all parts.

    Raises UsageError if another process objects to a claim, and any error of a part's maker.
    """
    claim(exhibitions)
    begin(exhibitions)


def claim(exhibitions: Sequence[Services]) -> None:
    """Request the roles of exhibitions, and wait for objections of other processes.

    Raises UsageError if another process objects.
    """
    waiting = [one.node for one in exhibitions]
    for node in waiting:
        node.request()  # request now: making the parts can take longer than the time for objections
    while waiting := [node for node in waiting if node.claims()]:
        time.sleep(CLAIM_INTERVAL)


def begin(exhibitions: Sequence[Services]) -> None:
    """Make the remaining parts of exhibitions after their claim, and begin all parts."""
    for one in exhibitions:
        _make(one, claimed=True)
        for missing in one.left_out:
            for part in one.node.parts:
                part.part_stopped(missing)
        one.node.begin()


def _make(services: Services, *, claimed: bool) -> None:
    with ExitStack() as undo:
        undo.callback(services.node.close)
        for place, row in enumerate(part_rows()):
            if row.claimed == claimed and all(map(services.plan.meets, row.when.split())):
                _add(services, place, row)
        undo.pop_all()


def _add(services: Services, place: int, row: PartRow) -> None:
    feature = _feature_of(row)
    try:
        made = resolve(row.make)(services)
        parts = [made] if isinstance(made, Part) else [*(made or ())]
        services.add(place, *(_guarded(services, row, feature, part) for part in parts))
    except (LumenError, KeyboardInterrupt):
        raise
    except BaseException as error:  # a package's code may even raise SystemExit
        if feature is None:
            raise
        fault = f"the part `{row.name}` is left out: {blamed(feature, row.make, error)}"
        services.node.faults.append(fault)
        services.left_out.append(f"the part `{row.name}` of the package {distribution_of(feature)}")
        _log.exception("%s", fault)


def _guarded(services: Services, row: PartRow, feature: Feature | None, part: Part) -> Part:
    """Return a package's part, wrapped so that its faults end only that part; return Lumen's own parts unchanged."""
    return AddedPart(part, feature, row, services.part_stopped) if feature else part


def _feature_of(row: PartRow) -> Feature | None:
    """Return the installed package's feature that provides a row; None for a row of Lumen."""
    found = (feature for feature, each in rows("parts") if each is row and distribution_of(feature))
    return next(found, None)


@cache
def part_rows() -> tuple[PartRow, ...]:
    """Return the rows of all features in the order in which their parts are made and ticked."""
    return tuple(ordered([row for _, row in rows("parts")]))
