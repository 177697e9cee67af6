"""The shipped bodies beside NAO, and robots of them on a floor with room."""

from functools import cache
from typing import Any

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.robots import Body
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.yaml_reader import parse
from tests.features.simulation.conftest import MODELS
from tests.features.simulation.walks import on_the_floor


@cache
def shipped(name: str) -> Body:
    """Return the body of `models/NAME.yaml`."""
    document, _ = parse(f"models/{name}.yaml", (MODELS / f"{name}.yaml").read_bytes())
    assert document is not None
    report = DocumentReport(document)
    body = build_body(document.data, report, name=name)
    assert body is not None
    assert not report.diagnostics
    return body


def standing(name: str, **options: Any) -> SimulatedRobot:
    """Return a robot with that body, on the floor."""
    return on_the_floor(shipped(name), **options)
