"""The centre's answers to requests, which are messages on `fleet.order`."""

from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from lumen.errors import BusError, UsageError
from lumen.features.fleet.bundle import BundleParts
from lumen.features.fleet.centre import Centre
from lumen.features.fleet.rollouts.conditions import condition_faults
from lumen.features.fleet.rollouts.rollout import abort, begin, decide, take_over
from lumen.features.fleet.rollouts.state import GOING, PAUSED
from lumen.features.fleet.settings import RolloutPlan, step_target
from lumen.language.causes import UNNAMED_PROGRAM
from lumen.language.diagnostics import did_you_mean
from lumen.language.fleet_keys import ORDER
from lumen.ports import Bus, Message

MAX_STEPS = 20
_BUNDLE, _ROBOT = 'a `bundle`, such as {"bundle": "3f9a0c"}', 'a `robot`, such as {"robot": "itb/nao1"}'
ASKED: Mapping[str, str] = {
    "status": "",
    "publish": "a `bundle` with its `hash` and files, as `lumen fleet publish` sends it",
    "rollout": _BUNDLE,
    "try": _BUNDLE,
    "pause": "",
    "go": "",
    "abort": "",
    "pin": _ROBOT,
    "unpin": _ROBOT,
    "take-over": "",
    "files": _BUNDLE,
}
"""The requests, and what each needs besides `ask`, in words."""


class CentreDesk:
    """Answers each request with `{"ok": …}` and the result, or the `reason` for a refusal."""

    def __init__(self, centre: Centre, bus: Bus) -> None:
        self._centre, self._bus = centre, bus
        self._received: deque[Message] = deque(maxlen=100)
        self._parts = BundleParts()
        self._undo = bus.subscribe(ORDER, self._received.append)

    def tick(self, now: float) -> None:
        """Answer the received requests; `now` is the centre's time [s since 1970]."""
        while self._received:
            message = self._received.popleft()
            try:
                answer = {"ok": True, **self.answer(message.body, now)}
            except (UsageError, ValueError) as error:
                answer = {"ok": False, "reason": str(error)}
            with suppress(BusError):
                self._bus.reply(message, answer)

    def close(self) -> None:
        """End the subscription."""
        self._undo()

    def answer(self, body: Any, now: float) -> dict[str, Any]:
        """Return the answer to a request. Raises UsageError or ValueError with the reason for a refusal."""
        centre, state = self._centre, self._centre.state
        by = str(body.get("by") or UNNAMED_PROGRAM)[:80] if isinstance(body, Mapping) else ""
        match body:
            case {"ask": "status"}:
                return centre.overview()
            case {"ask": "publish", "bundle": {"hash": str(hash)} as bundle}:
                files = self._parts.take(bundle, hash, centre.fleet.key)
                if files is not None and (why := centre.bundles.keep(files)):
                    raise UsageError(f"the bundle can't be stored: {why}")
                return {"bundle": hash}
            case {"ask": "rollout", "bundle": str(name)}:
                hash = self._named(name)
                begun = begin(state, centre.fleet, hash, self._plan(body), now)
                centre.change(begun, f"{by} begins a rollout of {hash[:12]}")
                return {"bundle": hash}
            case {"ask": "try", "bundle": str(name)}:
                if state.rollout and state.rollout.under_way:
                    raise UsageError("a rollout is under way: abort it, or wait until it ends")
                hash = self._named(name)
                centre.change(state.attempt(hash), f"{by} lets all robots try {hash[:12]}")
                return {"bundle": hash}
            case {"ask": "pause"}:
                centre.change(decide(state, PAUSED, f"by {by}"), f"{by} pauses the rollout")
            case {"ask": "go"}:
                centre.change(decide(state, GOING, f"by {by}"), f"{by} continues the rollout")
            case {"ask": "abort"}:
                if state.rollout is None or not state.rollout.under_way:
                    raise UsageError("no rollout is under way")
                centre.change(abort(state, f"by {by}"), f"{by} aborts the rollout: all robots go back")
            case {"ask": "pin" | "unpin" as verb, "robot": str(robot)}:
                self._pin(robot, by, on=verb == "pin")
            case {"ask": "take-over"}:
                centre.change(take_over(state, centre.heard), f"{by} takes over")
            case {"ask": "files", "bundle": str(name)}:
                found = centre.bundles.files(self._named(name)) or {}
                return {"files": {path: text.decode("utf-8", "replace") for path, text in found.items()}}
            case {"ask": str(verb)} if verb in ASKED:
                raise UsageError(f"`{verb}` needs {ASKED[verb]}")
            case {"ask": str(verb)}:
                raise UsageError(
                    f"the centre has no request `{verb[:40]}`: {did_you_mean(verb[:40], ASKED, 'there are')}"
                )
            case _:
                raise UsageError('the request has no `ask`: send a body such as {"ask": "status"}')
        return {}

    def _named(self, name: str) -> str:
        """Return the hash of the only published bundle whose hash begins with `name`.

        Raises UsageError if no bundle or several bundles match.
        """
        found = [hash for hash in self._centre.bundles.hashes() if name and hash.startswith(name)]
        if len(found) != 1:
            what = "more than one published bundle has" if found else "no published bundle has"
            raise UsageError(
                f"{what} a hash that begins with `{name[:64]}`: copy the hash that `lumen fleet publish` printed"
            )
        return found[0]

    def _plan(self, said: Mapping[str, Any]) -> RolloutPlan:
        """Return the requested plan; fields that the request omits come from fleet.yaml.

        Raises UsageError if a step or the condition is invalid.
        """
        fleet, usual = self._centre.fleet, self._centre.fleet.rollout
        words, pause, condition = said.get("steps"), said.get("pause"), said.get("abort-if")
        steps = usual.steps
        if isinstance(words, list) and 0 < len(words) <= MAX_STEPS:
            found = [step_target(str(word)) for word in words]
            for word, target in zip(words, found, strict=True):
                if target is None or (target.group and target.group not in fleet.groups):
                    hint = did_you_mean(str(word), [*fleet.groups, "all"], "there are")
                    raise UsageError(f"`{word}` is neither a group nor a share of the robots: {hint}")
            steps = tuple(target for target in found if target)
        if isinstance(condition, str):
            for fault in condition_faults(condition, fleet.measures) if condition else ():
                raise UsageError(f"--abort-if, character {fault.offset + 1}: {fault.message} ({fault.hint})")
        return RolloutPlan(
            steps,
            float(pause) if isinstance(pause, int | float) and 0.0 <= pause < 1e9 else usual.pause,
            condition if isinstance(condition, str) else usual.abort_if,
            bool(said.get("try", usual.try_first)),
        )

    def _pin(self, robot: str, by: str, *, on: bool) -> None:
        centre, state = self._centre, self._centre.state
        if robot not in centre.fleet.robots:
            raise UsageError(
                f"the fleet has no robot `{robot}`: {did_you_mean(robot, centre.fleet.robots, 'there are')}"
            )
        others = tuple(name for name in state.pinned if name != robot)
        pinned = (*others, robot) if on else others
        what = "is left out of rollouts" if on else "takes part in rollouts"
        centre.change(replace(state, pinned=pinned), f"{by}: {robot} {what}")
