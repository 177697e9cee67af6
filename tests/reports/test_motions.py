"""Walks and motions from public bug reports: the robot stays on the ground, and within its limits and speeds."""

import gc
from dataclasses import replace
from math import degrees, radians
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.language.commands import Look, Wake
from lumen.language.events import Event
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.lint import check_files
from lumen.motion import bounds
from lumen.motion.bounds import within_limits
from lumen.motion.limits import beyond_limits, overspeed
from lumen.ports import Aim, Perform, RobotCommand, Sense
from lumen.project.packaged import shipped_root
from lumen.statechart import VirtualClock
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "motions"
BODY = lumen.load(shipped_root()).body


PODIUM = (
    '<mujoco><worldbody><site name="stage"/><geom type="box" size="{size} 0.01" pos="0 0 -.01"/></worldbody></mujoco>'
)
"""A hall; with the size `.55 .75`, its ground ends 0.55 m ahead and 0.75 m to the side."""


def strays(behavior: str, settings: str = "", size: str = "") -> list[str]:
    """Return place and message of each walk off the ground that lint finds for NAO, in the shipped hall or another."""
    main = "name: Edge\nbehavior: tour\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n"
    files = {"lumen.yaml": f"{main}{settings or 'hall: hall.xml'}\n", "behaviors/tour.yaml": behavior}
    if size:
        box = f'<geom type="box" size="{size} 0.01" pos="0 0 -.01"/>'
        files["models/hall.xml"] = f'<mujoco><worldbody><site name="stage"/>{box}</worldbody></mujoco>'
    found = check_files(Path("edge"), {name: text.encode() for name, text in files.items()})[1]
    return [f"{d.place}: {d.message}" for d in found if d.code == "walk-beyond-ground"]


def test_a_walk_over_the_edge_is_found_without_a_stage() -> None:
    text = (INPUTS / "walk-over-the-edge.yaml").read_text("utf-8")
    where = "behaviors/tour.yaml:5:29: this walk leads off the ground, to x 0.56 m, y 0.00 m from the start"
    assert strays(text) == [where]
    assert strays(text.replace("x: 0.8", "x: 0.5")) == []
    assert strays(text, "hall: hall.xml\nstage: {x: [-0.4, 0.4], y: [-0.6, 0.6]}") == [], "a stage keeps the feet on it"
    assert strays(text, "units: {length: m}") == [], "without a hall the ground is unknown"
    assert strays(text, size="1 1") == [], "this hall's ground is larger"
    assert strays(text.replace("x: 0.8", "x: 1.2"), size="1 1") == [where.replace("0.56", "1.02")]


def doing(*steps: str) -> str:
    """Return a behaviour with one state for each step."""
    states = "".join(f"  s{i}: {{do: {step}, onDone: s{i + 1}, onError: end}}\n" for i, step in enumerate(steps))
    ends = f"  s{len(steps)}: {{}}\n  end: {{}}\non: {{fallen: .end}}\n"
    return f"units: {{angle: deg}}\ninitial: s0\nstates:\n{states}{ends}"


FORTH, BACK, TURN, ASIDE = "{walk: {x: 0.3}}", "{walk: {x: -0.3}}", "{walk: {theta: 90}}", "{walk: {x: 0.3, y: -0.1}}"
IF = "{if: 'event.name == null', then: {walk: {x: 0.4}}, else: {walk: {x: 0.1}}}"
ENTRY = "initial: a\nstates:\n  a: {entry: {walk: {x: 0.6}}, after: {9s: b}}\n  b: {do: {walk: {x: 0.6}}}\n"
ACTIONS = "initial: a\nstates:\n  a: {on: {touched: {target: b, actions: {walk: {x: 0.6}}}}}\n  b: {}\n"


@for_each(
    ("behavior", "lines"),
    [
        (doing(FORTH, FORTH), ["5 0.56 0.00"]),
        (doing(f"[{FORTH}, {FORTH}]"), ["4 0.56 0.00"]),
        (doing(FORTH, BACK, FORTH), []),
        (doing(TURN, FORTH, FORTH, FORTH), ["7 0.00 0.76"]),
        (doing(TURN, TURN, FORTH, BACK, BACK, BACK), ["9 0.56 0.00"]),
        (doing(TURN, ASIDE, ASIDE), []),
        (doing(TURN, ASIDE, ASIDE, TURN, FORTH, FORTH, FORTH), ["10 -0.56 0.60"]),
        (doing("{parallel: [{wait: 1s}, {walk: {x: 0.6}}]}"), ["4 0.56 0.00"]),
        (doing(FORTH, IF, FORTH), ["5 0.56 0.00"]),
        (doing(FORTH, "{walk: {vx: 0.1}}", FORTH), []),
        (doing(FORTH).replace("  s1: {}", "  s1: {after: {1s: s0}}"), []),
        (doing(FORTH, "{say: Hello}", FORTH).replace("onDone: s1,", "onDone: s1, after: {1s: s1},"), ["6 0.56 0.00"]),
        (doing(FORTH, FORTH).replace("onDone: s1", "on: {touched: s1}"), []),
        (ENTRY, ["3 0.56 0.00"]),
        (ACTIONS, ["3 0.56 0.00"]),
        ("type: parallel\nstates:\n  a: {do: {walk: {x: 0.4}}}\n  b: {do: {walk: {x: 0.6}}}\n", []),
        ("type: parallel\nstates:\n  a: {do: {say: Hello}}\n  b: {do: {walk: {x: 0.6}}}\n", ["4 0.56 0.00"]),
    ],
)
def test_walks_add_up_on_each_way(behavior: str, lines: list[str]) -> None:
    found = [message.replace(",", "").split() for message in strays(behavior)]
    assert [f"{words[0].split(':')[1]} {words[9]} {words[12]}" for words in found] == lines


def test_a_place_without_ground_is_found_without_a_stage() -> None:
    places = "hall: hall.xml\nplaces: {near: {x: 0.5, y: 0, heading: 180}, far: {x: 0.8, y: 0}}"
    behavior = doing("{walk: {to: near}}", "{walk: {x: -0.1}}", "{walk: {to: far}}")
    assert strays(behavior, places) == [
        "behaviors/tour.yaml:5:13: this walk leads off the ground, to x 0.56 m, y 0.00 m from the start",
        "lumen.yaml:6:46: there is no ground at `far` in hall.xml: the robot would fall",
    ]


class OwnRobot:
    """A user's own robot without checks: it records each command and finishes it at once."""

    def __init__(self) -> None:
        self.given: list[RobotCommand] = []
        self.answers: list[Event] = []

    def start(self, id: str, command: RobotCommand) -> None:
        self.given.append(command)
        self.answers.append(Event(f"done.command.{id}", None, 0.0))

    def cancel(self, id: str) -> None:
        pass

    def poll(self) -> list[Event]:
        answers, self.answers = self.answers, []
        return answers

    def begun(self) -> list[str]:
        return []

    def read(self, sense: Sense) -> None:
        pass

    def close(self) -> None:
        pass


def limited(name: str) -> tuple[float, float]:
    return BODY.joints[name].minimum, BODY.joints[name].maximum


def test_a_users_own_robot_never_looks_beyond_its_limits(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "lumen.yaml").write_text("name: Own\nbehavior: tour\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n")
    (tmp_path / "behaviors/tour.yaml").write_text(
        "units: {angle: deg}\ninitial: a\nstates:\n"
        "  a: {do: [{look: {yaw: 121, pitch: 60}}, {look: {yaw: 30, pitch: 10}}, {look: {yaw: 121, pitch: 60}}]}\n"
    )
    robot = OwnRobot()
    with lumen.open(tmp_path, robot=robot, clock=VirtualClock()) as exhibition:
        exhibition.run(seconds=2)
    first, middle, last = [command for command in robot.given if isinstance(command, Look)]
    assert first.yaw == limited("HeadYaw")[1]
    assert limited("HeadPitch")[0] <= first.pitch < radians(30), "where the head is turned, it can't nod as far"
    assert middle == Look(radians(30), radians(10))
    assert last == first
    assert [r.message for r in caplog.records if "look" in r.message] == [
        "`look` turns `HeadYaw` to 119.5 deg, not to 121.0 deg, which is beyond its limit",
        f"`look` turns `HeadPitch` to {degrees(first.pitch):.1f} deg, not to 60.0 deg, which is beyond its limit",
    ]


def key(at: float, angle: float, **handles: Any) -> Keyframe:
    return Keyframe(at, angle, Interpolation.BEZIER if handles else Interpolation.MINIMUM_JERK, **handles)


@for_each(
    "tracks",
    [
        {"HeadYaw": (key(1.0, 2.2), key(2.0, 0.0))},
        {"HeadYaw": (key(1.0, 0.0), key(1.01, 1.0), key(2.0, 0.0)), "HeadPitch": (key(1.01, 0.1), key(2.0, 0.2))},
        {"HeadYaw": (key(1.0, 2.0, handle_out=(0.3, 2.0)), key(2.0, 2.0, handle_in=(-0.3, 2.0)))},
        {"HeadYaw": (key(1.0, 2.0),), "HeadPitch": (key(1.5, 0.5),)},
        {"LHand": (key(1.0, 1.4), key(2.0, -3.0))},
    ],
)
def test_a_motion_is_brought_within_the_limits_and_speeds(tracks: dict[str, tuple[Keyframe, ...]]) -> None:
    motion = MotionDefinition("nod", 2.5, tracks, (Cue(1.01, "say", "now"),))
    assert beyond_limits(motion, BODY) or overspeed(motion, BODY)
    command, changes = within_limits(Perform(motion), BODY)
    assert isinstance(command, Perform)
    assert not beyond_limits(command.motion, BODY)
    assert not overspeed(command.motion, BODY)
    assert changes
    keys = command.motion.tracks
    assert [len(keys[joint]) >= len(tracks[joint]) for joint in tracks] == [True] * len(tracks)
    assert command.motion.duration >= motion.duration
    assert all(each[-1].time <= command.motion.duration for each in keys.values())


def test_a_slowed_motion_stays_in_step_with_its_words() -> None:
    tracks = {"HeadYaw": (key(1.0, 0.0), key(1.01, 1.0), key(2.0, 0.0)), "HeadPitch": (key(1.01, 0.1), key(2.0, 0.2))}
    command, changes = within_limits(Perform(MotionDefinition("nod", 2.5, tracks, (Cue(1.01, "say", "now"),))), BODY)
    assert isinstance(command, Perform)
    yaw, pitch, cue = command.motion.tracks["HeadYaw"], command.motion.tracks["HeadPitch"], command.motion.cues[0]
    assert yaw[0].time == 1.0
    assert yaw[1].time == pitch[0].time == cue.time > 1.1
    assert yaw[2].time - yaw[1].time == pytest.approx(0.99)
    assert command.motion.duration - yaw[2].time == pytest.approx(0.5)
    assert changes == ("`nod` takes longer: `HeadYaw` needs more time to reach its key at 1.01 s",)


def test_a_command_within_the_limits_is_unchanged() -> None:
    tracks = {"HeadYaw": (key(1.0, 1.0), key(2.0, 0.0))}
    for command in (Look(0.3, 0.1), Perform(MotionDefinition("nod", 2.5, tracks)), Aim({"HeadYaw": 1.0}, 0.5), Wake()):
        assert within_limits(command, BODY) == (command, ())
        assert within_limits(command, BODY).command is command
    assert within_limits(Aim({"HeadYaw": 9.0, "nose": 9.0}, 3.0), BODY).command == Aim(
        {"HeadYaw": limited("HeadYaw")[1], "nose": 9.0}, 1.0
    )


def test_a_motion_is_analysed_once_for_each_body(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[tuple[str, Body]] = []
    analysed = bounds._analysed

    def counted(motion: MotionDefinition, body: Body) -> tuple[MotionDefinition, tuple[str, ...], bool]:
        calls.append((motion.name, body))
        return analysed(motion, body)

    monkeypatch.setattr(bounds, "_analysed", counted)
    near = MotionDefinition("near", 2.5, {"HeadYaw": (key(1.0, 1.0), key(2.0, 0.0))})
    far = MotionDefinition("far", 2.5, {"HeadYaw": (key(1.0, 9.0), key(2.0, 0.0))})
    bounds.analyse([near, far], BODY)
    assert [name for name, _ in calls] == ["near", "far"]
    first, second = (within_limits(Perform(far), BODY) for _ in range(2))
    assert first == second
    assert first.changes
    assert within_limits(Perform(near), BODY) == (Perform(near), ())
    assert len(calls) == 2
    within_limits(Perform(replace(far)), BODY)
    other = replace(BODY, name="another")
    assert within_limits(Perform(far), other) == first
    assert calls[2:] == [("far", BODY), ("far", other)]
    number = len(bounds._analyses)
    del near, far, first, second
    gc.collect()
    assert len(bounds._analyses) <= number - 2, "an analysis ends with its motion"
