"""Plots of controllers and motions: first the content as a `PlotSheet`, then the sheet as an image."""

from lumen.project.formats.plots.controller_plot import controller_sheet, curves_sheet
from lumen.project.formats.plots.drawing import PLOT_ENDINGS, draw
from lumen.project.formats.plots.explanation_plot import explained_sheet
from lumen.project.formats.plots.motion_plot import motion_sheet
from lumen.project.formats.plots.sheet import PlotAxis, PlotBars, PlotLine, PlotMark, PlotPanel, PlotSheet, PlotSurface

__all__ = [
    "PLOT_ENDINGS", "PlotAxis", "PlotBars", "PlotLine", "PlotMark", "PlotPanel", "PlotSheet", "PlotSurface",
    "controller_sheet", "curves_sheet", "draw", "explained_sheet", "motion_sheet",
]  # fmt: skip
