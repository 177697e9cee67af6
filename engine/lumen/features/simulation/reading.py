"""The section `imperfections:` of lumen.yaml, read into `Imperfections`."""

from collections.abc import Mapping
from typing import Any

from lumen.features.simulation.settings import Imperfections
from lumen.project.document_report import DocumentReport


def read_imperfections(data: Mapping[str, Any], report: DocumentReport) -> Imperfections:
    """Return the simulated robot's imperfections; imperfections that lumen.yaml does not name are on."""
    return Imperfections(**data["imperfections"])
