"""The content of a plot as values: panels with axes, lines and marks, independent of how they are drawn."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PlotAxis:
    """An axis with its label; if both ends are None, the drawn lines decide them."""

    label: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True)
class PlotLine:
    """A curve through points, or only the points."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    """The values; NaN is a gap in the curve."""
    label: str = ""
    style: int = 0
    """The number of the line style, modulo the number of styles; styles differ in dashes and shade."""
    filled: bool = False
    points: bool = False
    """True to draw a dot at each point and no line."""


@dataclass(frozen=True, slots=True)
class PlotMark:
    """A thin line across the panel."""

    at: float
    """The coordinate of the mark on the axis that it crosses."""
    label: str = ""
    level: bool = False
    """True for a horizontal line, False for a vertical one."""
    strong: bool = False
    """True for a heavier line, which marks a result."""


@dataclass(frozen=True, slots=True)
class PlotBars:
    """Horizontal bars from top to bottom, each between 0 and 1."""

    labels: tuple[str, ...]
    values: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class PlotSurface:
    """Heights over a grid: `zs[row][column]` at (`xs[column]`, `ys[row]`)."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    zs: tuple[tuple[float, ...], ...]
    label: str


@dataclass(frozen=True, slots=True)
class PlotPanel:
    """One pair of axes and the lines, marks, bars and surface in it."""

    title: str
    x: PlotAxis
    y: PlotAxis
    lines: tuple[PlotLine, ...] = ()
    marks: tuple[PlotMark, ...] = ()
    bars: PlotBars | None = None
    surface: PlotSurface | None = None


@dataclass(frozen=True, slots=True)
class PlotSheet:
    """The panels of one image."""

    title: str
    panels: tuple[PlotPanel, ...]
    columns: int
    """The number of panels in a row."""
    note: str = ""
    """A line of text below the panels."""
