"""Nodes in layers, after Sugiyama, Tagawa and Toda (1981): ranks, then an order with few crossings, then positions.

The result is deterministic: of equally good alternatives, the one given first is chosen.
"""

import itertools
from collections.abc import Hashable, Mapping, Sequence
from typing import NamedTuple, TypeVar

SWEEPS = 12
"""The number of passes that improve the order of the layers."""
SETTLING = 12
"""The number of passes that move nodes towards their neighbours."""
GAP, LAYER_GAP = 28.0, 46.0
"""The distances between two nodes of a layer, and between layers [px]."""
WAY = 14.0
"""The width that is left for an arrow that passes through a layer [px]."""


class Extent(NamedTuple):
    """Width and height [px]."""

    width: float
    height: float


class Point(NamedTuple):
    """A point in the picture, from its upper left corner [px]."""

    x: float
    y: float


N = TypeVar("N", bound=Hashable)
Edge = tuple[N, N]


class Layering(NamedTuple):
    """The result of a layout."""

    corners: Mapping[object, Point]
    """The upper left corner of each node."""
    size: Extent
    """The size of the picture."""
    ways: Mapping[tuple[object, object], tuple[Point, ...]]
    """The points that each edge passes between its ends."""


def layered(sizes: Mapping[N, Extent], edges: Sequence[Edge[N]], widest: float) -> Layering:
    """Return a layout of nodes in layers from top to bottom; edges lead downwards, except those that close a cycle.

    The nodes of a layer are together at most `widest` [px] wide, unless a single node is wider. Arrows that pass
    through the layer may widen it. An edge from a node to itself is left out.
    """
    down = _without_cycles(list(sizes), edges)
    ranks = _narrow(_ranks(list(sizes), down), sizes, widest)
    layers, chains, room = _with_ways(ranks, dict(sizes), edges)
    joined = _neighbours(chains)
    _order(layers, joined)
    centres = _centres(layers, joined, room)
    left = min((centres[n] - room[n].width / 2 for layer in layers for n in layer), default=0.0)
    corners: dict[object, Point] = {}
    passed: dict[object, tuple[Point, Point]] = {}
    top = 0.0
    for layer in layers:
        height = max((room[n].height for n in layer), default=0.0)
        for n in layer:
            x = centres[n] - room[n].width / 2 - left
            corners[n] = Point(x, top + (height - room[n].height) / 2)
            middle = x + room[n].width / 2
            passed[n] = Point(middle, top), Point(middle, top + height)
        top += height + LAYER_GAP
    width = max((corners[n].x + room[n].width for layer in layers for n in layer), default=0.0)
    ways = {edge: _way(chain, passed, corners) for edge, chain in chains.items()}
    return Layering({n: corners[n] for n in sizes}, Extent(width, max(top - LAYER_GAP, 0.0)), ways)


def _way(
    chain: Sequence[object], passed: Mapping[object, tuple[Point, Point]], corners: Mapping[object, Point]
) -> tuple[Point, ...]:
    """Return the points at which an edge enters and leaves each layer that it passes."""
    down = corners[chain[0]].y < corners[chain[-1]].y
    return tuple(point for n in chain[1:-1] for point in (passed[n] if down else passed[n][::-1]))


def _without_cycles(nodes: Sequence[N], edges: Sequence[Edge[N]]) -> list[Edge[N]]:
    """Return the edges without self-loops, and with those reversed that close a cycle in a depth-first walk.

    The walk starts at the first node.
    """
    out: dict[N, list[N]] = {n: [] for n in nodes}
    for one, other in edges:
        out[one].append(other)
    number: dict[N, int] = {}
    ended: dict[N, int] = {}
    for start in nodes:
        stack: list[tuple[N, int]] = [(start, 0)]
        while stack:
            n, at = stack.pop()
            if at == 0:
                if n in number:
                    continue
                number[n] = len(number)
            if at < len(out[n]):
                stack.append((n, at + 1))
                if out[n][at] not in number:
                    stack.append((out[n][at], 0))
            else:
                ended[n] = len(ended)
    return [(a, b) if ended[a] > ended[b] else (b, a) for a, b in edges if a != b]


def _ranks(nodes: Sequence[N], down: Sequence[Edge[N]]) -> dict[N, int]:
    """Return the length of the longest path to each node from a node at the top."""
    below: dict[N, list[N]] = {n: [] for n in nodes}
    above = dict.fromkeys(nodes, 0)
    for one, other in down:
        below[one].append(other)
        above[other] += 1
    ranks = dict.fromkeys(nodes, 0)
    ready = [n for n in nodes if not above[n]]
    for n in ready:  # `ready` grows during the loop
        for other in below[n]:
            ranks[other] = max(ranks[other], ranks[n] + 1)
            above[other] -= 1
            if not above[other]:
                ready.append(other)
    return ranks


def _narrow(ranks: Mapping[N, int], sizes: Mapping[N, Extent], widest: float) -> dict[N, int]:
    """Return the ranks, after splitting those that are wider than `widest`."""
    found: dict[N, int] = {}
    last = -1
    for rank in sorted(set(ranks.values())):
        last, used = last + 1, 0.0
        for n in (n for n in ranks if ranks[n] == rank):
            if used and used + sizes[n].width > widest:
                last, used = last + 1, 0.0
            found[n], used = last, used + sizes[n].width + GAP
    return found


def _with_ways(
    ranks: Mapping[N, int], room: dict[N, Extent], edges: Sequence[Edge[N]]
) -> tuple[list[list[object]], dict[tuple[object, object], list[object]], dict[object, Extent]]:
    """Return the layers, the chain of nodes along each edge, and the sizes of all nodes.

    An edge has a narrow node of its own in each layer that it crosses. Edges from a node to itself are left out.
    """
    layers: list[list[object]] = [[] for _ in range(max(ranks.values(), default=-1) + 1)]
    for n, rank in ranks.items():
        layers[rank].append(n)
    chains: dict[tuple[object, object], list[object]] = {}
    widths: dict[object, Extent] = dict(room.items())
    for one, other in edges:
        if one == other:
            continue
        step = 1 if ranks[other] > ranks[one] else -1
        passed: list[object] = []
        for rank in range(ranks[one] + step, ranks[other], step):
            way = ("way", one, other, rank)
            layers[rank].append(way)
            widths[way] = Extent(WAY, 0.0)
            passed.append(way)
        chains[one, other] = [one, *passed, other]
    return layers, chains, widths


def _neighbours(chains: Mapping[tuple[object, object], Sequence[object]]) -> dict[object, list[object]]:
    joined: dict[object, list[object]] = {}
    for chain in chains.values():
        for one, other in itertools.pairwise(chain):
            joined.setdefault(one, []).append(other)
            joined.setdefault(other, []).append(one)
    return joined


def _order(layers: list[list[object]], joined: Mapping[object, Sequence[object]]) -> None:
    """Sort each layer by the mean position of the neighbours in the layer before, down and up again; keep the best."""
    best, crossings = [list(layer) for layer in layers], _crossings(layers, joined)
    for sweep in range(SWEEPS):
        numbers = range(1, len(layers)) if sweep % 2 == 0 else range(len(layers) - 2, -1, -1)
        for number in numbers:
            before = layers[number - 1 if sweep % 2 == 0 else number + 1]
            place = {n: i for i, n in enumerate(before)}
            own = {n: i for i, n in enumerate(layers[number])}
            at = {n: _mean([place[m] for m in joined.get(n, ()) if m in place], own[n]) for n in own}
            layers[number].sort(key=lambda n, at=at, own=own: (at[n], own[n]))  # type: ignore[misc]
        if (now := _crossings(layers, joined)) < crossings:
            best, crossings = [list(layer) for layer in layers], now
    layers[:] = best


def _mean(values: Sequence[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise


def _crossings(layers: Sequence[Sequence[object]], joined: Mapping[object, Sequence[object]]) -> int:
    count = 0
    for upper, lower in itertools.pairwise(layers):
        place = {n: i for i, n in enumerate(lower)}
        ends = [end for n in upper for end in sorted(place[m] for m in joined.get(n, ()) if m in place)]
        count += sum(a > b for i, a in enumerate(ends) for b in ends[i + 1 :])
    return count


def _centres(
    layers: Sequence[Sequence[object]], joined: Mapping[object, Sequence[object]], room: Mapping[object, Extent]
) -> dict[object, float]:
    """Return the middle of each node [px] from the left: near its neighbours, without overlap."""
    centres: dict[object, float] = {}
    for layer in layers:
        whole = sum(room[n].width for n in layer) + GAP * (len(layer) - 1)
        x = -whole / 2
        for n in layer:
            centres[n] = x + room[n].width / 2
            x += room[n].width + GAP
    for turn in range(SETTLING):
        for layer in layers if turn % 2 == 0 else reversed(layers):
            wished = [_mean([centres[m] for m in joined.get(n, ())], centres[n]) for n in layer]
            centres.update(zip(layer, _apart(wished, [room[n].width for n in layer]), strict=True))
    return centres


def _apart(wished: Sequence[float], widths: Sequence[float]) -> list[float]:
    """Return positions near the wished ones, without overlap: the mean of pushing right and pushing left."""
    right, left = list(wished), list(wished)
    for i in range(1, len(right)):
        right[i] = max(right[i], right[i - 1] + (widths[i - 1] + widths[i]) / 2 + GAP)
    for i in range(len(left) - 2, -1, -1):
        left[i] = min(left[i], left[i + 1] - (widths[i + 1] + widths[i]) / 2 - GAP)
    return [(a + b) / 2 for a, b in zip(right, left, strict=True)]
