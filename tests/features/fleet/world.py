"""Simulated robots, messages and centres, with delays, losses, repetitions, kills and wrong clocks."""

import random
from dataclasses import dataclass, field, replace

from lumen.features.fleet.rollouts.orders import NOT, DesiredState, FollowedOrder, heed
from lumen.features.fleet.rollouts.presence import PROBATION, PROVED, REFUSED, ROLLED_BACK, SAME, RobotPresence
from lumen.features.fleet.rollouts.rollout import begin, decide, step
from lumen.features.fleet.rollouts.state import PERSON, CentreState, HeardPresence, state_from_json, state_to_json
from lumen.features.fleet.settings import Fleet, FleetHouse, FleetMeasure, RolloutPlan, StepTarget

OLD = "a" * 64
PERIOD = 10.0
PLAN = RolloutPlan((StepTarget(share=0.1), StepTarget(share=0.3), StepTarget(share=1.0)), 60.0, "falls > 0")


@dataclass
class SimulatedRobot:
    """A robot's stored state and its power switch; `fails` lists the bundles that fail their probation."""

    name: str
    bundle: str = OLD
    before: str = OLD
    followed: FollowedOrder = field(default_factory=lambda: FollowedOrder("one", 1))
    on: bool = True
    taken: float = 0.0
    state: str = PROVED
    about: str = ""
    skew: float = 0.0
    told: list[str] = field(default_factory=list)
    fails: frozenset[str] = frozenset()
    refuses: frozenset[str] = frozenset()
    falls: int = 0

    def hear(self, order: DesiredState) -> None:
        new, why = heed(self.followed, order, self.name.partition("/")[2])
        if why:
            self.told.append(why)
        elif new != self.followed:
            self.followed, self.state = new, PROVED

    def live(self, now: float) -> None:
        want = self.followed.wanted
        if self.state == PROBATION and now - self.taken >= 10.0:
            if self.bundle in self.fails:
                self.about, self.state = self.bundle, ROLLED_BACK
                self.bundle = self.before
            else:
                self.state = PROVED
        elif want.startswith(NOT):
            if self.bundle == want[1:]:
                self.bundle, self.state = self.before, PROVED
        elif want and want != self.bundle and self.state == PROVED:
            self.before, self.bundle, self.about = self.bundle, want, want
            self.state, self.taken = PROBATION, now

    def presence(self, now: float) -> RobotPresence:
        trying = self.followed.trying
        verdict = REFUSED if trying in self.refuses else SAME
        tried = {"bundle": trying, "verdict": verdict, "played": 0, "same": 0, "why": "a:1: b"} if trying else {}
        at = self.followed
        counts = {"hours": 0.1 + (now - self.taken) / 3600.0, "falls": float(self.falls)}
        return RobotPresence(
            self.name, self.bundle, self.state, self.about, "", "", at.centre, at.term, at.version,
            counts, {"hours": 10.0, "falls": 0.0}, now + self.skew,
            tried=tried,
        )  # fmt: skip


class World:
    """A fleet of robots in three houses, and a network that treats messages as `chance` decides."""

    def __init__(self, count: int, seed: int, plan: RolloutPlan = PLAN) -> None:
        self.random, self.now, self.plan = random.Random(seed), 1000.0, plan
        names = [f"nao{i}" for i in range(count)]
        houses = {f"h{i}": FleetHouse("amqp://127.0.0.1/", tuple(names[i::3])) for i in range(3)}
        self.fleet = Fleet(houses=houses, measures={"falls": FleetMeasure("fallen")})
        self.robots = {name: SimulatedRobot(name) for name in self.fleet.robots}
        self.centre = CentreState("one")
        self.written = state_to_json(self.centre)
        self.heard: dict[str, HeardPresence] = {}
        self.alive, self.clock_error = True, 0.0
        self.up: list[tuple[float, RobotPresence]] = []
        self.down: list[tuple[float, DesiredState]] = []
        self.cut: set[str] = set()
        self.tick()

    def orders(self) -> list[DesiredState]:
        found = []
        for house, row in self.fleet.houses.items():
            wanted = {r: w for r in row.robots if (w := self.centre.wanted.get(f"{house}/{r}"))}
            found.append(
                DesiredState(
                    self.centre.centre, self.centre.term, self.centre.version, house, wanted, self.centre.trying
                )
            )
        return found

    def delay(self) -> float:
        return self.random.choice((0.0, 0.0, 1.0, 25.0, 200.0))

    def send_down(self, order: DesiredState) -> None:
        if order.house not in self.cut:
            self.down += [(self.now + self.delay(), order) for _ in range(self.random.choice((0, 1, 1, 2)))]

    def roll(self, bundle: str) -> None:
        """Begin a rollout of this bundle; do nothing if the centre refuses it."""
        try:
            self.keep(begin(self.centre, self.fleet, bundle, self.plan, self.now))
        except ValueError:
            return

    def keep(self, state: CentreState) -> None:
        self.centre, self.written = state, state_to_json(state)

    def kill(self) -> None:
        self.alive, self.heard = False, {}

    def restart(self) -> None:
        """Start the centre again from what it wrote, with a clock that may have been changed."""
        self.alive, self.centre = True, state_from_json(self.written)

    def tick(self) -> None:
        self.now += PERIOD
        for at, order in [row for row in self.down if row[0] <= self.now]:
            self.down.remove((at, order))
            for robot in self.robots.values():
                if robot.on and robot.name.startswith(f"{order.house}/") and order.house not in self.cut:
                    robot.hear(order)
        for robot in self.robots.values():
            if robot.on:
                robot.live(self.now)
                if robot.name.partition("/")[0] not in self.cut:
                    self.up.append((self.now + self.delay(), robot.presence(self.now)))
        for at, said in [row for row in self.up if row[0] <= self.now]:
            self.up.remove((at, said))
            self.heard[said.robot] = HeardPresence(said, self.now + self.clock_error)
        if self.alive:
            self.keep(step(self.centre, self.fleet, self.heard, self.now + self.clock_error))
            for order in [] if self.centre.overruled else self.orders():
                self.send_down(order)

    def on(self, bundle: str) -> int:
        """Count the robots that run the bundle now, reported or not."""
        return sum(robot.bundle == bundle for robot in self.robots.values())

    def approve(self) -> None:
        rollout = self.centre.rollout
        if rollout and rollout.state == PERSON:
            self.keep(decide(self.centre, "going", "seen"))

    def stranger(self, house: str, wanted: str) -> DesiredState:
        """Return an order of another centre, of the same term."""
        robots = dict.fromkeys(self.fleet.houses[house].robots, wanted)
        return replace(self.orders()[0], centre="two", house=house, robots=robots, version=self.centre.version + 5)
