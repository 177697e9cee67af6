"""Writes a diagram as SVG, in one file without dependencies."""

import itertools
from collections.abc import Iterator
from xml.sax.saxutils import escape

from lumen.run.diagrams.diagram import Diagram
from lumen.run.diagrams.layering import Point
from lumen.run.diagrams.placing import (
    PADDING,
    ROW,
    ROW_HEIGHT,
    TITLE,
    TITLE_HEIGHT,
    PlacedArrow,
    PlacedBox,
    place,
    text_width,
)

MARGIN = 28.0
MAX_WIDTH = 1400.0
"""The greatest width of a picture [px]; a wider one is scaled down."""
FONT = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"
INK, QUIET, LINE, ARROW = "#1f2d3d", "#51637a", "#5b7492", "#8496ac"
FRAMES = ("#f4f7fb", "#eaf0f7", "#e0e9f3", "#d7e2ef")
MARKED = "#fff3cf"
SPREAD = 0.6
"""The share of a side along which arrows begin and end."""


def svg(diagram: Diagram) -> str:
    """Return a diagram as SVG text that ends with a newline."""
    placement = place(diagram)
    top = MARGIN + 34
    width, height = placement.size.width + 2 * MARGIN, placement.size.height + top + MARGIN
    width = max(width, text_width(diagram.title, 22) + 2 * MARGIN)
    shrunk = min(1.0, MAX_WIDTH / width)
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * shrunk:.0f}" height="{height * shrunk:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" font-family="{FONT}">',
        f"<title>{escape(diagram.title)}</title>",
        f'<defs><marker id="tip" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" orient="auto">'
        f'<path d="M0 0.8 L10 5 L0 9.2 z" fill="{ARROW}"/></marker></defs>',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
        f'<text x="{MARGIN:.0f}" y="{MARGIN + 8:.0f}" font-size="19" font-weight="bold" fill="{INK}">'
        f"{escape(diagram.title)}</text>",
        f'<g transform="translate({MARGIN:.0f} {top:.0f})">',
        *(line for box in placement.boxes for line in _frames(box, 0)),
        *_arrows(placement.arrows),
        *(line for box in placement.boxes for line in _boxes(box)),
        "</g>",
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _frames(placed: PlacedBox, depth: int) -> Iterator[str]:
    """Yield the frames of boxes that contain others; everything else is drawn above them."""
    if not placed.within:
        return
    x, y, width, height = *placed.corner, *placed.size
    yield (
        f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="12" '
        f'fill="{FRAMES[min(depth, len(FRAMES) - 1)]}" stroke="#b9c8da"/>'
    )
    yield from (line for inner in placed.within for line in _frames(inner, depth + 1))


def _boxes(placed: PlacedBox) -> Iterator[str]:
    box, (x, y), (width, height) = placed.box, placed.corner, placed.size
    if not placed.within:
        fill, rounding = MARKED if box.marked else "#ffffff", 4 if box.final else 9
        thick = 2.2 if box.final or box.marked else 1.2
        yield (
            f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="{rounding}" fill="{fill}" '
            f'stroke="{LINE}" stroke-width="{thick}"/>'
        )
    if box.first:
        yield f'<circle cx="{x + 9:.1f}" cy="{y - 11:.1f}" r="4.5" fill="{INK}"/>'
        yield f'<path d="M{x + 9:.1f} {y - 7:.1f} V{y - 0.5:.1f}" stroke="{INK}" stroke-width="1.4"/>'
    baseline = y + TITLE_HEIGHT - 1
    yield (
        f'<text x="{x + PADDING:.1f}" y="{baseline:.1f}" font-size="{TITLE:g}" font-weight="bold" fill="{INK}">'
        f"{escape(box.title)}</text>"
    )
    for number, row in enumerate(box.rows, 1):
        yield (
            f'<text x="{x + PADDING:.1f}" y="{baseline + 2 + number * ROW_HEIGHT:.1f}" font-size="{ROW:g}" '
            f'fill="{QUIET}">{escape(row)}</text>'
        )
    yield from (line for inner in placed.within for line in _boxes(inner))


def arrow_lines(arrows: tuple[PlacedArrow, ...]) -> Iterator[str]:
    """Yield the line of each arrow, as the `d` of an SVG path."""
    ends = _spread(arrows)
    for number, arrow in enumerate(arrows):
        points = [ends[number, True], *arrow.way, ends[number, False]]
        path = [f"M{points[0].x:.1f} {points[0].y:.1f}"]
        for one, other in itertools.pairwise(points):
            middle = (one.y + other.y) / 2
            path.append(f"C{one.x:.1f} {middle:.1f} {other.x:.1f} {middle:.1f} {other.x:.1f} {other.y:.1f}")
        yield " ".join(path)


def _arrows(arrows: tuple[PlacedArrow, ...]) -> Iterator[str]:
    for line in arrow_lines(arrows):
        yield f'<path d="{line}" fill="none" stroke="{ARROW}" stroke-width="1.4" marker-end="url(#tip)"/>'


def _spread(arrows: tuple[PlacedArrow, ...]) -> dict[tuple[int, bool], Point]:
    """Return the points at which arrows begin (True) and end, spread along a side in the order of their other ends.

    The keys are an arrow's index and whether it begins there.
    """
    sides: dict[tuple[str, bool], list[tuple[float, int, bool, PlacedBox]]] = {}
    for number, arrow in enumerate(arrows):
        down = arrow.start.corner.y < arrow.end.corner.y
        for begins, box, other in ((True, arrow.start, arrow.end), (False, arrow.end, arrow.start)):
            near = (arrow.way[0] if begins else arrow.way[-1]).x if arrow.way else _middle(other)
            sides.setdefault((box.box.id, down == begins), []).append((near, number, begins, box))
    found: dict[tuple[int, bool], Point] = {}
    for (_, below), joined in sides.items():
        for place_, (_, number, begins, box) in enumerate(sorted(joined, key=lambda each: each[:3])):
            share = (place_ + 1) / (len(joined) + 1)
            x = box.corner.x + box.size.width * ((1 - SPREAD) / 2 + SPREAD * share)
            found[number, begins] = Point(x, box.corner.y + (box.size.height if below else 0.0))
    return found


def _middle(box: PlacedBox) -> float:
    return box.corner.x + box.size.width / 2
