"""Skills in a whole exhibition: performed by a custom robot, reloaded, and refused while a person holds the robot."""

from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest

import lumen
from lumen.features.skills.part import SkillsPart
from lumen.features.skills.workshop import taker_of
from lumen.language.commands import Do
from lumen.language.events import Event
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.robot.skill_runner import SkillRunner
from lumen.run.compose import compose, start
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace
from lumen.run.setup import set_up, set_up_with
from tests.features.skills.changing import BEHAVIOR, CODE, MANIFEST, STORY, project_in
from tests.seams.test_joints import Obedient
from tests.waiting import threads, until

pytestmark = pytest.mark.process

SHORT = {BEHAVIOR: ("duration: 3s", "duration: 50ms")}


def live(exhibition: Exhibition, condition: Callable[[], object]) -> None:
    """Let an exhibition live until a condition holds."""

    def holds() -> object:
        exhibition.tick()
        return condition()

    until(holds, shown=lambda: (exhibition.configuration, exhibition.context))


def meet(exhibition: Exhibition) -> None:
    exhibition.loop.happen(Event("face", {}, exhibition.now))


def test_a_robot_of_ones_own_performs_a_skill_and_the_behaviour_gets_its_result(tmp_path: Path) -> None:
    root = project_in(tmp_path, SHORT)
    with lumen.open(root, robot=Obedient()) as exhibition:
        meet(exhibition)
        live(exhibition, lambda: "sprayed" in exhibition.configuration)
        assert exhibition.context == {"litres": 0.2}
    until(lambda: not threads("lumen-program-"))


def test_an_exhibition_performs_its_skills_after_a_second_one_of_the_project_has_ended(tmp_path: Path) -> None:
    root = project_in(tmp_path, {**SHORT, CODE: ("0.2", "0.7")})
    with lumen.open(root, robot=Obedient()) as exhibition:
        with lumen.open(root, robot=Obedient()):
            pass
        meet(exhibition)
        live(exhibition, lambda: "sprayed" in exhibition.configuration)
        assert exhibition.context == {"litres": 0.7}


def test_of_two_exhibitions_of_a_project_each_performs_its_own_calls(tmp_path: Path) -> None:
    root = project_in(tmp_path, SHORT)
    story = root / STORY
    story.write_text("steps: [{visitor: arrives}, {expect: {state: sprayed, context: {litres: 0.1}}}]\n", "utf-8")
    with lumen.open(root, robot=Obedient()) as first, lumen.open(root, robot=Obedient()) as second:
        for one in (first, second):
            workshop = one.services[SkillsPart].workshop
            assert taker_of("spray", one.project.verbs["spray"]) is workshop
            assert one.reload().verdict == "unchanged"
        edit(root, MANIFEST, "default: left", "default: right")
        before = first.project.verbs["spray"]
        assert first.reload().verdict == "applied"
        assert taker_of("spray", first.project.verbs["spray"]) is first.services[SkillsPart].workshop
        assert taker_of("spray", before) is second.services[SkillsPart].workshop
        with lumen.open(root, robot="simulation", story="visitor") as pretending:
            assert taker_of("spray", pretending.project.verbs["spray"]) is pretending.project


def test_a_failing_skill_is_an_error_of_the_do_and_the_exhibition_lives_on(tmp_path: Path) -> None:
    root = project_in(tmp_path, {**SHORT, CODE: ("    print", "    1 / 0\n    print")})
    seen: list[Event] = []
    with lumen.open(root, robot=Obedient()) as exhibition:
        exhibition.observe(lambda step: seen.append(step.event) if step.event else None)
        meet(exhibition)
        live(exhibition, lambda: "error.execution" in [event.name for event in seen])
        live(exhibition, lambda: "waiting" in exhibition.configuration)
        reason = "`spray` failed: spray.py:6: ZeroDivisionError: division by zero"
        (failed,) = [event for event in seen if event.name == "error.execution"]
        assert failed.data == {"skill": "spray", "reason": reason}
        assert [event.data for event in seen if event.name.startswith("error.command")] == [{"reason": reason}]


def test_a_left_state_ends_its_skill(tmp_path: Path) -> None:
    root = project_in(tmp_path, {BEHAVIOR: ("onError: waiting", "onError: waiting\n    on: {touched: waiting}")})
    with lumen.open(root, robot=Obedient()) as exhibition:
        meet(exhibition)
        live(exhibition, lambda: threads("lumen-program-spray"))
        exhibition.loop.happen(Event("touched", {}, exhibition.now))
        live(exhibition, lambda: not threads("lumen-skill-spray"))
        assert "waiting" in exhibition.configuration


def test_a_project_of_a_bundle_has_manifests_and_no_code(tmp_path: Path) -> None:
    files = read_files(project_in(tmp_path))
    assert MANIFEST in files
    assert CODE not in files
    (tmp_path / "house").mkdir()
    project, found = check_files(tmp_path / "house", files)
    assert project is not None
    assert [each.code for each in found] == ["skill-program"]


def edit(root: Path, file: str, old: str, new: str) -> None:
    text = (root / file).read_text("utf-8")
    assert old in text
    (root / file).write_text(text.replace(old, new), "utf-8")


def test_a_changed_manifest_is_used_after_a_reload_and_the_program_of_a_removed_skill_ends(tmp_path: Path) -> None:
    story = ("did: {spray: 3s}, context: {litres: 0.1}", "within: 5s")
    root = project_in(tmp_path, {BEHAVIOR: ("{duration: 3s, nozzle: left}", "50ms"), STORY: story})
    with lumen.open(root, robot=Obedient()) as exhibition:
        meet(exhibition)
        live(exhibition, lambda: "sprayed" in exhibition.configuration)
        edit(root, MANIFEST, "default: left", "default: right")
        report = exhibition.reload()
        assert (report.verdict, report.changes[-1].sentence) == ("applied", "skill `spray` changed")
        assert exhibition.project.verbs["spray"].arguments["properties"]["nozzle"]["default"] == "right"
        assert len(threads("lumen-program-spray")) == 1
        edit(root, BEHAVIOR, "do: {spray: 50ms}", "do: {wait: 1s}")
        edit(root, BEHAVIOR, "event.data.litres", "3")
        (root / MANIFEST).unlink()
        assert exhibition.reload().verdict == "applied"
        live(exhibition, lambda: not threads("lumen-program-spray"))


def test_the_presence_has_the_hash_of_each_skills_code(tmp_path: Path) -> None:
    root = project_in(tmp_path)
    with lumen.open(root, robot=Obedient()) as exhibition:
        part = exhibition.services[SkillsPart]
        until(lambda: "skills" in part.said)
        before = part.said["skills"]["spray"]
        edit(root, CODE, "litres", "liters")
        until(lambda: part.said["skills"]["spray"] != before)


class InHall(Obedient):
    """A robot that performs skills, in a hall of its own."""

    def place(self, visitor: Visitor | None) -> None: ...

    def face(self) -> None:
        return None


def test_a_story_on_a_robot_that_performs_skills_prints_that_it_does_not(tmp_path: Path) -> None:
    project = lumen.load(project_in(tmp_path, SHORT))
    printed = {}
    for setup in (set_up_with(InHall()), set_up("recording", project, "max")):
        trace = RehearsalTrace(setup.clock.now, lambda: project.machine)
        services = compose(Plan(project, setup, story=project.stories["visitor"], narrator=trace))
        start([services])
        assert taker_of("spray", project.verbs["spray"]) is project
        services.node.close()
        assert taker_of("spray", project.verbs["spray"]) is None
        printed[type(setup.robot).__name__] = [text for _, who, text in trace.lines if who == "skills"]
    said = ["a story does not run their code: the robot only waits during `spray`"]
    assert list(printed.values()) == [said, []]


def test_a_robot_that_gets_another_name_at_the_next_start_still_runs_the_code(tmp_path: Path) -> None:
    story = ("did: {spray: 3s}, context: {litres: 0.1}", "within: 5s")
    root = project_in(tmp_path, {**SHORT, STORY: story})
    with lumen.open(root, robot=Obedient()) as exhibition:
        edit(root, "lumen.yaml", "name: NAO", "name: ANA")
        assert exhibition.reload().verdict == "applied"
        assert exhibition.project.robot == "NAO"
        meet(exhibition)
        live(exhibition, lambda: "sprayed" in exhibition.configuration)
        assert threads("lumen-program-spray")
        assert exhibition.context == {"litres": 0.2}


def test_a_skill_without_an_exhibition_is_pretended_with_a_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    row = lumen.load(project_in(tmp_path)).verbs["spray"]
    runner = SkillRunner()
    call = runner.begin(Do("spray", {"duration": "1s", "nozzle": "left"}, row=row), 0.0)
    times = count()
    until(lambda: call.advance(float(next(times))))
    runner.close()
    assert "`spray` was only pretended: no exhibition of its project is open in this process" in caplog.text
