"""Robot, brain, motion and visitor apart, on a real broker: the same actions as in one process."""

from itertools import count
from typing import Any

import pytest

from lumen.errors import UsageError
from lumen.language.commands import Posture, Rest, Say
from lumen.language.motions import MotionDefinition
from lumen.ports import Perform
from lumen.project.home import home_of
from lumen.run import node
from lumen.run.asking import OPERATOR_ANSWERS, operator_key
from lumen.run.parts.hosted_robot import HostedRobotPart
from lumen.run.snapshot_store import SNAPSHOT_FILE
from tests.processes.troupe import Troupe, alone, deeds
from tests.relay import Relay
from tests.waiting import HANG, UNLIMITED, Collector


@pytest.mark.once
@pytest.mark.usefixtures("patient")
def test_four_parts_do_what_one_process_does(troupe: Troupe) -> None:
    photo = troupe.folder / "motions" / "photo.yaml"
    cues = "{at: 1.4s, pose: pose, say: {en: Cheese, id: Senyum}, sound: sounds/shutter.wav}"
    photo.write_text(photo.read_text("utf-8").replace("{at: 1.4s, pose: pose}", cues), "utf-8")
    (photo.parent.parent / "sounds").mkdir()
    (photo.parent.parent / "sounds" / "shutter.wav").write_bytes(b"RIFF")
    expected = alone(troupe.folder, "short")
    noticed = Collector()
    troupe.ear.subscribe("avatar.NAO.event.noticed", noticed)
    troupe.speed = "2"
    robot = troupe.join("robot")
    troupe.join("motion")
    brain, visitor = troupe.join("brain", story="short"), troupe.join("visitor", story="short")
    troupe.until(lambda: visitor.process.over)
    assert not visitor.process.failed
    troupe.until(lambda: len(deeds(troupe.trace.bodies)) >= len(expected))
    assert deeds(troupe.trace.bodies) == expected
    project = brain.brain.project if brain.brain else None
    assert project
    played = [command.motion for _, command in robot.body.performed if isinstance(command, Perform)]
    assert [motion.name for motion in played] == ["photo", "goodbye"]
    assert [c.text for _, c in robot.body.performed if isinstance(c, Say)].count("Cheese") == 1
    told = [body["data"]["kind"] for body in noticed.bodies if body["name"] == "cue"]
    assert sorted(told) == ["say", "sound"]
    assert any(deed.get("text") == "Cheese" for deed in expected if isinstance(deed, dict)), expected
    assert [m.tracks for m in played] == [project.motions[m.name].tracks for m in played]
    assert [cues_of(m) for m in played] == [cues_of(project.motions[m.name]) for m in played]


@pytest.mark.usefixtures("patient")
def test_now_is_told_by_a_brain_whose_robot_is_elsewhere(troupe: Troupe) -> None:
    tour, welcome = troupe.folder / "behaviors" / "tour.yaml", "Welcome to Electrical Engineering Days."
    text = tour.read_text("utf-8")
    assert welcome in text
    tour.write_text(text.replace(welcome, " ".join([welcome] * 6)), "utf-8")  # a slow machine hears it too
    _, brain = troupe.play()
    answers = Collector()
    troupe.ear.subscribe(OPERATOR_ANSWERS, answers)

    def now() -> dict[str, Any]:
        answers.messages.clear()
        troupe.ear.publish(operator_key("NAO"), {"ask": "now"}, reply_to=OPERATOR_ANSWERS)
        troupe.until(lambda: answers.messages)
        return dict(answers.bodies[0])

    face = {"x": 160, "y": 120}
    troupe.insist(lambda: troupe.ear.publish("lumen.NAO.visual.face.detection", face), lambda: "greet" in brain.states)
    assert brain.brain
    told: dict[str, Any] = {}
    troupe.until(lambda: told.update(now()) or told["configuration"] == sorted(brain.states))
    assert told["saying"]["text"]
    assert told["stopped"] is False
    assert {"greet", "talking"} <= {way["source"] for way in told["ways"]}
    text = " ".join(["We close soon."] * 30)  # a slow machine sees it too
    say = {"type": "texttospeech", "method": "say", "parameter": {"text": text}, "id": "theirs"}
    troupe.until(lambda: now()["saying"] is None)
    troupe.ear.publish("avatar.NAO.command", say, ttl=HANG)
    troupe.until(lambda: (now()["saying"] or {}).get("text") == text)
    event = {"ask": "event", "event": "safety.alarm", "by": "Aisyah"}
    answers.messages.clear()
    troupe.ear.publish(operator_key("NAO"), event, reply_to=OPERATOR_ANSWERS)
    troupe.until(lambda: answers.messages)
    assert answers.bodies[0] == {"verdict": "done", "taken": True}


def cues_of(motion: MotionDefinition) -> list[tuple[float, str, object]]:
    return [(cue.time, cue.kind, cue.value) for cue in motion.cues]


@pytest.mark.soak
@pytest.mark.usefixtures("patient")
def test_without_a_motion_module_the_brain_does_it_itself_and_hands_it_over(troupe: Troupe) -> None:
    robot, brain = troupe.join("robot"), troupe.join("brain", story="short")
    visitor = troupe.join("visitor", story="short")
    troupe.until(lambda: "ask_name" in brain.states)
    assert brain.brain
    assert brain.brain.robot.time() is not None
    motion = troupe.join("motion")
    troupe.until(lambda: "photo" in brain.states)
    motion.close()
    troupe.members.remove(motion)
    troupe.until(lambda: visitor.process.over)
    assert not visitor.process.failed
    assert sum(isinstance(command, Perform) for _, command in robot.body.performed) == 2


@pytest.mark.usefixtures("patient")
def test_a_brain_for_one_robot_moves_no_other(troupe: Troupe) -> None:
    one, other = troupe.join("robot"), troupe.join("robot", robot="KURNIA")
    brain = troupe.join("brain")
    troupe.until(lambda: "idle" in brain.states and one.body.performed)
    troupe.rounds(20)
    assert other.body.performed == []
    assert {body["robot"] for body in troupe.trace.bodies} == {"NAO"}


@pytest.mark.parametrize("part", ["brain", pytest.param("robot", marks=pytest.mark.soak)])
def test_a_second_one_of_the_same_kind_is_refused(troupe: Troupe, part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    robot, brain = troupe.join("robot"), troupe.join("brain")
    troupe.until(lambda: "idle" in brain.states)
    monkeypatch.setattr(node, "CLAIM_DURATION", UNLIMITED)  # the first may announce itself late
    troupe.join(part)
    with pytest.raises(UsageError, match=f"is already the {part} of NAO on this bus: end it first"):
        troupe.until(lambda: False)
    assert robot.process.over is False


def test_a_robot_that_is_lost_is_answered_and_comes_back(troupe: Troupe) -> None:
    robot, brain = troupe.play()
    troupe.kill(robot)
    troupe.until(lambda: "robot_lost" in brain.states)
    assert "paused" in brain.states
    again = troupe.join("robot")
    troupe.until(lambda: "idle" in brain.states)
    assert any(isinstance(command, Posture) for _, command in again.body.performed)


@pytest.mark.soak
def test_a_robot_whose_brain_is_gone_rests_after_5_seconds_and_tells_the_next_one(troupe: Troupe) -> None:
    robot, brain = troupe.play()
    troupe.kill(brain)
    troupe.until(lambda: any(isinstance(command, Rest) for _, command in robot.body.performed))
    again = troupe.join("brain")
    troupe.until(lambda: "brain_lost" in again.states)
    troupe.until(lambda: "idle" in again.states)


@pytest.mark.soak
def test_a_network_that_is_cut_for_10_seconds_ends_safely_and_goes_on(troupe: Troupe) -> None:
    port = int(troupe.url.rpartition(":")[2].partition("/")[0])
    cable = Relay(port)
    robot, motion = troupe.join("robot"), troupe.join("motion")
    brain = troupe.join("brain", story="dancing", url=troupe.url.replace(str(port), str(cable.port)))
    visitor = troupe.join("visitor", story="dancing")
    troupe.until(lambda: "dance" in brain.states and robot.body.performed)
    troupe.until(lambda: any(isinstance(command, Perform) for _, command in robot.body.performed))
    cable.cut()
    troupe.live(10.0)
    troupe.until(lambda: "robot_lost" in brain.states and isinstance(robot.body.performed[-1][1], Rest))
    dances = sum(isinstance(command, Perform) for _, command in robot.body.performed)
    cable.mend()
    troupe.until(lambda: {"offer", "watching"} <= brain.states)
    assert sum(isinstance(command, Perform) for _, command in robot.body.performed) == dances == 1
    troupe.until(lambda: visitor.process.over)
    assert not visitor.process.failed
    assert motion in troupe.members
    for member in troupe.members:
        member.close()
    troupe.members.clear()
    cable.close()


@pytest.mark.usefixtures("patient")
def test_a_robot_that_a_person_stopped_wakes_for_a_hand_on_its_head_and_for_resume(troupe: Troupe) -> None:
    robot, brain = troupe.play()
    reports = Collector()
    troupe.ear.subscribe("avatar.NAO.event.command", reports)

    def send_request(method: str, **parameter: object) -> None:
        troupe.ear.publish("avatar.NAO.stop", {"type": "motion", "method": method, "parameter": parameter}, ttl=2.0)

    def hand(*, pressed: bool) -> None:
        troupe.ear.publish("avatar.NAO.hall", {"sensor": "FrontTactil", "pressed": pressed}, ttl=2.0)

    troupe.insist(lambda: send_request("rest", by="Ada"), lambda: "stopped" in brain.states)
    number = count()

    def wake() -> None:
        body = {"type": "motion", "method": "wakeUp", "id": f"theirs {next(number)}"}
        troupe.ear.publish("avatar.NAO.command", body, ttl=2.0)

    def refused() -> bool:
        """Return whether a report to the other sender of the command names Ada."""
        return any(report["id"].startswith("theirs") and "Ada" in report.get("reason", "") for report in reports.bodies)

    troupe.insist(wake, refused)
    troupe.insist(lambda: hand(pressed=True), lambda: "watching" in brain.states)
    hand(pressed=False)
    (part,) = [part for part in robot.process.parts if isinstance(part, HostedRobotPart)]
    assert part.server.hold.stopped is None
    troupe.insist(lambda: send_request("rest", by="Ada"), lambda: "stopped" in brain.states)
    troupe.insist(lambda: send_request("resume", by="Bo"), lambda: "watching" in brain.states)


def test_a_new_brain_of_a_robot_that_a_person_stopped_prints_no_command_as_performed(
    troupe: Troupe, capsys: pytest.CaptureFixture[str]
) -> None:
    _, brain = troupe.play()
    body: dict[str, Any] = {"type": "motion", "method": "rest", "parameter": {"by": "Ada"}}
    troupe.insist(lambda: troupe.ear.publish("avatar.NAO.stop", body, ttl=2.0), lambda: "stopped" in brain.states)
    troupe.kill(brain)
    (home_of(troupe.folder) / SNAPSHOT_FILE).unlink()
    capsys.readouterr()
    brain = troupe.join("brain")
    troupe.until(lambda: "stopped" in brain.states)
    told = capsys.readouterr().out
    assert "refused  wake: Ada stopped the robot: " in told
    assert "robot    wakes" not in told


@pytest.mark.usefixtures("patient")
def test_files_that_the_brain_puts_in_force_are_in_force_everywhere(troupe: Troupe) -> None:
    robot, brain = troupe.play()
    motion = troupe.join("motion")
    before = brain.brain.project.hash if brain.brain else ""
    troupe.until(lambda: brain.brain and brain.brain.motion_module())
    file = troupe.folder / "motions" / "photo.yaml"
    file.write_text(file.read_text("utf-8").replace("description: ", "description: Again, "), "utf-8")
    tour = troupe.folder / "behaviors" / "tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace("Welcome to", "Hello at"), "utf-8")
    troupe.ear.publish("lumen.config.command", {"command": "reload"})

    def bundles() -> set[object]:
        peers = [member.process.presence.find(part) for member, part in ((brain, "motion"), (brain, "robot"))]
        return {peer.said["bundle"] for peer in peers if peer}

    troupe.until(lambda: brain.brain and bundles() == {brain.brain.project.hash} and before not in bundles())
    assert brain.brain
    assert brain.brain.motion_module()
    assert {robot, motion} < set(troupe.members)


@pytest.mark.usefixtures("patient")
def test_nonsense_on_every_key_ends_nobody(troupe: Troupe, caplog: pytest.LogCaptureFixture) -> None:
    _, brain = troupe.play()
    troupe.join("motion")
    troupe.join("visitor", story="dancing")
    keys = [route.key_for("NAO") for route in brain.brain.project.routes.values()] if brain.brain else []
    for key in [*keys, "lumen.config.command", "lumen.config.status"]:
        for body in (None, 7, [], {}, {"id": 5, "play": []}, {"parts": [{}], "speed": "fast"}, {"verdict": "applied"}):
            troupe.ear.publish(key, body)
    troupe.ear.publish("lumen.config.status", {"verdict": "applied", "after": "files of somebody else"})
    troupe.until(lambda: "dance" in brain.states)
    assert "failed on" not in caplog.text
