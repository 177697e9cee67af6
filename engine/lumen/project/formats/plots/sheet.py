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
    """A curve; NaN is a gap in it. `style` numbers line styles that differ also in grey; `points` draws only dots."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    label: str = ""
    style: int = 0
    filled: bool = False
    points: bool = False


@dataclass(frozen=True, slots=True)
class PlotMark:
    """A thin line across the panel at `at`: upright, or horizontal if `level`; `strong` marks a result."""

    at: float
    label: str = ""
    level: bool = False
    strong: bool = False


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
    """Panels in rows of `columns`; `note` is printed below them."""

    title: str
    panels: tuple[PlotPanel, ...]
    columns: int
    note: str = ""
