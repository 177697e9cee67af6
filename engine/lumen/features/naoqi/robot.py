"""A real NAO or Pepper behind the `Robot` interface."""

from collections.abc import Callable, Sequence

from lumen.errors import RobotLostError
from lumen.features.naoqi.call_sequence import CallSequence
from lumen.features.naoqi.hardware import hardware_of
from lumen.features.naoqi.life import NaoqiLife
from lumen.features.naoqi.naoqi_events import FALLEN, FALLING, FULL, HealthAlerts, NaoqiEvents
from lumen.features.naoqi.preparing import halt, prepare
from lumen.features.naoqi.reconnector import Reconnector
from lumen.features.naoqi.sense_poller import SensePoller
from lumen.features.naoqi.sensors import NaoqiSensors
from lumen.features.naoqi.session import CALL_TIMEOUT, CONNECTION_LOST, NaoqiCall, NaoqiSession
from lumen.features.naoqi.skills import NaoqiSkills
from lumen.features.naoqi.walking_area import WalkingArea
from lumen.language.body_parts import part_of
from lumen.language.events import Event
from lumen.language.projects import Stage
from lumen.language.robots import Body
from lumen.motion.bounds import nearest_angles
from lumen.ports import Aim, Battery, Live, NativeCommand, Reading, RobotCommand, Sense, Sonar, Tactile
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.command_table import parts_of
from lumen.robot.executor import ExecutingRobot, Executor
from lumen.robot.skill_runner import SkillRunner


class NaoqiRobot(ExecutingRobot):
    """The NAO or Pepper at `url`, in real time: `clock` returns the time of its answers, events and readings [s].

    Connecting ends autonomous life and switches the reflexes on. When the connection breaks, all commands fail and
    `robot.lost` is raised; after reconnecting, `robot.back` is raised. `stage` limits walks, relative to the robot's
    position at the first connection. `patience` is the maximum wait for an answer [s]. Raises RobotError if no robot
    answers, or if the robot does not match `body`.
    """

    def __init__(
        self,
        body: Body,
        url: str,
        clock: Callable[[], float],
        *,
        stage: Stage | None = None,
        patience: float = CALL_TIMEOUT,
    ) -> None:
        self.body, self._bounds = body, CommandBounds(body)
        self._clock = clock
        self._session = NaoqiSession(url, lambda reason: self._reconnector.lose(reason), patience)
        self._naoqi_events = NaoqiEvents(body.tactile)
        self._area = WalkingArea(stage, self._naoqi_events.pressed, self._echo, hardware_of(body))
        self._sensors = NaoqiSensors(
            self._session, body, clock, self._area.whereabouts, lambda: self._life.layer.offsets
        )
        self._alerts = HealthAlerts()
        self._events: list[Event] = []
        self._skills = NaoqiSkills(self._session, body, self._area, self._events.append, clock)
        self._skill_runner = SkillRunner()
        self._executor = Executor(self._begin, lambda command: parts_of(command, body), self._skill_runner.begin)
        self._part = part_of(body)
        self._life = NaoqiLife(self._session, self._executor.owner, body)
        self._aimed: NaoqiCall = NaoqiCall()
        self._aim: Aim | None = None
        self._reconnector = Reconnector(self._session, self._take_over)
        self._reconnector.open()
        self._senses = {
            sense: SensePoller(sense, self._session, *reader) for sense, reader in self._sensors.readers().items()
        }

    def start(self, id: str, command: RobotCommand) -> None:
        """Begin a command; `Aim` and `Live` have no end and no answer."""
        if isinstance(command, Live):
            self._life.live(command)
            self._skills.body_language = self._life.body_language
            return
        if not isinstance(command, Aim):
            self._executor.start(id, command)
            return
        if aim := self._bounds.aim(command):
            self._aim = aim
            self._life.led(aim.angles, self._clock())
            self._turn()

    def poll(self) -> Sequence[Event]:
        """Return the events since the last call, and advance commands and life."""
        now = self._clock()
        self._feel(now)
        self._turn()
        answers = self._executor.advance(now)
        self._live(now)
        events = [*self._events, *answers]
        self._events.clear()
        return events

    def read(self, sense: Sense) -> Reading | None:
        """Return the newest reading of a sense; None if no reading is available."""
        return self._senses[sense].newest

    def close(self) -> None:
        """End commands, senses and threads; the robot keeps its posture."""
        self._skill_runner.close()
        self._reconnector.close()
        for sense in self._senses.values():
            sense.close()
        if self._session.up:
            if self._executor.busy:
                halt(self._session, list(self.body.joints))
            self._sensors.end()
        self._session.close()

    def _begin(self, command: NativeCommand, now: float) -> CallSequence:
        if not self._session.ready:
            raise RobotLostError(CONNECTION_LOST)
        command = self._bounds.fit(command)
        activity = self._skills.begin(command, now)
        self._life.begins(command, now)
        return activity

    def _take_over(self, again: bool) -> None:
        """Prepare the robot after connecting, on the connecting thread; `again` is False only for the first time."""
        prepare(self._session, self.body, again=again)
        self._naoqi_events.listen(self._session)
        self._sensors.begin()
        if not again:
            self._area.meet(self._session.request("ALMotion", "getRobotPosition", True))

    def _feel(self, now: float) -> None:
        """Process new touches, falls and sounds, and changes of connection, battery and heat, since the last poll."""
        for name, seconds, reason in self._reconnector.changes():
            if name == "robot.lost":
                self._executor.fail(f"the connection to the robot is lost: {reason}")
                self._life.lose()
            self._events.append(Event(name, {"seconds": round(seconds, 3)}, now))
        felt = self._senses[Sense.TACTILE].newest
        for name, value in self._naoqi_events.take(now, felt if isinstance(felt, Tactile) else None):
            if name in self.body.tactile:
                if value:
                    self._life.layer.touched(name, now)
                self._events.append(Event("touched" if value else "released", {"sensor": name}, now))
            elif value and name in (FALLEN, *FALLING):
                self._fall(name, now)
            elif value and name == FULL:
                self._events.append(Event("battery.full", {"percentage": 100}, now))
        for yaw, pitch in self._naoqi_events.sounds():
            self._life.layer.heard_by_head(yaw, pitch, now)
        battery = self._senses[Sense.BATTERY].newest
        if isinstance(battery, Battery):
            self._events += self._alerts.battery(battery.percentage, now)
        self._events += self._alerts.motors(self._sensors.heat, now)

    def _fall(self, name: str, now: float) -> None:
        """Make all commands fail; after the fall (`name` is FALLEN), also raise the event `fallen`."""
        self._skills.fallen = True
        self._executor.fail("the robot fell", fallen=True)
        if name == FALLEN:
            self._area.fell()
            self._events.append(Event("fallen", {}, now))

    def _turn(self) -> None:
        """Send the newest aim for joints that no command owns, unless NAOqi is still busy with the last aim."""
        aim = self._aim
        if aim is None or not self._aimed.done or self._skills.fallen:
            return
        self._aim = None
        free = {n: a for n, a in aim.angles.items() if not self._executor.owner(self._part.get(n, ""))}
        if free and self._session.ready:
            inside = nearest_angles(self._life.alive(free), self.body)
            self._aimed = self._session.post("ALMotion", "setAngles", list(inside), list(inside.values()), aim.speed)

    def _live(self, now: float) -> None:
        """Add small lifelike movements to joints that no command moves."""
        battery = self._senses[Sense.BATTERY].newest
        percentage = battery.percentage if isinstance(battery, Battery) else 100
        if self._session.ready and not self._skills.fallen:
            self._life.tick(now, self._sensors.heat, percentage)

    def _echo(self) -> Sonar | None:
        echo = self._senses[Sense.SONAR].newest
        return echo if isinstance(echo, Sonar) else None
