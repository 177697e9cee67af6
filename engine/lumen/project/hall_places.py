"""Read `places:` of lumen.yaml as the places of the hall."""

from collections.abc import Mapping
from typing import Any

from lumen.language.hall_places import DEFAULT_WITHIN, HallPlace, HallPlaces
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import finite
from lumen.project.units import ANGLES, LENGTHS


def read_hall_places(data: Mapping[str, Any], report: DocumentReport) -> HallPlaces:
    """Return the places whose numbers can be used; headings are in degrees if the file names no unit."""
    units = data.get("units", {})
    length, angle = LENGTHS[units.get("length", "m")], ANGLES[units.get("angle", "deg")]
    found = {}
    for name, row in data["places"].items():
        if not all(finite(value, report, ("places", name, key)) for key, value in row.items()):
            continue
        found[name] = HallPlace(
            x=row["x"] * length,
            y=row["y"] * length,
            heading=row["heading"] * angle if "heading" in row else None,
            within=row["within"] * length if "within" in row else DEFAULT_WITHIN,
        )
    return HallPlaces(found)
