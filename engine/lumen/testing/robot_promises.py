"""The promises of every robot (`lumen.ports.Robot`); `pytest --lumen-robot` runs them with a robot of your own."""

from math import nan

from lumen.language.commands import Look, Posture, Rest, Say, Stop, Volume, Wake
from lumen.ports import Aim, Battery, Joints, Perform, Sense
from lumen.testing.trial import RobotTrial

ENDS = ("done", "error", "cancelled")


def test_a_command_is_answered_once(trial: RobotTrial) -> None:
    """`poll` returns one end of each command, whatever becomes of it."""
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
    """A posture that no body has is an error that names it, and no exception."""
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
    """A rest is done, and what ran before it is answered."""
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
    """`read` returns the reading of a sense in SI units, or None without that sense."""
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
