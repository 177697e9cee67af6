"""The promises of every robot (`lumen.ports.Robot`); `pytest --lumen-robot` runs them with a robot of your own."""

from math import inf, nan

from lumen.language.commands import Leds, Look, Move, Posture, Rest, Say, Stop, Volume, Wake
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.roles import HEAD_PITCH, HEAD_YAW
from lumen.language.stories import Visitor
from lumen.ports import Aim, Battery, FeelsTouch, Hall, HasCharger, Joints, Live, Perform, Record, RobotCommand, Sense
from lumen.testing.trial import RobotTrial

ENDS = ("done", "error", "cancelled")
TOLERANCE = 0.05
"""The angle by which a joint may sag or swing beyond a limit or a goal [rad]."""


def test_a_command_is_answered_once(trial: RobotTrial) -> None:
    """`poll` reports the end of each command exactly once, whatever becomes of it."""
    trial.start("say", Say("Hello there"))
    trial.start("look", Look(0.2, 0.1))
    trial.answered("say", "look")
    trial.live(1.0)
    for id in ("say", "look"):
        if len(trial.answers(id)) > 1:
            trial.fail(f"answered the command `{id}` {len(trial.answers(id))} times: {', '.join(trial.answers(id))}")


def test_an_answer_is_an_end(trial: RobotTrial) -> None:
    """An end is `done`, `error` with a reason, or `cancelled`."""
    trial.start("volume", Volume(0.5))
    [end] = trial.answered("volume")
    if end not in ENDS:
        trial.fail(f"answered with `{end}.command.volume`: an answer begins with {', '.join(ENDS)}")
    event = next(event for event in trial.events if event.name.endswith(".command.volume"))
    if end == "error" and not (isinstance(event.data, dict) and isinstance(event.data.get("reason"), str)):
        trial.fail(f"answered `error` with {event.data!r}: its data must be " + '{"reason": "…"}')


def test_what_it_can_not_do_is_an_answer(trial: RobotTrial) -> None:
    """A posture that no body has is answered by an error, not by an exception."""
    trial.start("a", Posture("Handstand"))
    [end] = trial.answered("a")
    if end != "error":
        trial.fail(f"answered `{end}` to the posture `Handstand`, which its body does not have: that is an `error`")


def test_what_is_no_number_moves_nothing(trial: RobotTrial) -> None:
    """A goal that is not a number is refused."""
    trial.start("a", Look(nan))
    [end] = trial.answered("a")
    if end != "error":
        trial.fail(f"answered `{end}` to a look at an angle that is no number: that is an `error`")


def test_a_cancelled_command_ends_soon(trial: RobotTrial) -> None:
    """A command ends within two seconds after `cancel`; repeated and unknown ids do nothing."""
    trial.start("a", Say("A long text, because it has many words and one more."))
    trial.live(0.2)
    for id in ("a", "a", "no such id"):
        trial.cancel(id)
    trial.answered("a", seconds=2.0)
    trial.live(0.5)
    if len(trial.answers("a")) > 1:
        trial.fail(f"answered a command {len(trial.answers('a'))} times after `cancel`")


def test_rest_ends_everything(trial: RobotTrial) -> None:
    """A rest always ends with `done`, and commands that ran before it are answered too."""
    trial.start("say", Say("x" * 100))
    trial.live(0.3)
    trial.start("rest", Rest())
    _, end = trial.answered("say", "rest")
    if end != "done":
        trial.fail(f"answered `{end}` to a rest: a robot can always rest")


def test_after_rest_it_wakes(trial: RobotTrial) -> None:
    """A robot that rests wakes again."""
    trial.start("rest", Rest())
    trial.answered("rest")
    trial.start("wake", Wake())
    [end] = trial.answered("wake")
    if end != "done":
        trial.fail(f"answered `{end}` to a wake after a rest")


def test_a_stop_is_answered(trial: RobotTrial) -> None:
    """A stop is done, and ends what it names."""
    motion = next(iter(trial.project.motions.values()), None)
    if motion:
        trial.start("play", Perform(motion))
        trial.live(0.2)
    trial.start("stop", Stop("all"))
    [end] = trial.answered("stop")
    if end != "done":
        trial.fail(f"answered `{end}` to a stop: a robot can always stop")
    if motion:
        trial.answered("play", seconds=2.0)


def test_an_aim_is_not_answered(trial: RobotTrial) -> None:
    """An aim has no id, so an answer to it would end another command."""
    joint = next(iter(trial.project.body.joints))
    trial.start("", Aim({joint: 0.0}, 0.5))
    trial.live(1.0)
    if ends := trial.answers(""):
        trial.fail(f"answered `{ends[0]}` to an aim, which is not answered")


def test_an_aim_leaves_alone_what_a_command_owns(trial: RobotTrial) -> None:
    """A joint that a command moves reaches the goal of the command, whatever aims arrive meanwhile."""
    joint = _head(trial)
    if not joint or not trial.angles():
        return
    _wake(trial)
    trial.start("look", Look(0.2, 0.1))
    trial.live(0.1)
    goal = trial.project.body.roles.head_joints(0.2, 0.1)[joint]
    trial.start("", Aim({joint: -goal}, 0.5))
    [end] = trial.answered("look")
    trial.live(1.0)
    if end == "done" and abs(trial.angles()[joint] - goal) > TOLERANCE:
        trial.fail(
            f"moved `{joint}` to {trial.angles()[joint]:.2f} rad for an aim, while a look moved it to {goal:.2f}"
        )


def test_what_is_no_angle_moves_nothing(trial: RobotTrial) -> None:
    """An aim at an angle that is not finite, or for a joint that the body lacks, moves nothing."""
    _wake(trial)
    trial.live(1.0)
    before = trial.angles()
    for joint in trial.project.body.joints:
        trial.start("", Aim({joint: nan}, 0.5))
        trial.start("", Aim({joint: inf}, 0.5))
    trial.start("", Aim({"NoSuchJoint": 0.1}, 0.5))
    trial.live(1.0)
    for name, angle in trial.angles().items():
        if abs(angle - before[name]) > TOLERANCE:
            trial.fail(f"moved `{name}` by {angle - before[name]:.2f} rad for an aim at an angle that is no number")


def test_no_command_leaves_the_limits(trial: RobotTrial) -> None:
    """Also with idle life added, no joint goes beyond its limits, whatever is demanded."""
    body, head = trial.project.body, _head(trial)
    far = {head: (Keyframe(0.3, -9.0),)} if head else {}
    hasty = {head: (Keyframe(0.1, 2.0), Keyframe(0.2, -2.0))} if head else {}
    commands: dict[str, RobotCommand] = {
        "look": Look(9.0, 9.0),
        "far": Perform(MotionDefinition("far", 0.5, far)),
        "hasty": Perform(MotionDefinition("hasty", 0.2, hasty)),
    }
    _wake(trial)
    for style in [*trial.project.life.values()][:1]:
        trial.start("", Live(style))
    for id, command in commands.items():
        trial.start(id, command)
        while not trial.answers(id) and trial.now < 60.0:
            trial.live(0.2)
            for name, angle in trial.angles().items():
                limit = body.joints[name]
                if not limit.minimum - TOLERANCE <= angle <= limit.maximum + TOLERANCE:
                    trial.fail(f"moved `{name}` to {angle:.2f} rad, beyond its limits")
        trial.answered(id)


def test_one_motion_after_another(trial: RobotTrial) -> None:
    """Of two motions of the same joints the second one does not end before the first one."""
    joint = _head(trial) or next(iter(trial.project.body.joints))
    limit = trial.project.body.joints[joint]
    middle, far = (limit.minimum + limit.maximum) / 2, (limit.minimum + 3 * limit.maximum) / 4
    nod = MotionDefinition("nod", 2.0, {joint: (Keyframe(1.0, far), Keyframe(2.0, middle))})
    _wake(trial)
    trial.start("a", Perform(nod))
    trial.start("b", Perform(nod))
    trial.answered("a", "b")
    ends = [event.name.rpartition(".")[2] for event in trial.events if event.name[-2:] in (".a", ".b")]
    if ends != ["a", "b"]:
        trial.fail("ended the second of two motions of the same joint before the first one")


def test_a_move_continues_until_it_is_ended(trial: RobotTrial) -> None:
    """A move of a body with legs or wheels has no end of its own: another move or a stop ends it."""
    if not trial.project.body.roles.base.row.moves:
        return
    _wake(trial)
    trial.start("a", Move(0.02))
    trial.live(1.0)
    if trial.answers("a") == ["error"]:
        return  # a robot that can't walk answers so
    trial.start("stop", Stop("walk"))
    trial.answered("a", "stop", seconds=3.0)


def test_a_recording_takes_its_time(trial: RobotTrial) -> None:
    """A recording that is done took as long as demanded, and the robot speaks meanwhile."""
    began = trial.now
    trial.start("ears", Record("r1", 1.0))
    trial.start("say", Say("Hello"))
    end, _ = trial.answered("ears", "say")
    at = next(event.at for event in trial.events if event.name.endswith(".command.ears"))
    if end == "done" and at - began < 0.7:
        trial.fail(f"ended a recording of 1 s after {at - began:.1f} s")


def test_its_volume_is_set_while_it_speaks(trial: RobotTrial) -> None:
    """A volume neither waits for speech nor ends it; one above 1 is refused."""
    trial.start("say", Say("A text that takes a while, because it has many words."))
    trial.live(0.2)
    trial.start("volume", Volume(0.4))
    trial.start("loud", Volume(1.5))
    _, loud = trial.answered("volume", "loud", seconds=1.5)
    if loud != "error":
        trial.fail(f"answered `{loud}` to a volume of 1.5: a volume is at most 1")
    if trial.answered("say") == ["cancelled"]:
        trial.fail("ended its speech because of a volume")


def test_lights_leave_the_body_alone(trial: RobotTrial) -> None:
    """Slow lights and a look do not wait for each other; a light or colour that does not exist is refused."""
    groups = [*trial.project.body.roles.lights]
    _wake(trial)
    if groups:
        trial.start("lights", Leds({groups[0]: "green"}, 8.0))
    trial.start("look", Look(0.2, 0.1))
    trial.start("no colour", Leds({groups[0] if groups else "eyes": "bleu"}))
    trial.start("no light", Leds({"elbow": "blue"}))
    ends = trial.answered("look", "no colour", "no light", seconds=6.0)
    for id, end in zip(("no colour", "no light"), ends[1:], strict=True):
        if end != "error":
            trial.fail(f"answered `{end}` to lights with {id} of that name: that is an `error`")
    if groups:
        trial.cancel("lights")
        trial.answered("lights", seconds=2.0)


def test_a_charger_is_felt(trial: RobotTrial) -> None:
    """A hall with a charger (`HasCharger`) shows in the reading of the battery whether it is plugged in."""
    if not isinstance(trial.own, HasCharger):
        return
    for plugged in (True, False):
        trial.own.plug(plugged)
        battery = trial.read(Sense.BATTERY)
        if isinstance(battery, Battery) and battery.plugged is not plugged:
            trial.fail(f"returned a battery that is {'not ' if plugged else ''}plugged in after `plug({plugged})`")


def test_a_touch_is_noticed_once(trial: RobotTrial) -> None:
    """A hall whose visitors can touch the robot (`FeelsTouch`) raises `touched` once, and `released` once."""
    if not isinstance(trial.own, FeelsTouch) or not trial.project.body.tactile:
        return
    sensor = trial.project.body.tactile[0]
    for pressed in (True, True, False, False):
        trial.own.touch(sensor, pressed)
    trial.live(0.2)
    noticed = [event.name for event in trial.events if event.name in ("touched", "released")]
    if noticed != ["touched", "released"]:
        trial.fail(f"noticed {', '.join(noticed) or 'nothing'} of one touch of `{sensor}`: `touched`, then `released`")


def test_a_visitor_is_seen_until_they_leave(trial: RobotTrial) -> None:
    """A hall (`Hall`) has the face of a visitor in front of the robot, and none before and after."""
    if not isinstance(trial.own, Hall):
        return
    trial.live(0.1)
    if trial.own.face() is not None:
        trial.fail("has a face in its picture without a visitor")
    trial.own.place(Visitor(2.0, 0.0, 1.65))
    trial.live(0.2)
    if trial.own.face() is None:
        trial.fail("has no face in its picture with a visitor 2 m in front of it")
    trial.own.place(None)
    trial.live(0.2)
    if trial.own.face() is not None:
        trial.fail("has a face in its picture after the visitor left")


def test_what_began_is_told_once(trial: RobotTrial) -> None:
    """`begun` returns the id of a command once, and only of commands that were started."""
    trial.start("a", Say("Hello"))
    told: list[str] = []

    def over() -> bool:
        told.extend(trial.begun())
        return bool(trial.answers("a"))

    trial.until(over)
    told += trial.begun()
    if unknown := [id for id in told if id != "a"]:
        trial.fail(f"returned `{unknown[0]}` from `begun`, which was not started")
    if len(told) > 1:
        trial.fail(f"returned the same command {len(told)} times from `begun`")


def test_senses_are_readings_of_its_body(trial: RobotTrial) -> None:
    """`read` returns the reading of a sense in SI units, or None if the robot does not have it."""
    trial.live(0.2)
    body = trial.project.body
    for sense in Sense:
        trial.read(sense)  # fails for another type
    joints = trial.read(Sense.JOINT)
    if isinstance(joints, Joints):
        if strange := [name for name in joints.names if name not in body.joints]:
            trial.fail(f"returned the joint `{strange[0]}`, which the body `{body.name}` does not have")
        if not len(joints.names) == len(joints.angles) == len(joints.stiffness):
            trial.fail("returned joints with lists of different lengths")
        for name, angle in zip(joints.names, joints.angles, strict=True):
            limit = body.joints[name]
            if not limit.minimum - 0.1 <= angle <= limit.maximum + 0.1:
                trial.fail(f"returned {angle:.2f} rad for `{name}`, which is beyond its limits: angles are in radians")
    battery = trial.read(Sense.BATTERY)
    if isinstance(battery, Battery) and not 0 <= battery.percentage <= 100:
        trial.fail(f"returned a battery of {battery.percentage} %")


def test_it_can_be_closed_twice(trial: RobotTrial) -> None:
    """`close` is harmless when repeated."""
    trial.close()
    trial.close()


def _head(trial: RobotTrial) -> str:
    """Return a joint that turns the head; empty for a body without one."""
    roles = trial.project.body.roles
    role = roles.joint(HEAD_YAW) or roles.joint(HEAD_PITCH)
    return role.joint if role else ""


def _wake(trial: RobotTrial) -> None:
    """Wake the robot, as an exhibition does before it moves it."""
    trial.start("first", Wake())
    trial.answered("first")
