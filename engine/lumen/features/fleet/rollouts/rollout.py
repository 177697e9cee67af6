"""A rollout, which assigns a bundle to more and more robots, or withdraws it from all of them.

The invariant, despite late, lost or repeated messages and killed processes: no more robots run an unproved bundle than
the present step allows. Therefore a robot with the bundle counts until it has reported a different bundle.
"""

from collections.abc import Iterable
from dataclasses import replace
from itertools import zip_longest

from lumen.features.fleet.rollouts.conditions import holds
from lumen.features.fleet.rollouts.orders import NOT
from lumen.features.fleet.rollouts.presence import PROVED, REFUSED, ROLLED_BACK, rates
from lumen.features.fleet.rollouts.state import ABORTED, FINISHED, GOING, PERSON, CentreState, Rollout
from lumen.features.fleet.rollouts.trying import HeardRobots, begin_steps, fresh, tried
from lumen.features.fleet.settings import Fleet, RolloutPlan, StepTarget

LONGEST_LOOK = 30.0
"""The maximum time that one tick counts [s]; a changed clock or a stopped centre thus shortens no wait."""
PATIENCE = 900.0
"""The time beyond twice a step's pause after which an unproved step waits for the operator's decision [s]."""


def step(state: CentreState, fleet: Fleet, heard: HeardRobots, now: float) -> CentreState:
    """Return the state at `now` [s since 1970]; the caller must write changes to the journal before sending orders."""
    passed = min(max(now - state.looked, 0.0), LONGEST_LOOK) if state.looked else 0.0
    state = _released(_overruled(replace(state, looked=now), heard), heard)
    rollout = state.rollout
    if rollout is None or not rollout.under_way or state.overruled:
        return state
    if why := _failed(rollout, fleet, heard):
        return abort(state, why)
    if rollout.state != GOING:
        return state
    if rollout.plan.try_first and not rollout.tried:
        return tried(state, rollout, fleet, heard, now, passed)
    state = _assigned(state, rollout, fleet, heard, now)
    assert state.rollout
    return _judged(state, state.rollout, fleet, heard, now, passed)


def begin(state: CentreState, fleet: Fleet, bundle: str, plan: RolloutPlan, now: float) -> CentreState:
    """Return the state with a new rollout, which the next `step` begins.

    Raises ValueError, with the reason, if another rollout is under way, a step has no robots, or the centre no longer
    gives orders.
    """
    if state.overruled:
        raise ValueError(state.overruled)
    if state.rollout and state.rollout.under_way:
        running = f"a rollout of {state.rollout.bundle[:12]} is {state.rollout.state}"
        raise ValueError(f"{running}: abort it, or wait until it ends")
    for target in plan.steps:
        if not fleet.members(target):
            raise ValueError(f"no robot belongs to the step `{target}`")
    if plan.try_first:
        state = state.attempt(bundle)
    return replace(state, rollout=Rollout(bundle, plan, begun=now, version=state.version))


def abort(state: CentreState, why: str) -> CentreState:
    """Return the state in which each robot of the rollout should run its proved bundle from before the rollout.

    A robot without a proved bundle should return to its previous files. Nothing changes if no rollout is under way.
    """
    rollout = state.rollout
    if rollout is None or not rollout.under_way:
        return state
    other = f"{NOT}{rollout.bundle}"
    state = state.want({robot: rollout.prior.get(robot, other) for robot in rollout.assigned}).attempt("")
    exposed = {
        robot: (bundle, version or state.version) if bundle == rollout.bundle else (bundle, version)
        for robot, (bundle, version) in state.exposed.items()
    }
    return replace(state, exposed=exposed, rollout=replace(rollout, state=ABORTED, reason=why))


def decide(state: CentreState, decision: str, why: str = "") -> CentreState:
    """Return the state after the operator's decision, `PAUSED` or `GOING`.

    If the rollout waits for a decision, `GOING` accepts its trials or its present step. Raises ValueError if no rollout
    is under way.
    """
    rollout = state.rollout
    if rollout is None or not rollout.under_way:
        raise ValueError("no rollout is under way")
    if rollout.plan.try_first and not rollout.tried and rollout.state == PERSON and decision == GOING:
        return begin_steps(state, replace(rollout, reason=why))
    settled = rollout.state == PERSON and decision == GOING
    if settled:  # the operator has accepted this step
        return _onward(state, replace(rollout, state=GOING, reason=why))
    return replace(state, rollout=replace(rollout, state=decision, reason=why))


def take_over(state: CentreState, heard: HeardRobots) -> CentreState:
    """Return the state of a centre that replaces a lost centre, or continues from an old copy of its folder.

    The new centre's orders have a new term. A rollout under way waits for the operator's decision.
    """
    term = max([state.term, *(row.presence.term for row in heard.values())]) + 1
    state = replace(state, term=term, version=state.version + 1, overruled="")
    rollout = state.rollout
    if rollout is None or not rollout.under_way:
        return state
    return _pause_for_decision(state, rollout, "another centre took over during the rollout")


def allowed(plan: RolloutPlan, at: int, fleet: Fleet) -> int:
    """Return the maximum number of robots that may run the bundle in step `at`: the size of the largest step so far."""
    return max(_size(target, fleet) for target in plan.steps[: at + 1])


def _size(target: StepTarget, fleet: Fleet) -> int:
    everybody = len(fleet.members(target))
    return everybody if target.group else max(1, int(target.share * everybody + 1e-9))


def _overruled(state: CentreState, heard: HeardRobots) -> CentreState:
    """Return the state, marked as overruled if a robot follows a newer order than this centre's last order."""
    for robot, row in heard.items():
        said = row.presence
        if said.term > state.term:
            why = f"{robot} follows centre {said.centre[:8]} of term {said.term}, which replaced this centre"
            return replace(state, overruled=why)
        if said.term == state.term and said.centre == state.centre and said.version > state.version:
            newer = f"{robot} received order {said.version}, but the last order here is {state.version}"
            return replace(state, overruled=f"{newer}: this folder is an old copy")
    return state


def _released(state: CentreState, heard: HeardRobots) -> CentreState:
    """Return the state without the exposed robots that no longer run an unproved bundle.

    Either the bundle has been proved, or the robot has reported a different bundle after the withdrawal.
    """

    def back(robot: str, bundle: str, version: int) -> bool:
        said = heard[robot].presence if robot in heard else None
        follows = said is not None and said.term == state.term and said.version >= version > 0
        return bundle in state.proved or (follows and said is not None and said.bundle not in ("", bundle))

    exposed = {robot: row for robot, row in state.exposed.items() if not back(robot, *row)}
    return state if len(exposed) == len(state.exposed) else replace(state, exposed=exposed)


def _failed(rollout: Rollout, fleet: Fleet, heard: HeardRobots) -> str:
    """Return why the bundle must be withdrawn, a robot's failure or `abort_if`; empty if neither occurs."""
    for robot in rollout.assigned:
        said = heard[robot].presence if robot in heard else None
        new = said is not None and said.version > rollout.version
        if new and said and said.about == rollout.bundle and said.state in (REFUSED, ROLLED_BACK):
            return f"{robot} has {said.state} it: {said.trouble or 'no reason was told'}"
    if rollout.plan.abort_if and _holds(rollout, fleet, heard):
        return f"`{rollout.plan.abort_if}` holds: {_told(rollout, fleet, heard)}"
    return ""


def _holds(rollout: Rollout, fleet: Fleet, heard: HeardRobots) -> bool | None:
    now, before = _measured(rollout, fleet, heard)
    return holds(rollout.plan.abort_if, fleet.measures, now, before)


def _measured(rollout: Rollout, fleet: Fleet, heard: HeardRobots) -> tuple[dict[str, float], dict[str, float]]:
    there = [heard[robot].presence for robot in rollout.assigned if robot in heard]
    running = [said for said in there if said.bundle == rollout.bundle]
    now = rates((said.now for said in running), fleet.measures)
    return now, rates((said.before for said in running), fleet.measures)


def _told(rollout: Rollout, fleet: Fleet, heard: HeardRobots) -> str:
    now, before = _measured(rollout, fleet, heard)
    rows = (f"{name} {value:.3g}, before {before.get(name, float('nan')):.3g}" for name, value in now.items())
    return ", ".join(rows).replace("before nan", "before unknown")


def _assigned(state: CentreState, rollout: Rollout, fleet: Fleet, heard: HeardRobots, now: float) -> CentreState:
    """Return the state with the bundle assigned to as many of the step's robots as may be exposed.

    A robot that may still run a withdrawn bundle counts as exposed. It is chosen only after it has reported a different
    bundle.
    """
    target = rollout.plan.steps[rollout.at]
    room = allowed(rollout.plan, rollout.at, fleet) - len({*state.exposed, *rollout.assigned})
    taken = {*rollout.assigned, *state.pinned}
    there = [robot for robot in fleet.members(target) if robot not in taken]
    if target.share and target.share < 1.0:
        there = [robot for robot in _spread(there) if fresh(heard, robot, now)]
        room = min(room, _size(target, fleet) - len(rollout.assigned))
    free = [robot for robot in there if robot not in state.exposed or rollout.bundle in state.proved]
    chosen = tuple(free[: max(room, 0)])
    if not chosen:
        return state
    known = {robot: want for robot in chosen if (want := state.wanted.get(robot, "")) in state.proved}
    state = state.want(dict.fromkeys(chosen, rollout.bundle))
    rollout = replace(rollout, prior={**rollout.prior, **known})
    exposed = dict(state.exposed)
    if rollout.bundle not in state.proved:
        exposed |= dict.fromkeys(chosen, (rollout.bundle, 0))
    return replace(state, exposed=exposed, rollout=replace(rollout, assigned=(*rollout.assigned, *chosen)))


def _spread(robots: Iterable[str]) -> list[str]:
    """Return the robots in an order that alternates between houses, which spreads a step over many houses."""
    houses: dict[str, list[str]] = {}
    for robot in robots:
        houses.setdefault(robot.partition("/")[0], []).append(robot)
    return [robot for row in zip_longest(*houses.values()) for robot in row if robot]


def _judged(
    state: CentreState, rollout: Rollout, fleet: Fleet, heard: HeardRobots, now: float, passed: float
) -> CentreState:
    """Add `passed` [s] to the step's times, and continue if it has been watched for its pause and is proved.

    If the result of `abort_if` is unknown or the step is late, wait for the operator's decision.
    """
    said = [fresh(heard, robot, now) for robot in rollout.assigned]
    there = [each for each in said if each]
    proved = [each for each in there if each.bundle == rollout.bundle and each.state == PROVED]
    mostly = 2 * len(proved) > len(rollout.assigned)
    watched = rollout.watched + (passed if mostly else 0.0)
    rollout = replace(rollout, watched=watched, waited=rollout.waited + passed)
    state = replace(state, rollout=rollout)
    pause = rollout.plan.pause
    if mostly and len(proved) == len(there) and watched >= pause:
        if rollout.plan.abort_if and _holds(rollout, fleet, heard) is None:
            return _pause_for_decision(
                state, rollout, f"no robot has reported a measure yet for `{rollout.plan.abort_if}`"
            )
        return _onward(state, rollout)
    if rollout.waited > 2.0 * pause + PATIENCE:
        late = [robot for robot, each in zip(rollout.assigned, said, strict=True) if not (each and each in proved)]
        return _pause_for_decision(
            state, rollout, f"not proved after {rollout.waited / 60.0:.0f} min: {', '.join(late[:5]) or 'no robot'}"
        )
    return state


def _pause_for_decision(state: CentreState, rollout: Rollout, why: str) -> CentreState:
    return replace(state, rollout=replace(rollout, state=PERSON, reason=why))


def _onward(state: CentreState, rollout: Rollout) -> CentreState:
    """Return the state at the next step, or after the last step the finished rollout with its bundle proved."""
    if rollout.at + 1 < len(rollout.plan.steps):
        return replace(state, rollout=replace(rollout, at=rollout.at + 1, watched=0.0, waited=0.0))
    proved = tuple(dict.fromkeys((*state.proved, rollout.bundle)))
    state = replace(state, proved=proved, rollout=replace(rollout, state=FINISHED))
    return _released(state.attempt(""), {})
