"""W3C State Chart XML (SCXML 1.0), in and out."""

from lumen.formats.scxml.reader import read_scxml
from lumen.formats.scxml.writer import write_scxml

__all__ = ["read_scxml", "write_scxml"]
