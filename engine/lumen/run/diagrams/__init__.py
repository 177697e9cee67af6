"""Pictures of behaviours, drawn without other programs: their content, their layout, and their drawing."""

from lumen.run.diagrams.dot_writer import dot_text
from lumen.run.diagrams.svg_writer import svg
from lumen.run.diagrams.views import neighbourhood, overview, region

__all__ = ["dot_text", "neighbourhood", "overview", "region", "svg"]
