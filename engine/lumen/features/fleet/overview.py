"""A fleet's state, as `lumen fleet status --format json` prints it."""

from collections.abc import Mapping
from typing import Any

from lumen.features.fleet.rollouts.presence import rates
from lumen.features.fleet.rollouts.rollout import allowed
from lumen.features.fleet.rollouts.state import CentreState, HeardPresence, Rollout
from lumen.features.fleet.rollouts.trying import FRESH, counted
from lumen.features.fleet.settings import Fleet
from lumen.language.iso_time import iso_time

MOST_SKEW = 30.0
"""The error of a robot's clock above which it is reported [s]."""


def overview(fleet: Fleet, state: CentreState, heard: Mapping[str, HeardPresence], now: float) -> dict[str, Any]:
    """Return the houses, robots, rollout and trial as JSON data; `now` is the centre's time [s since 1970]."""
    robots = [_robot(name, state, heard.get(name), fleet, now) for name in fleet.robots]
    houses = [
        {
            "name": name,
            "broker": house.broker,
            "robots": len(house.robots),
            "here": sum(row["here"] for row in robots if row["house"] == name),
            "labels": dict(house.labels),
        }
        for name, house in fleet.houses.items()
    ]
    rollout = _rollout(state.rollout, state, fleet) if state.rollout else None
    return {
        "houses": houses,
        "robots": robots,
        "rollout": rollout,
        "centre": {"name": state.centre, "term": state.term, "version": state.version, "overruled": state.overruled},
        "proved": list(state.proved),
        "trying": {"bundle": state.trying, **counted(state.trying, heard)} if state.trying else None,
    }


def _robot(name: str, state: CentreState, heard: HeardPresence | None, fleet: Fleet, now: float) -> dict[str, Any]:
    house, _, robot = name.partition("/")
    row: dict[str, Any] = {
        "name": robot, "house": house, "bundle": "", "state": "unknown", "since": None, "here": False,
        "wanted": state.wanted.get(name, ""), "pinned": name in state.pinned, "trouble": "", "heard": None,
    }  # fmt: skip
    if heard is None:
        return row
    said = heard.presence
    here = abs(now - heard.at) <= FRESH
    trouble = said.trouble
    if here and said.clock and abs(said.clock - heard.at) > MOST_SKEW:
        trouble = trouble or f"its clock is off by {said.clock - heard.at:+.0f} s"
    return row | {
        "bundle": said.bundle,
        "state": said.state if here else "away",
        "since": _iso(said.since),
        "here": here,
        "trouble": trouble,
        "heard": _iso(heard.at),
        "played": said.played,
        "same": said.same,
        "tried": dict(said.tried),
        "measures": rates([said.now], fleet.measures),
        "before": rates([said.before], fleet.measures),
    }


def _rollout(rollout: Rollout, state: CentreState, fleet: Fleet) -> dict[str, Any]:
    steps = [
        {
            "to": str(target),
            "most": allowed(rollout.plan, i, fleet),
            "done": i < rollout.at or rollout.state == "finished",
        }
        for i, target in enumerate(rollout.plan.steps)
    ]
    return {
        "bundle": rollout.bundle,
        "state": rollout.state,
        "reason": rollout.reason,
        "step": rollout.at,
        "tried": rollout.tried or not rollout.plan.try_first,
        "steps": steps,
        "assigned": list(rollout.assigned),
        "exposed": len(state.exposed),
        "watched": round(rollout.watched, 1),
        "pause": rollout.plan.pause,
        "abort-if": rollout.plan.abort_if,
        "since": _iso(rollout.begun),
    }


def _iso(at: float) -> str | None:
    return iso_time(at, "seconds") if at > 0.0 else None
