"""What has to be drawn, as values: panels with axes, lines, marks; nothing of how."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Axis:
    """What an axis counts; both ends None where what is drawn decides."""

    label: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, slots=True)
class Line:
    """A curve; NaN is a gap in it. `style` counts ways to look that stay apart in grey; `points`: only dots."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    label: str = ""
    style: int = 0
    filled: bool = False
    points: bool = False


@dataclass(frozen=True, slots=True)
class Mark:
    """A thin line across the panel at `at`: upright, or level; `strong` for a result."""

    at: float
    label: str = ""
    level: bool = False
    strong: bool = False


@dataclass(frozen=True, slots=True)
class Bars:
    """Level bars from above, each between 0 and 1."""

    labels: tuple[str, ...]
    values: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Surface:
    """Heights over a grid: `zs[row][column]` at (`xs[column]`, `ys[row]`)."""

    xs: tuple[float, ...]
    ys: tuple[float, ...]
    zs: tuple[tuple[float, ...], ...]
    label: str


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes and what is in it."""

    title: str
    x: Axis
    y: Axis
    lines: tuple[Line, ...] = ()
    marks: tuple[Mark, ...] = ()
    bars: Bars | None = None
    surface: Surface | None = None


@dataclass(frozen=True, slots=True)
class Sheet:
    """Panels in rows of `columns`; `note` stands below them."""

    title: str
    panels: tuple[Panel, ...]
    columns: int
    note: str = ""
