"""Pictures of behaviours that need nobody's help: what is in them, where it stands, and how it is drawn."""

from lumen.features.formats_charts.diagrams.dot_writer import dot_text
from lumen.features.formats_charts.diagrams.svg_writer import svg
from lumen.features.formats_charts.diagrams.views import neighbourhood, overview, region

__all__ = ["dot_text", "neighbourhood", "overview", "region", "svg"]
