"""Draw a sheet as an image with matplotlib, in greys and dashes that survive a black-and-white printer."""

import io
import logging
import os
from typing import TYPE_CHECKING, Any

from lumen.extras import demand
from lumen.project.formats.plots.sheet import PlotAxis, PlotBars, PlotLine, PlotMark, PlotPanel, PlotSheet, PlotSurface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PLOT_ENDINGS = (".png", ".svg")

PANEL_WIDTH, PANEL_HEIGHT, DPI = 3.6, 2.6, 110
"""The size of a panel [inch], and the resolution [dots per inch]."""

_DASHES = ("-", "--", "-.", ":", (0, (6, 1, 1, 1, 1, 1)), (0, (1, 3)))
_GREYS = ("#000000", "#1f5a99", "#a8480f", "#3d3d3d", "#6a3d8a", "#5c7a1f")
_STYLE: dict[Any, Any] = {
    "text.parse_math": False,  # a name may contain a dollar
    "svg.fonttype": "none",  # text stays searchable
    "svg.hashsalt": "lumen",  # the same sheet gives the same file
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.edgecolor": "none",
    "legend.framealpha": 0.7,
    "legend.fontsize": 7,
    "lines.linewidth": 1.3,
}


def draw(sheet: PlotSheet, ending: str) -> bytes:
    """Return the sheet as the bytes of an image file; `ending` is one of `PLOT_ENDINGS`.

    The same sheet gives the same bytes. Matplotlib is set to log only errors and to open no windows in this process.
    Raises MissingExtraError if it is not installed.
    """
    demand("plot", "a plot", "matplotlib")
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    os.environ["MPLBACKEND"] = "agg"  # opens no window; matplotlib can't be imported if the variable holds a wrong name
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    rows = -(-len(sheet.panels) // sheet.columns)
    with rc_context(_STYLE):
        figure = Figure(figsize=(PANEL_WIDTH * sheet.columns, PANEL_HEIGHT * rows + 0.5), dpi=DPI, layout="constrained")
        for i, panel in enumerate(sheet.panels):
            _panel(figure, figure.add_subplot(rows, sheet.columns, i + 1), panel)
        figure.suptitle(sheet.title)
        if sheet.note:
            figure.supxlabel(sheet.note, fontsize=7)
        file = io.BytesIO()
        metadata = {"Date": None} if ending == ".svg" else {"Software": None}
        figure.savefig(file, format=ending[1:], metadata=metadata)
    return file.getvalue()


def _panel(figure: "Figure", axes: "Axes", panel: PlotPanel) -> None:
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x.label)
    axes.set_ylabel(panel.y.label)
    if panel.surface:
        _surface(figure, axes, panel.surface)
    for line in panel.lines:
        _line(axes, line)
    if panel.bars:
        _bars(axes, panel.bars)
    _limits(axes, panel.x, panel.y)
    for mark in panel.marks:
        _mark(axes, mark)
    if any(line.label for line in panel.lines):
        axes.legend(loc="best")


def _line(axes: "Axes", line: PlotLine) -> None:
    dash, colour = _DASHES[line.style % len(_DASHES)], _GREYS[line.style % len(_GREYS)]
    if line.points:
        axes.plot(line.xs, line.ys, linestyle="", marker="o", markersize=2.5, color=colour, label=line.label)
        return
    axes.plot(line.xs, line.ys, linestyle=dash, color=colour, label=line.label)
    if line.filled:
        axes.fill_between(line.xs, line.ys, color="#cccccc", linewidth=0)


def _bars(axes: "Axes", bars: PlotBars) -> None:
    places = range(len(bars.labels))
    axes.barh(places, bars.values, color="#888888", height=0.5)
    axes.set_yticks([])
    axes.invert_yaxis()
    for place, label, value in zip(places, bars.labels, bars.values, strict=True):
        axes.annotate(f"{value:.3f}  {label}", (0.0, place - 0.3), va="bottom", fontsize=6)


def _surface(figure: "Figure", axes: "Axes", surface: PlotSurface) -> None:
    import numpy as np

    heights = np.ma.masked_invalid(np.array(surface.zs))
    if heights.count() and heights.max() > heights.min():
        filled = axes.contourf(surface.xs, surface.ys, heights, levels=15, cmap="Greys", alpha=0.7)
        lines = axes.contour(surface.xs, surface.ys, heights, levels=7, colors="black", linewidths=0.6)
        axes.clabel(lines, fontsize=6)
        figure.colorbar(filled, ax=axes, label=surface.label)


def _mark(axes: "Axes", mark: PlotMark) -> None:
    width, colour = (1.4, "black") if mark.strong else (0.7, "#777777")
    (axes.axhline if mark.level else axes.axvline)(mark.at, color=colour, linewidth=width, linestyle=(0, (4, 2)))
    if mark.label:
        place = (axes.get_xlim()[0], mark.at) if mark.level else (mark.at, axes.get_ylim()[1])
        axes.annotate(
            mark.label,
            place,
            (2, -9 if mark.strong else -1),
            textcoords="offset points",
            va="top",
            fontsize=6,
            color=colour,
        )


def _limits(axes: "Axes", x: PlotAxis, y: PlotAxis) -> None:
    if x.low is not None:
        axes.set_xlim(x.low, x.high)
    if y.low is not None:
        axes.set_ylim(y.low, y.high)
