"""Import and export of W3C State Chart XML (SCXML 1.0)."""

from lumen.features.formats_charts.scxml.reader import read_scxml
from lumen.features.formats_charts.scxml.writer import write_scxml

__all__ = ["read_scxml", "write_scxml"]
