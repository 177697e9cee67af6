"""Now lists the project's own skills and modules: what they are for, how they are, and a button to begin a skill."""

import shutil
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from lumen.features.console.job import skills_of
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.people import Role
from tests import ROOT
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.features.console.test_conversation import violations
from tests.features.console.test_page_types import faults_of_answers
from tests.features.console.viewer import Viewer
from tests.features.skills.stage import stage
from tests.waiting import HANG, until

PINS = {Role.SHOW: "1111", Role.OPERATOR: "2222"}
CODE = """\
import time

from lumen.skills import skill


@skill
def {name}(call):
    {body}
"""
BODIES = {"hang": "while True: time.sleep(0.1)", "fail": "1 / 0"}
MODULES = "modules: {mood: {command: [sh, -c, 'sleep 1; exit 3'], here: true}}\n"


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project with a skill that works, one that hangs and one that fails, and a module that ends again and again."""
    folder = tmp_path_factory.mktemp("own") / "project"
    shutil.copytree(ROOT / "tests/features/skills/project", folder)
    for name, body in BODIES.items():
        text = f"description: {{en: It {name}s, id: Keterampilan {name}}}\nperformed-by: {{python: skills/{name}.py}}\n"
        (folder / "skills" / f"{name}.yaml").write_text(text)
        (folder / "skills" / f"{name}.py").write_text(CODE.format(name=name, body=body))
    with (folder / "lumen.yaml").open("a") as file:
        file.write(MODULES)
    return folder


@pytest.fixture(scope="module")
def own(root: Path) -> Iterator[Hosted]:
    with closing(Hosted(root, real_skills=True)) as hosted:
        yield hosted


@pytest.fixture(scope="module")
def console(own: Hosted) -> Iterator[Browser]:
    with closing(Served(own.root)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots), HANG)
        yield served.browser


def states(browser: Browser) -> dict[str, Any]:
    """The states of the skills as the console knows them."""
    return dict(browser.robots[0]["skill_states"])


@pytest.mark.rest
def test_a_workshop_reports_the_states_of_its_skills(root: Path) -> None:
    with stage(root) as made:
        assert {name: one["state"] for name, one in made.workshop.states.items()} == dict.fromkeys(
            ("fail", "hang", "spray"), "idle"
        )
        id = made.start("hang")
        made.until(lambda: made.workshop.states["hang"]["state"] == "running")
        made.executor.cancel(id)
        made.until(lambda: made.workshop.states["hang"]["crashes"] == 1)
        told = made.workshop.states["hang"]
        assert "did not end within 500 ms of its cancel" in told["trouble"]
        made.until(lambda: made.workshop.states["hang"]["state"] in ("paused", "idle"))
        assert "ZeroDivisionError" in made.perform("fail")
        assert "ZeroDivisionError: division by zero" in made.workshop.states["fail"]["trouble"]
        made.perform("spray", duration="10ms", nozzle="left")
        assert (made.workshop.states["spray"]["state"], made.workshop.states["spray"]["trouble"]) == ("ready", "")


def test_manifests_are_read_without_their_code(root: Path) -> None:
    fail, hang, spray = skills_of(root, "", "")["skills"]
    assert [one["name"] for one in (fail, hang, spray)] == ["fail", "hang", "spray"]
    assert (spray["kind"], spray["target"]) == ("python", "skills/spray.py")
    assert spray["description"] == {"en": "Sprays water", "id": "Menyemprot air"}
    assert (spray["required"], spray["arguments"]["nozzle"]["default"]) == (["duration"], "left")


def test_a_malformed_state_of_a_skill_is_left_out() -> None:
    robot = KnownRobot("NAO")
    good = {"state": "idle", "since": "2026-11-27T12:00:00Z", "crashes": 0, "trouble": ""}
    for told in ({"a": good, "b": 1, "c": {**good, "crashes": "2"}}, 7, None):
        robot.present({"session": "s", "state": "here", "parts": ["robot"], "skill_states": told})
        [process] = robot.to_json(full=True)["processes"]
        assert process["skills"] == ({"a": good} if isinstance(told, dict) else {})


def test_the_types_of_the_pages_describe_them(console: Browser, tmp_path: Path) -> None:
    until(lambda: states(console) and console.robots[0]["modules"], HANG)
    answers = {"Now": console.get("/api/now").data, "Skills": console.get("/api/skills").data}
    assert answers["Skills"]["skills"]
    assert faults_of_answers(answers, tmp_path) == []


def test_a_skill_is_begun_by_an_operator_only(own: Hosted, console: Browser) -> None:
    ended = console.command("skill", name="spray", arguments={"duration": "10ms"}).data
    assert (ended["state"], ended["reason"]) == ("finished", "")
    failed = console.command("skill", name="fail").data
    assert "ZeroDivisionError" in failed["reason"], failed
    until(lambda: "ZeroDivisionError" in states(console)["fail"]["trouble"], HANG)
    wrong = console.command("skill", name="spray", arguments={"duration": "long"}).data
    assert wrong["state"] == "failed"
    assert console.command("skill", name="spray", arguments=[1]).status == 400
    with closing(Served(own.root, pins=PINS)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots), HANG)
        show = {"Authorization": f"Bearer {PINS[Role.SHOW]}"}
        refused = served.browser.post("/api/commands", {"id": "a", "command": "skill", "name": "spray"}, **show)
        assert refused.status == 403


@pytest.mark.slow
@pytest.mark.xdist_group("operating")
def test_now_lists_them_and_begins_a_skill(viewer: Viewer, own: Hosted, console: Browser) -> None:
    address = f"http://{console.host}:{console.port}/"
    viewer.open(address, "robot/NAO", ready=".own-list [data-skill=spray]", mode="show", language="id")
    viewer.shows("Menyemprot air", "[data-skill=spray]")
    assert not viewer.all(".begin-skill")
    viewer.open(address, "robot/NAO", ready=".own-list [data-skill=spray]", mode="author")
    viewer.shows("Sprays water", "[data-skill=spray]")
    viewer.shows("Performed by the Python file skills/spray.py", "[data-skill=spray]")
    assert violations(viewer) == []
    viewer.click("[data-skill=spray] summary")
    assert viewer.run("return document.querySelector('[data-skill=spray] select').value") == "left"
    viewer.click("[data-skill=spray] input[name=duration]")
    viewer.type("10ms")
    viewer.click("[data-skill=spray] .begin-skill button")
    viewer.tells("Skill spray: done")
    viewer.shows("ready", "[data-skill=spray] .badge")
    viewer.click("[data-skill=fail] summary")
    viewer.click("[data-skill=fail] .begin-skill button")
    viewer.shows("ZeroDivisionError: division by zero", "[data-skill=fail] .bad")
    viewer.click("[data-skill=hang] summary")
    viewer.click("[data-skill=hang] .begin-skill button")
    viewer.shows("running", "[data-skill=hang] .badge")
    console.command("rest")
    viewer.shows("was killed: it did not end within 500 ms of its cancel", "[data-skill=hang] .bad")
    viewer.shows("Its program crashed or was killed 1 time.", "[data-skill=hang]")
    viewer.shows("lost", "[data-module=mood] .badge")
    viewer.shows("Restarted", "[data-module=mood]")
    viewer.shows("ended with exit code 3", "[data-module=mood] .bad")
