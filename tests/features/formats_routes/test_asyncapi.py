"""AsyncAPI's own parser accepts the exported documents, which describe the routes in full."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from jsonschema import Draft202012Validator

from lumen.cli.main import main
from lumen.feature import VerbRow
from lumen.features.formats_routes.asyncapi import write_asyncapi
from lumen.features.skills.manifest import Skill
from lumen.language.projects import Project
from tests import ROOT
from tests.exhibits import project
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.waiting import HANG


def parsed(*projects: Project) -> list[dict[str, Any]]:
    """Export each project and return the results of AsyncAPI's own parser."""
    texts = json.dumps([write_asyncapi(project) for project in projects])
    script = ROOT / "tests/formats/asyncapi.cjs"
    done = run_guarded(
        ["node", script, fetched("asyncapi")], input=texts, capture_output=True, text=True, timeout=HANG, check=True
    )
    return list(json.loads(done.stdout))


def with_face(schema: dict[str, Any]) -> Project:
    """Return the shipped project with another schema for faces, and few other routes."""
    before = project()
    routes = {name: before.routes[name] for name in ("face", "command")}
    return replace(before, routes=routes, messages={**before.messages, "face.detection": schema})


def test_asyncapis_own_parser_finds_the_shipped_routes_and_nothing_wrong() -> None:
    """The parser also reports an invalid schema and resolves references inside a schema."""
    points = {"$defs": {"point": {"type": "number"}}, "type": "array", "items": {"$ref": "#/$defs/point"}}
    shipped, pointed, wrong = parsed(project(), with_face(points), with_face({"type": "numbr"}))
    routes = project().routes
    assert shipped["errors"] == []
    old = {f"{name}.alias": route for name, route in routes.items() if route.alias}
    assert shipped["channels"] == {n: r.key for n, r in routes.items()} | {n: r.alias for n, r in old.items()}
    actions = {n: "receive" if r.direction == "in" else "send" for n, r in (routes | old).items()}
    assert shipped["actions"] == actions
    assert pointed["errors"] == []
    assert pointed["payloads"]["face"][0]["items"]["type"] == "number"
    assert wrong["errors"]


def test_a_body_is_judged_by_the_document_as_by_the_project() -> None:
    document = yaml.safe_load(write_asyncapi(project()))
    for name, route in project().routes.items():
        payload = document["components"]["messages"][name]["payload"]
        if not route.schema:
            assert payload == {}
            continue
        schema = {"$ref": payload["$ref"], "components": document["components"]}
        for body in ({}, [], {"x": 1, "y": 2}, {"method": "rest"}, {"x": "left", "y": 1}):
            assert Draft202012Validator(schema).is_valid(body) == Draft202012Validator(
                project().messages[route.schema]
            ).is_valid(body)


def test_robots_that_share_a_broker_have_no_aliases() -> None:
    shared = yaml.safe_load(write_asyncapi(replace(project(), aliases=False)))
    assert set(shared["channels"]) == set(shared["operations"]) == set(project().routes)


def test_no_password_gets_into_the_document() -> None:
    text = write_asyncapi(replace(project(), bus="amqps://lumen:secret@broker.hall/"))
    assert "secret" not in text
    assert "broker.hall:5671" in text


PUMP = VerbRow(
    "",
    "Pumps water",
    {"required": ["litres"], "properties": {"litres": {"type": "number"}}},
    {"properties": {"left": {"type": "number"}}},
    details=Skill("module", ("pump",)),
)


def with_skills(before: Project) -> Project:
    return replace(before, verbs={"fill": PUMP, "blink": PUMP._replace(details=Skill("python", ("skills/blink.py",)))})


def test_the_calls_and_answers_of_skills_that_modules_perform_are_listed() -> None:
    document = yaml.safe_load(write_asyncapi(with_skills(project())))
    own = {name: each["address"] for name, each in document["channels"].items() if name.startswith("skill")}
    assert own == {"skill.pump": "lumen.{robot}.skill.pump", "skill_answer": "lumen.{robot}.skill_answer"}
    assert {name: document["operations"][name]["action"] for name in own} == {
        "skill.pump": "send",
        "skill_answer": "receive",
    }
    orders, answers = (Draft202012Validator(document["components"]["messages"][name]["payload"]) for name in own)
    assert orders.is_valid({"call": "a", "skill": "fill", "arguments": {"litres": 1}})
    assert orders.is_valid({"call": "a", "cancel": True})
    assert not orders.is_valid({"call": "a", "skill": "fill", "arguments": {"liters": 1}})
    assert not orders.is_valid({"call": "a", "skill": "blink", "arguments": {"litres": 1}})
    assert answers.is_valid({"call": "a", "result": {"left": 2}})
    assert not answers.is_valid({"call": "a", "result": {"left": "much"}})
    assert not answers.is_valid({"result": {"left": 2}})


def test_asyncapis_own_parser_accepts_skills_of_modules() -> None:
    (found,) = parsed(replace(with_skills(project()), routes={}, messages={}))
    assert found["errors"] == []
    assert set(found["channels"]) == {"skill.pump", "skill_answer"}


@pytest.mark.slow
def test_the_command_writes_it(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["export", "asyncapi", "-o", str(tmp_path / "lumen.yaml"), "--project", str(ROOT)]) == 0
    assert yaml.safe_load((tmp_path / "lumen.yaml").read_text())["asyncapi"] == "3.0.0"
