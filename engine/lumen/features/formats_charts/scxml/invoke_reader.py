"""`<invoke>` of a chart in another file (SCXML 6.4) as our `invoke`."""

import re
from pathlib import PurePosixPath
from typing import Any

from lumen.features.formats_charts.scxml.action_reader import PROCESSORS, LeftOutError, ScxmlActionReader
from lumen.project.formats.xml_elements import XmlElement

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
_ID = re.compile(r"[^\s@*]+")


def invocation(element: XmlElement, contents: ScxmlActionReader) -> dict[str, Any]:
    """The behaviour named as the file, with its id and its input; raises LeftOutError or ScriptError for all else."""
    kind, source = element.get("type"), element.get("src").removeprefix("file:")
    if kind.rstrip("/") not in {p.rstrip("/") for p in PROCESSORS} or "typeexpr" in element.attributes:
        raise LeftOutError(f"the service `{kind or element.get('typeexpr')}` is not carried over")
    if "srcexpr" in element.attributes or not source:
        raise LeftOutError("a computed or inline chart is not carried over", "save the chart in its own file")
    if "idlocation" in element.attributes:
        raise LeftOutError("`idlocation` has no counterpart in Lumen", "write `id` instead")
    name = PurePosixPath(source).stem
    if not _NAME.fullmatch(name):
        raise LeftOutError(f"`{source}` can't be the name of a behaviour", "rename the file")
    row: dict[str, Any] = {"behavior": name}
    id = element.get("id")
    if id and not _ID.fullmatch(id):
        raise LeftOutError(f"`{id}` can't be an id in Lumen")
    if id and id != name:
        row["id"] = id
    if data := contents.data(element):
        row["input"] = data
    return row
