"""Pictures of behaviours that need nobody's help: what is in them, where it stands, and how it is drawn."""

from lumen.formats.diagrams.dot_text import dot_text
from lumen.formats.diagrams.svg import svg
from lumen.formats.diagrams.views import neighbourhood, overview, region

__all__ = ["dot_text", "neighbourhood", "overview", "region", "svg"]
