"""If the ears report several possible texts, the behaviour uses the first that means something now."""

from dataclasses import replace
from typing import Any

import pytest

import lumen
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.run.runtime import Runtime
from lumen.statechart import Machine, Step
from tests.tables import for_each

MACHINE = Machine.from_dict(
    {
        "id": "talk",
        "phrases": {"dance": {"en": ["dance"]}, "sing": {"en": ["sing", "song"]}},
        "answers": {"faq": [{"phrases": {"en": ["how tall"]}, "value": "57 cm"}]},
        "context": {"said": "''"},
        "states": {
            "offer": {
                "on": {
                    "heard": [
                        {"guard": "heard(event.data.result, 'dance')", "target": "dancing"},
                        {"guard": "heard(event.data.result, 'sing')", "target": "singing"},
                        {"guard": "lookup(event.data.result, 'faq') != null", "target": "answering"},
                        {"guard": "!heard(event.data.result, 'dance')", "target": "asking"},
                    ]
                }
            },
            "dancing": None,
            "singing": None,
            "answering": None,
            "asking": None,
        },
    }
)


ROWS = Machine.from_dict(
    {
        "id": "talk",
        "phrases": {"dance": {"en": ["dance"]}, "sing": {"en": ["sing", "song"]}},
        "answers": {"faq": [{"phrases": {"en": ["how tall"]}, "value": "57 cm"}]},
        "states": {
            "offer": {"hears": {"dance": "dancing", "sing": "singing", "faq": "answering", "else": "asking"}},
            "dancing": None,
            "singing": None,
            "answering": None,
            "asking": None,
        },
    }
)


def runtime(project: Project, machine: Machine = MACHINE) -> tuple[Runtime, list[Step]]:
    steps: list[Step] = []
    made = Runtime(replace(project, behaviors={"talk": machine}, behavior="talk"), steps.append)
    made.start()
    return made, steps


@pytest.fixture(scope="module")
def project() -> Project:
    return lumen.load(".")


@pytest.mark.parametrize("machine", [MACHINE, ROWS], ids=["guards", "hears"])
@pytest.mark.parametrize(
    ("result", "others", "state", "taken"),
    [
        ("can you thing", ["can you sing", "can you dance"], "singing", "can you sing"),
        ("can you sing", ["can you dance"], "singing", "can you sing"),
        ("who tall", ["how tall"], "answering", "how tall"),
        ("who built you", ["who build you"], "asking", "who built you"),
    ],
)
def test_the_first_that_means_something(
    project: Project, result: str, others: list[str], state: str, taken: str, machine: Machine
) -> None:
    talk, steps = runtime(project, machine)
    data = {"result": result, "confidence": 0.4, "alternatives": [{"result": text} for text in others]}
    talk.tick(1.0, [Event("heard", data, 1.0)])
    assert state in talk.snapshot.configuration
    event = steps[-1].event
    assert event is not None
    assert event.data == {**data, "result": taken}


@for_each("others", [None, [], "can you dance", [3, {}, {"result": 4}], [{"result": ""}] * 1000])
def test_alternatives_that_are_none_change_nothing(project: Project, others: Any) -> None:
    talk, steps = runtime(project)
    talk.tick(1.0, [Event("heard", {"result": "hello", "alternatives": others}, 1.0)])
    event = steps[-1].event
    assert event is not None
    assert (event.data["result"], "asking" in talk.snapshot.configuration) == ("hello", True)


def test_a_result_alone_is_as_it_was(project: Project) -> None:
    talk, _ = runtime(project)
    talk.tick(1.0, [Event("heard", {"result": "please dance"}, 1.0)])
    assert "dancing" in talk.snapshot.configuration
