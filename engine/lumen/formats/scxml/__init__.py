"""W3C State Chart XML (SCXML 1.0), in and out."""

from lumen.formats.scxml.reading import read_scxml
from lumen.formats.scxml.writing import write_scxml

__all__ = ["read_scxml", "write_scxml"]
