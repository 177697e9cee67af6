"""Pictures of controllers and motions: from a value to what has to be drawn (`Sheet`), and from that to an image."""

from lumen.formats.plots.controllers import controller_sheet, curves_sheet
from lumen.formats.plots.drawing import ENDINGS, draw
from lumen.formats.plots.explained import explained_sheet
from lumen.formats.plots.motions import motion_sheet
from lumen.formats.plots.sheet import Axis, Bars, Line, Mark, Panel, Sheet, Surface

__all__ = [
    "ENDINGS", "Axis", "Bars", "Line", "Mark", "Panel", "Sheet", "Surface",
    "controller_sheet", "curves_sheet", "draw", "explained_sheet", "motion_sheet",
]  # fmt: skip
