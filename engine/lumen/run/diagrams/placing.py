"""The positions of a diagram's boxes: the content of a box is laid out first, then the box as one node."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from lumen.run.diagrams.diagram import Diagram, StateBox
from lumen.run.diagrams.layering import GAP, Extent, Point, layered

WIDEST, WAYS = 1260.0, 60.0
"""The greatest width of a layer, and the room for arrows around a frame [px]. A picture then fits in 1400 px."""
TITLE, ROW = 14.0, 12.0
"""The font sizes of titles and rows [px]."""
TITLE_HEIGHT, ROW_HEIGHT = 20.0, 16.0
PADDING = 12.0
FRAME = 22.0
"""The distance between a frame and its content [px]."""
_NARROW, _WIDE = frozenset("iljtfrI.,:;'|!()[]/ ’"), frozenset("mwMW@%—…→←")
_BOLD = 1.14


class PlacedBox(NamedTuple):
    """A box with its position."""

    box: StateBox
    corner: Point
    """The upper left corner of the box in the picture."""
    size: Extent
    within: tuple["PlacedBox", ...] = ()
    """The boxes inside."""


class PlacedArrow(NamedTuple):
    """An arrow between two boxes in the same frame."""

    start: PlacedBox
    end: PlacedBox
    way: tuple[Point, ...]
    """The points that the arrow passes between the two boxes."""


class PlacedDiagram(NamedTuple):
    """A diagram with the places of its boxes and arrows, and its size [px]."""

    boxes: tuple[PlacedBox, ...]
    arrows: tuple[PlacedArrow, ...]
    size: Extent


class _Inside(NamedTuple):
    """The content of a frame, relative to the corner of the frame."""

    boxes: tuple[PlacedBox, ...]
    arrows: tuple[PlacedArrow, ...]
    size: Extent


def place(diagram: Diagram) -> PlacedDiagram:
    """Return the places of all boxes; the result is always the same for the same diagram."""
    return PlacedDiagram(*_inside(diagram.boxes, diagram.arrows, WIDEST, side_by_side=False))


def text_width(text: str, size: float) -> float:
    """Return the approximate width of a text in the widest substitute for Helvetica [px]."""
    units = (0.39 if c in _NARROW else 0.98 if c in _WIDE else 0.72 if c.isupper() else 0.62 for c in text)
    return size * sum(units)


def header_height(box: StateBox) -> float:
    """Return the height of title and rows together [px]."""
    return TITLE_HEIGHT + ROW_HEIGHT * len(box.rows) + (4.0 if box.rows else 0.0)


def _inside(
    boxes: Sequence[StateBox], arrows: Sequence[tuple[str, str]], widest: float, *, side_by_side: bool
) -> _Inside:
    parts = {box.id: _measured(box, arrows, widest) for box in boxes}
    sizes = {id: part.size for id, part in parts.items()}
    edges = [(a, b) for a, b in _between(boxes, arrows)]
    if side_by_side:
        corners, size = _shelves(sizes, widest)
        ways: Mapping[tuple[object, object], tuple[Point, ...]] = {}
    else:
        corners, size, ways = layered(sizes, edges, widest)  # type: ignore[assignment]
    placed = {id: _moved(parts[id].boxes[0], corners[id]) for id in parts}
    inner = [_moved_arrow(arrow, corners[id]) for id, part in parts.items() for arrow in part.arrows]
    own = [PlacedArrow(placed[a], placed[b], ways.get((a, b), ())) for a, b in edges]
    return _Inside(tuple(placed.values()), (*inner, *own), size)


def _measured(box: StateBox, arrows: Sequence[tuple[str, str]], widest: float) -> _Inside:
    """Return one box at the origin, with its content."""
    rows = [text_width(row, ROW) for row in box.rows]
    header = max([text_width(box.title, TITLE) * _BOLD, *rows]) + 2 * PADDING
    height = header_height(box) + PADDING
    if not box.within:
        size = Extent(max(header, 90.0), height)
        return _Inside((PlacedBox(box, Point(0, 0), size),), (), size)
    within = _inside(box.within, arrows, widest - 2 * FRAME - WAYS, side_by_side=box.parallel)
    size = Extent(max(header, within.size.width + 2 * FRAME), height + FRAME + within.size.height)
    shift = Point((size.width - within.size.width) / 2, height + FRAME / 2)
    inner = tuple(_moved(each, shift) for each in within.boxes)
    moved = tuple(_moved_arrow(arrow, shift) for arrow in within.arrows)
    return _Inside((PlacedBox(box, Point(0, 0), size, inner),), moved, size)


def _between(boxes: Sequence[StateBox], arrows: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the arrows between different boxes, each once; arrows of a box's content count as arrows of the box."""
    owner = {inner.id: box.id for box in boxes for inner in Diagram("", (box,)).all()}
    lifted = ((owner.get(a, ""), owner.get(b, "")) for a, b in arrows)
    return list(dict.fromkeys((a, b) for a, b in lifted if a and b and a != b))


def _shelves(sizes: Mapping[str, Extent], widest: float) -> tuple[dict[str, Point], Extent]:
    """Return the corners of boxes set in rows of at most `widest` [px] if possible, and the size of the whole."""
    corners: dict[str, Point] = {}
    x = y = height = width = 0.0
    for id, size in sizes.items():
        if x and x + size.width > widest:
            x, y, height = 0.0, y + height + GAP, 0.0
        corners[id] = Point(x, y)
        x, height = x + size.width + GAP, max(height, size.height)
        width = max(width, x - GAP)
    return corners, Extent(width, y + height)


def _moved(placed: PlacedBox, by: Point) -> PlacedBox:
    corner = Point(placed.corner.x + by.x, placed.corner.y + by.y)
    return placed._replace(corner=corner, within=tuple(_moved(each, by) for each in placed.within))


def _moved_arrow(arrow: PlacedArrow, by: Point) -> PlacedArrow:
    way = tuple(Point(point.x + by.x, point.y + by.y) for point in arrow.way)
    return PlacedArrow(_moved(arrow.start, by), _moved(arrow.end, by), way)
