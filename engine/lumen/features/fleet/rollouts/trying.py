"""Trials before a rollout: all robots lint a bundle for their bodies and replay their own last visits with it.

No visit leaves its house: robots report only how many visits were unchanged.
"""

from collections.abc import Mapping
from dataclasses import replace

from lumen.features.fleet.rollouts.presence import REFUSED, TRIED, RobotPresence
from lumen.features.fleet.rollouts.state import GOING, PERSON, CentreState, HeardPresence, Rollout
from lumen.features.fleet.settings import Fleet

FRESH = 60.0
"""The time for which a robot counts as present after its last report [s]."""
TRYING = 600.0
"""The time limit for the trials of present robots, after which the operator must decide [s]."""

HeardRobots = Mapping[str, HeardPresence]


def tried(
    state: CentreState, rollout: Rollout, fleet: Fleet, heard: HeardRobots, now: float, passed: float
) -> CentreState:
    """Return the state of a rollout's trials at `now`, `passed` [s] after the last tick.

    The first step begins when all present robots have tried the bundle without a refusal. After a refusal by any robot,
    or after `TRYING`, the operator must decide. Changed visits do not stop the rollout, because they may be intended.
    """
    there = _there(state, rollout, fleet, heard, now)
    came = outcomes(rollout.bundle, there)
    rollout = replace(rollout, waited=rollout.waited + passed)
    missing = [robot for robot in there if robot not in came]
    if there and not missing:
        if refused := [f"{robot} ({row['why']})" for robot, row in came.items() if row["verdict"] == REFUSED]:
            share = f"{len(refused)} of {len(came)} robots"
            return _pause_for_decision(state, rollout, f"{share} would refuse it: {', '.join(refused[:5])}")
        return begin_steps(state, rollout)
    if rollout.waited > TRYING:
        whom = ", ".join(missing[:5]) or "nobody is there"
        return _pause_for_decision(
            state, rollout, f"some robots have not tried it after {rollout.waited / 60.0:.0f} min: {whom}"
        )
    return replace(state, rollout=rollout)


def begin_steps(state: CentreState, rollout: Rollout) -> CentreState:
    """Return the state with the trials ended and the rollout at the start of its first step."""
    return replace(state, rollout=replace(rollout, state=GOING, tried=True, waited=0.0, version=state.version))


def outcomes(bundle: str, there: Mapping[str, RobotPresence]) -> dict[str, Mapping[str, object]]:
    """Return `RobotPresence.tried` for each robot that has tried the bundle."""
    return {robot: said.tried for robot, said in there.items() if said.tried.get("bundle") == bundle}


def counted(bundle: str, heard: HeardRobots) -> dict[str, int]:
    """Return the number of robots with each verdict about a bundle."""
    rows = outcomes(bundle, {robot: row.presence for robot, row in heard.items()}).values()
    return {verdict: sum(row["verdict"] == verdict for row in rows) for verdict in TRIED}


def fresh(heard: HeardRobots, robot: str, now: float) -> RobotPresence | None:
    """Return a robot's presence if it arrived within the last `FRESH` seconds, else None."""
    found = heard.get(robot)
    return found.presence if found and abs(now - found.at) <= FRESH else None


def _there(
    state: CentreState, rollout: Rollout, fleet: Fleet, heard: HeardRobots, now: float
) -> dict[str, RobotPresence]:
    """Return the presences of the robots that the rollout can reach and that have reported recently."""
    wanted = dict.fromkeys(robot for target in rollout.plan.steps for robot in fleet.members(target))
    found = ((robot, fresh(heard, robot, now)) for robot in wanted if robot not in state.pinned)
    return {robot: said for robot, said in found if said}


def _pause_for_decision(state: CentreState, rollout: Rollout, why: str) -> CentreState:
    return replace(state, rollout=replace(rollout, state=PERSON, reason=why))
