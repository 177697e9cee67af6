"""The simulated robot in its hall, which implements the `Robot` and `Hall` interfaces."""

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from lumen.errors import RobotRefusedError, UsageError
from lumen.feature import owner
from lumen.features.simulation.base import BaseRequest, RobotBase
from lumen.features.simulation.battery_and_heat import BatteryAndHeat
from lumen.features.simulation.hall_sensors import ForceSensors, Sonars, TactileSensors
from lumen.features.simulation.hazards import Hazards
from lumen.features.simulation.lights import Lights
from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.playback import SpeechActivity
from lumen.features.simulation.rendering import CAMERA_QUALITY, PixelArray, RenderState, SceneRenderer, available
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.skills import SimulatedSkills
from lumen.features.simulation.sound_playback import SoundPlayback, SpeechPlayback
from lumen.features.simulation.visitor_figure import VisitorFigure
from lumen.features.simulation.world import CONTROL_PERIOD, FALLEN_TILT, World
from lumen.language.body_parts import ARMS, LEGS, VOICE, WHOLE_BODY
from lumen.language.causes import VISITOR, Cause
from lumen.language.commands import Rest, Say
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.projects import Stage
from lumen.language.robots import Body, Camera
from lumen.language.roles import HEAD_ROLES
from lumen.language.routes import BATTERY, IMAGE, JOINT, SONAR, TACTILE, Size
from lumen.language.stories import Visitor
from lumen.motion.life import vigour
from lumen.motion.projection import centring, project
from lumen.ports import Aim, Battery, Image, Joints, Live, NativeCommand, Reading, RobotCommand, Sense, Sonar, Tactile
from lumen.project.broken_features import called, need_made
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.executor import Activity, ExecutingRobot, Executor
from lumen.robot.life_layer import LifeLayer
from lumen.robot.skill_runner import SkillRunner


class RobotCamera:
    """The robot's camera: it takes images that another thread can draw later, and projects points into them."""

    def __init__(self, world: World, camera: Camera) -> None:
        self._world, self._camera = world, camera
        self._name = f"{world.prefix}/{world.body.roles.eyes.camera}"
        self._renderer = None if available() else SceneRenderer(world.model, CAMERA_QUALITY)

    def image(self, now: float) -> Image | None:
        """Return an image of the present scene, drawn when its pixels are requested; None if nothing can be drawn."""
        if self._renderer is None:
            return None
        studio, camera, name = self._renderer, self._camera, self._name
        scene = RenderState.of(self._world.model, self._world.data)

        def pixels(size: Size | None = None) -> PixelArray:
            return studio.draw(scene, name, *(size or (camera.width, camera.height)))

        return Image(now, pixels)

    def pixel(self, point: tuple[float, float, float]) -> tuple[float, float] | None:
        """Return the pixel of a point of the hall [m]; None if the point is behind the camera or outside the image."""
        view = self._world.data.camera(self._name)
        right, up, back = view.xmat.reshape(3, 3).T @ (point - view.xpos)
        return project((-float(back), -float(right), float(up)), self._camera)

    def close(self) -> None:
        """Close this thread's OpenGL contexts."""
        if self._renderer:
            self._renderer.close()


class AimController:
    """Moves the goals of joints that no command owns; a joint's new aim replaces its earlier one."""

    def __init__(self, motors: Motors) -> None:
        self._motors = motors
        self._aims: dict[str, tuple[float, float]] = {}

    def aim(self, aim: Aim) -> None:
        """Begin to move the joints of `aim`, each at the share `aim.speed` of its maximum speed."""
        speeds = self._motors.envelope.speed
        for name, angle in aim.angles.items():
            speed = float(speeds[self._motors.index[name]]) * aim.speed
            self._aims[name] = angle, speed

    def advance(self, dt: float, free: Callable[[str], bool]) -> None:
        """Advance by `dt` [s]. A joint's aim ends when it is reached, or when `free` returns False for the joint."""
        moved = {}
        for name, (angle, speed) in list(self._aims.items()):
            if not free(name):
                del self._aims[name]
                continue
            goal = float(self._motors.goal[self._motors.index[name]])
            moved[name] = min(max(angle, goal - speed * dt), goal + speed * dt)
            if moved[name] == angle:
                del self._aims[name]
        if moved:
            self._motors.aim(moved)


_EMPTY = "battery-empty"
"""The id of the `Rest` that an empty battery triggers."""

STANDING_TILT = 0.3
"""The torso's tilt below which the robot counts as standing [rad]."""

_CONDITION_EVERY = 10
"""The number of control periods between two updates of the battery and the motors' heat."""


class SimulatedRobot(ExecutingRobot):
    """A physically simulated robot on its stage; its time passes only in `advance`, in the caller's thread.

    `models` is the folder of the MJCF files, and `hall` is one of these files. The same seed and calls give the same
    run. The default imperfections are a NAO's. `stage` bounds the robot's walks and drives. If robots share a `world`
    and the visitor's `figure`, the world's owner calls `act` and `feel` instead of `advance`. Raises RobotError if the
    models are unusable.
    """

    def __init__(
        self,
        body: Body,
        models: Path,
        hall: str = "hall.xml",
        *,
        seed: int = 0,
        posture: str = "Stand",
        variation: Variation | None = None,
        imperfections: Imperfections | None = None,
        stage: Stage | None = None,
        world: World | None = None,
        figure: VisitorFigure | None = None,
    ) -> None:
        self.body = body
        lacking = imperfections or Imperfections()
        self.world = world or World(body, Path(models), hall, variation, backlash=lacking.backlash)
        prefix = self.world.prefix
        self.world.set_up(body.postures[posture])
        self.motors = Motors(self.world, lacking)
        self.lights = Lights(self.world.model, body.roles.lights, prefix)
        self.condition = BatteryAndHeat(tuple(body.joints), [joint.effort for joint in body.joints.values()])
        self.greatest_tilt = 0.0
        self._bounds = CommandBounds(body)
        self._aiming = AimController(self.motors)
        self._life = LifeLayer(body, seed)
        self._vigour = dict.fromkeys(body.parts, 1.0)
        self._sensors = BodySensors(self.world, lacking, seed)
        self._pressed = dict.fromkeys(body.tactile, False)
        self._held: set[str] = set()
        self._tactile = TactileSensors(self.world.model, self.world.data, body.tactile, prefix)
        self._force_sensors = ForceSensors(self.world.model, self.world.data, body.roles, prefix)
        ears = body.roles.sensors.sonar
        self._sonars = (
            Sonars(self.world.model, self.world.data, body.sonar, ears, seed, prefix) if body.sonar and ears else None
        )
        hazards = Hazards(self._sonars, self._pressed)
        self.base = self._made_base(Path(models), hazards, lacking, stage)
        self._skills = SimulatedSkills(
            self.world, self.motors, self.lights, self.base, self._sensors, posture, self._notice
        )
        self._skill_runner = SkillRunner()
        self._executor = Executor(self._begin, self._skills.parts, self._skill_runner.begin)
        self.figure = figure or VisitorFigure(self.world.model, self.world.data)
        self._camera = RobotCamera(self.world, body.camera) if body.camera and body.roles.eyes.camera else None
        self._events: list[Event] = []
        self._exhausted = False
        self._ticks = 0
        self._until = 0.0

    def _made_base(self, models: Path, hazards: Hazards, lacking: Imperfections, stage: Stage | None) -> RobotBase:
        """Make this body's base. Raises LumenError, with the package's name, if the base's row is faulty."""
        base = self.body.roles.base
        feature, simulate = owner("bases", base.kind), base.row.simulate

        def hot() -> bool:
            return self.condition.hot

        made: RobotBase = called(
            feature,
            simulate,
            BaseRequest(self.world, models, self.motors, self._sensors, lacking, hazards, stage, self._free, hot),
        )
        need_made(feature, simulate, made, RobotBase, "a base")
        return made

    @property
    def time(self) -> float:
        """The robot's time since its start [s]."""
        return self._ticks * CONTROL_PERIOD

    @property
    def fallen(self) -> bool:
        """True if the robot has fallen."""
        return self._skills.fallen

    @property
    def awake(self) -> bool:
        """True if the motors are on."""
        return self._skills.awake

    def speak_with(self, voice: SpeechPlayback) -> None:
        """Use this voice for spoken texts; the voice determines each text's duration."""
        self._skills.voice = voice

    def sound_with(self, playback: SoundPlayback) -> None:
        """Use this player for sound files."""
        self._skills.sounds = playback

    def advance(self, dt: float) -> None:
        """Advance by `dt` [s] in whole control periods; the remainder is kept for the next call.

        Raises RobotError if the models make the simulation unstable.
        """
        self._until += dt
        while self.time + CONTROL_PERIOD <= self._until + 1e-9:
            self.act()
            self.world.step()
            self.feel()

    def start(self, id: str, command: RobotCommand) -> None:
        """Begin a command; `poll` returns its events under `id`. `Aim` and `Live` cause no such events.

        An `Aim` is ignored if the motors are off or the robot has fallen.
        """
        if isinstance(command, Live):
            self._life.live(command)
            return
        if not isinstance(command, Aim):
            self._executor.start(id, command)
            return
        aim = self._bounds.aim(command)
        if aim and self.awake and not self.fallen:
            self._aiming.aim(aim)
            self._life.led(aim.angles, self.time)

    def poll(self) -> Sequence[Event]:
        """Return the events since the last call, in order; empty if nothing happened."""
        events, self._events = self._events, []
        return events

    def read(self, sense: Sense) -> Reading | None:
        """Return the present reading of a sense; None if the robot lacks it or an image can't be drawn."""
        measure = self._senses.get(sense)
        return measure() if measure else None

    @cached_property
    def _senses(self) -> Mapping[str, Callable[[], Reading | None]]:
        """The methods that measure the senses."""
        return {
            IMAGE: self._image,
            JOINT: self._joints,
            SONAR: self._sonar,
            TACTILE: self._touch_sensors,
            BATTERY: self._battery,
        }

    def _image(self) -> Image | None:
        return self._camera.image(self.time) if self._camera else None

    def _joints(self) -> Joints:
        angles, stiffness = self._sensors.angles.tolist(), self.motors.stiffness.tolist()
        heat = tuple(self.condition.temperatures.round(1).tolist())
        felt = heat, self._sensors.inertial, self._force_sensors.weigh()
        where, life = self.base.whereabouts, self._life.offsets
        return Joints(self.time, self.motors.names, tuple(angles), tuple(stiffness), *felt, where, life)

    def _sonar(self) -> Sonar | None:
        return Sonar(self.time, *self._sonars.measure()) if self._sonars else None

    def _touch_sensors(self) -> Tactile:
        return Tactile(self.time, tuple(self._pressed), tuple(map(int, self._pressed.values())))

    def _battery(self) -> Battery:
        condition = self.condition
        return Battery(self.time, condition.percentage, condition.plugged, condition.charging)

    def close(self) -> None:
        """End the skills' programs and close the camera."""
        self._skill_runner.close()
        if self._camera:
            self._camera.close()

    @property
    def runs_no_skills(self) -> bool:
        return False

    def set_skills(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        self._skill_runner.set_ends(ends)

    def place(self, visitor: Visitor | None) -> None:
        """Put the visitor at this place; None removes the visitor."""
        self.figure.place(visitor)

    def face(self) -> tuple[float, float] | None:
        """Return the pixel of the visitor's face; None without a visitor or camera, or if the image lacks the face."""
        face = self.figure.face()
        return self._camera.pixel(face) if face and self._camera else None

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor. Raises UsageError if the robot lacks it."""
        if sensor not in self._pressed:
            raise UsageError(f"no sensor `{sensor}`: {did_you_mean(sensor, self._pressed, 'there are')}")
        (self._held.add if pressed else self._held.discard)(sensor)
        self._feel_touch({sensor})

    def _feel_touch(self, touched: Collection[str] = ()) -> None:
        """Update the pressed sensors and queue events for changes; the visitor causes those of sensors in `touched`."""
        now = self._held | self._tactile.pressed()
        for sensor, before in self._pressed.items():
            if before != (sensor in now):
                self._pressed[sensor] = not before
                if not before:
                    self._life.touched(sensor, self.time)
                by = Cause("person", sender=VISITOR) if sensor in touched else None
                self._events.append(Event("released" if before else "touched", {"sensor": sensor}, self.time, cause=by))

    def sound(self) -> None:
        """Let the robot hear a sound from the visitor's face; do nothing without a visitor or a camera."""
        face = self.figure.face()
        if face is not None and self.body.camera:
            torso = self.world.data.body(f"{self.world.prefix}/{self.body.roles.torso}")
            x, y, z = (torso.xmat.reshape(3, 3).T @ (np.array(face) - torso.xpos)).tolist()
            away = dict(zip(HEAD_ROLES, centring((x, y, z), self.body.camera), strict=True))
            for role in self.body.roles.head.keys() & away.keys():
                turn = self.body.roles.head[role]
                away[role] -= turn.sign * self.motors.wanted((turn.joint,))[turn.joint]
            self._life.heard(away["yaw"], away["pitch"], self.time)

    def plug(self, plugged: bool) -> None:
        """Connect or disconnect the charger."""
        self.condition.plugged = plugged

    def _notice(self, event: Event) -> None:
        self._events.append(event)

    def _begin(self, command: NativeCommand, now: float) -> Activity:
        if self.condition.empty and not isinstance(command, Rest):
            raise RobotRefusedError("the battery is empty: plug the robot in")
        activity = self._skills.begin(self._bounds.fit(command), now)
        if isinstance(command, Say) and isinstance(activity, SpeechActivity):
            self._life.say(command, activity.duration, now, activity.words)
        return activity

    def act(self) -> None:
        """Move the motors for one control period, before the world's step."""
        now = self.time
        self._events += [e for e in self._executor.advance(now) if not e.name.endswith(f".command.{_EMPTY}")]
        self._aiming.advance(CONTROL_PERIOD, self._free)
        self._sensors.feel(at_rest=not (self._executor.owner(LEGS) or self.base.catching))
        if not self.awake:
            self._life.still()
            self.base.relax()
        else:
            upright = self._skills.upright
            self._live(now)
            trim = self.base.steady(now, standing=upright and not self.fallen, upright=upright)
            self.motors.drive(trim, CONTROL_PERIOD)

    def feel(self) -> None:
        """Update the robot's condition after the world's step."""
        self._ticks += 1
        self._watch(self.time)

    def _live(self, now: float) -> None:
        """Add small lifelike movements to body parts that no command owns.

        A fallen robot makes none; a robot that is not on its feet moves only its head.
        """
        owner = self._executor.owner
        free = {part for part in WHOLE_BODY if not (self.fallen or owner(part))}
        if not self._skills.upright:
            free -= {ARMS, LEGS}
        if not owner(VOICE):
            self._life.hush(now)
        self.motors.sway(self._life.advance(now, CONTROL_PERIOD, free, self._vigour.__getitem__))
        self.lights.wear_eyes(self._life.eyes(now))

    def _free(self, joint: str) -> bool:
        """Return True if no command owns the joint's body part and the motors are on."""
        return self.awake and not self._executor.owner(self._skills.part(joint))

    def _watch(self, now: float) -> None:
        """Update touch and position, detect a fall, and update battery and heat every `_CONDITION_EVERY` periods."""
        tilt = self.world.tilt
        self._feel_touch()
        upright = self._skills.upright
        if not upright or self.fallen:
            self.base.lose("" if self.fallen else self._skills.posture)
        elif tilt < STANDING_TILT:
            self.base.keep(self._sensors.heading)
        self.greatest_tilt = max(self.greatest_tilt, degrees(tilt)) if upright else self.greatest_tilt
        if tilt > FALLEN_TILT and upright and not self.fallen:
            self._skills.fall(now)
            self._executor.fail("the robot fell", fallen=True)
            self._events.append(Event("fallen", {}, now))
        self._skills.lie(now)
        if self._ticks % _CONDITION_EVERY == 0:
            world = self.world
            world.check()
            self.motors.voltage = self.condition.voltage
            self._events += self.condition.live(world.torques, world.speeds, _CONDITION_EVERY * CONTROL_PERIOD, now)
            self._exhaust()
            self._calm()

    def _calm(self) -> None:
        """Reduce the lifelike movements of body parts with warm motors, and of all parts if the battery is low."""
        for part, joints in self.body.parts.items():
            warmest = max((self.condition.temperatures[self.motors.index[joint]] for joint in joints), default=0.0)
            self._vigour[part] = vigour(float(warmest), self.condition.percentage)

    def _exhaust(self) -> None:
        """Start `Rest` when the battery becomes empty: the remaining energy suffices to reach Crouch."""
        if self.condition.empty and self.awake and not self._exhausted:
            self._executor.start(_EMPTY, Rest())
        self._exhausted = self.condition.empty
