"""What has to be drawn, as values: panels with axes, lines, marks; nothing of how."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PlotAxis:
    """What an axis counts; both ends None where what is drawn decides."""

    label: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True)
class PlotLine:
    """A curve; NaN is a gap in it. `style` counts ways to look that stay apart in grey; `points`: only dots."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    label: str = ""
    style: int = 0
    filled: bool = False
    points: bool = False


@dataclass(frozen=True, slots=True)
class PlotMark:
    """A thin line across the panel at `at`: upright, or level; `strong` for a result."""

    at: float
    label: str = ""
    level: bool = False
    strong: bool = False


@dataclass(frozen=True, slots=True)
class PlotBars:
    """Level bars from above, each between 0 and 1."""

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
    """One pair of axes and what is in it."""

    title: str
    x: PlotAxis
    y: PlotAxis
    lines: tuple[PlotLine, ...] = ()
    marks: tuple[PlotMark, ...] = ()
    bars: PlotBars | None = None
    surface: PlotSurface | None = None


@dataclass(frozen=True, slots=True)
class PlotSheet:
    """Panels in rows of `columns`; `note` stands below them."""

    title: str
    panels: tuple[PlotPanel, ...]
    columns: int
    note: str = ""
