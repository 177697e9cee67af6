"""A robot's agent, which receives orders and makes the robot run the ordered bundle without help.

The agent fetches the bundle by its hash and verifies the signature. The reload then lints the bundle for the robot's
body, replays the last visits, plans the change from the present configuration, applies it between two visits, and
watches the result. The agent does not compare clocks, never waits for the network, and trusts only signed messages.
"""

import time
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.errors import UsageError
from lumen.features.fleet.bundle import BadBundleError, BundleParts
from lumen.features.fleet.bundle_trial import BundleTrial, FileTrier, as_started, fitted, refusal
from lumen.features.fleet.installing import FOLDER, BundleFolder
from lumen.features.fleet.memory import AgentMemory
from lumen.features.fleet.rollouts.orders import NOT, desired_from, heed
from lumen.features.fleet.rollouts.presence import (
    BROKEN,
    CHECKING,
    FETCHING,
    HOURS,
    MAX_TEXT,
    PROBATION,
    PROVED,
    REFUSED,
    ROLLED_BACK,
    WAITING,
    RobotPresence,
)
from lumen.features.fleet.signing import ORDER, verified
from lumen.project.files import fingerprint

MOST_TRIES = 2
"""The number of restarts of the robot's process during a bundle's probation at which the agent gives up on it."""


class FileTaker(FileTrier, Protocol):
    """Applies files to a running behaviour."""

    @property
    def on_probation(self) -> bool:
        """Whether the running files are still on probation."""

    @property
    def unwritten(self) -> str:
        """Why the last `install` left the folder unchanged; empty if it did not."""

    def offer(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        """Apply files between two visits; `answer` receives each verdict."""

    def install(self, files: Mapping[str, bytes]) -> None:
        """Write the running files into the project's folder.

        Do nothing while another robot that shares the folder runs different files.
        """


class FleetAgent:
    """One robot's agent, which trusts the public key `key`.

    Call `tick` regularly, and `order` and `bundle` with the bodies of messages. `save` writes the agent's memory before
    the agent acts on a message. `tell` receives lines for the operator; `incident` receives the kind and text of an
    incident for the centre. No data that leaves the house contains people's names or words.
    """

    def __init__(
        self,
        house: str,
        robot: str,
        key: str,
        taker: FileTaker,
        memory: AgentMemory,
        folder: BundleFolder,
        *,
        save: Callable[[AgentMemory], str],
        tell: Callable[[str], None],
        incident: Callable[[str, str], None] = lambda kind, text: None,
    ) -> None:
        self._house, self._robot, self._key = house, robot, key
        self._taker, self.memory, self._folder = taker, memory, folder
        self._save, self._tell, self._incident = save, tell, incident
        self.state, self.trouble, self.wants, self.unwritten = PROVED, "", "", ""
        self._told: set[str] = set()
        self._offered = self._goal = ""
        self._asked = memory.order
        self.played = 0, 0
        self._parts = BundleParts()
        self.trial = BundleTrial(taker, folder, tell)
        if memory.trying:
            memory.tries += 1
            self._save(memory)

    @property
    def running(self) -> str:
        """The running bundle's hash in the fleet, before its adaptation to this house."""
        return self.memory.names.get(self._taker.running, self._taker.running)

    def order(self, body: Any) -> None:
        """Process a message with an order for this house; an invalid, unsigned or outdated order is only reported."""
        match body:
            case {"order": str(text), "signature": str(signature)}:
                pass
            case _:
                return self._refuse("an order is not valid")
        if not verified(self._key, ORDER, text.encode(), signature):
            return self._refuse("an order is not signed with the key in fleet.yaml")
        desired = desired_from(text)
        if desired is None or desired.house != self._house:
            return self._refuse("a signed order is not for this house")
        followed, why = heed(self.memory.followed, desired, self._robot)
        if why:
            return self._refuse(why)
        if followed != self.memory.followed:
            self.memory.followed, self._told = followed, set()
            self._save(self.memory)
        return None

    def bundle(self, body: Any) -> None:
        """Process a message with a bundle's part; ignore it unless the robot needs that bundle."""
        wants = self.wants or self.trial.wants
        if not wants or not isinstance(body, Mapping) or body.get("hash") != wants:
            return
        try:
            files = self._parts.take(body, wants, self._key)
        except BadBundleError as error:
            self._refuse(str(error))
            return
        if files is None:
            return
        if why := self._folder.keep(files):
            self._refuse(f"bundle {wants[:12]} can't be stored: {why}")
            return
        self.wants = self.trial.wants = ""

    def tick(self) -> None:
        """Advance the change to the ordered bundle, and the trial of a bundle."""
        memory, wanted = self.memory, self.memory.followed.wanted
        if self.state == PROBATION and self._taker.running != self._offered:
            self._fail(ROLLED_BACK, "the bundle failed its probation; the reason is in the house's journal")
        elif self.state == PROBATION and not self._taker.on_probation:
            self._proved()
        if self.state in (CHECKING, WAITING, PROBATION):
            return
        self.trial.tick(memory.followed.trying, self.running)
        back = wanted.startswith(NOT) and self.running == wanted[1:]
        goal = (memory.before if back else "") if wanted.startswith(NOT) else wanted
        self._goal = goal
        if back and not goal:
            self._asked = memory.order
            self._fail(REFUSED, "there are no earlier files to go back to", wanted)
        elif not goal or goal == self.running:
            self.state, self.wants = PROVED, ""
            if goal and not self._taker.on_probation and memory.done != memory.order:
                memory.done = memory.order
                self._save(memory)
        elif (failed := memory.failed.get(goal)) and failed[0] == memory.order:
            self.state, self.trouble = str(failed[1]), str(failed[2])
        elif memory.done == memory.order and self._taker.running != memory.before:
            self.state, self.trouble = BROKEN, "the robot's files were changed on this machine after the bundle arrived"
        else:
            self._go(goal, own=back)

    def presence(self, seconds: float, counted: Mapping[str, int]) -> RobotPresence:
        """Return the robot's presence, after adding `seconds` of running and the counts `counted` to its measures.

        Save the measures, and continue an unfinished installation.
        """
        memory = self.memory
        if memory.counted != self._taker.running:
            memory.past, memory.now = memory.now, {}
            memory.counted, memory.since = self._taker.running, time.time()
        for name, count in {HOURS: seconds / 3600.0, **counted}.items():
            memory.now[name] = memory.now.get(name, 0.0) + count
        self._save(memory)
        at = memory.followed
        name = f"{self._house}/{self._robot}"
        self._install()
        trouble = (self.trouble or self.unwritten or next(iter(self._told), ""))[:MAX_TEXT]
        about = self._goal or self.running
        return RobotPresence(
            name, self.running, self.state, about, trouble, self.wants or self.trial.wants,
            at.centre, at.term, at.version, dict(memory.now), dict(memory.past), time.time(), memory.since,
            *self.played, self.trial.said,
        )  # fmt: skip

    def _go(self, goal: str, *, own: bool) -> None:
        """Fetch a bundle, or offer it to the reload; `own` means that the files have run here before."""
        self._asked = self.memory.order
        self.trouble = ""
        if self.memory.trying == goal and self.memory.tries >= MOST_TRIES:
            self._fail(ROLLED_BACK, f"the exhibition ended {self.memory.tries} times before the bundle was proved")
            return
        kept = (own and self._taker.files(goal)) or self._folder.files(goal)
        if not kept:
            self.state, self.wants = FETCHING, goal
            return
        here = self._taker.files(self._taker.running)
        try:
            files = as_started(kept, here or {}) if own else fitted(kept, here or {})
        except UsageError as error:
            self._fail(REFUSED, str(error))
            return
        if here is not None and (why := self._folder.keep(here)):
            self._fail(REFUSED, f"the active files can't be stored: {why}")
            return
        self._offered = fingerprint(files)
        if not own:
            self.memory.name(self._offered, goal)
        if self._offered == self._taker.running:
            return
        self.state, self.wants = CHECKING, ""
        self._tell(f"bundle {goal[:12]} is being checked")
        self._taker.offer(files, self._answer)

    def _answer(self, verdict: Any) -> None:
        """Process the reload's verdict on the offered files."""
        match verdict:
            case {"verdict": "waiting", **more}:
                self.state, self.trouble = WAITING, str(more.get("reason", ""))
            case {"verdict": "applied", "before": str(before)}:
                self._played(verdict)
                self.state, self.trouble = PROBATION, ""
                if self.memory.trying != self._goal:
                    self.memory.trying, self.memory.tries = self._goal, 0
                self.memory.before = before
                self._save(self.memory)
            case {"verdict": "unchanged"}:
                self.state = PROVED
            case {"verdict": str(said)} if said != "judging":
                self._fail(REFUSED, refusal(verdict))

    def _played(self, verdict: Mapping[str, Any]) -> None:
        match verdict.get("visits"):
            case {"visits": int(visits), "same": int(same)}:
                self.played = visits, same

    def _proved(self) -> None:
        memory = self.memory
        memory.trying, memory.tries, memory.done = "", 0, self._asked  # a newer order may have arrived
        memory.writing = self._offered
        self.state = PROVED
        self._save(memory)
        self._install()
        ordered = memory.followed.wanted.removeprefix(NOT), memory.followed.trying
        self._folder.prune({memory.before, self._offered, self._goal, *memory.names.values(), *ordered})
        self._tell(f"bundle {self._goal[:12]} is proved")

    def _install(self) -> None:
        """Write proved files into the project's folder if that is still pending, and report each new error."""
        writing, why = self.memory.writing, self._taker.unwritten
        if writing and (files := self._taker.files(writing)) is not None:
            if error := self._folder.keep(files):
                why = f"{FOLDER} can't be written: {error}"
            else:
                self._taker.install(files)
        if why not in ("", self.unwritten):
            self._tell(f"{why}; until then the project's folder has the files from before")
            self._incident("folder", why[:MAX_TEXT])
        self.unwritten = why

    def _fail(self, state: str, why: str, goal: str = "") -> None:
        """Give up on a bundle until the next order."""
        memory, about = self.memory, goal or self._goal
        if memory.failed.get(about, [None])[0] != self._asked:
            memory.failed[about] = [self._asked, state, why[:MAX_TEXT]]
            memory.failed = dict(list(memory.failed.items())[-8:])
            self._tell(f"bundle {about.removeprefix(NOT)[:12]} {state}: {why}")
            self._incident(state, why[:MAX_TEXT])
        memory.trying, memory.tries = "", 0
        self.state, self.trouble, self.wants = state, why, ""
        self._save(memory)

    def _refuse(self, why: str) -> None:
        """Report why a message is rejected; each reason only once until the next new order, at most 10 reasons."""
        if why not in self._told and len(self._told) < 10:
            self._told.add(why)
            self._tell(why)
            self._incident("refused", why[:MAX_TEXT])
