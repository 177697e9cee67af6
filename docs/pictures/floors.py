"""Draw the layers of the engine from the contract in pyproject.toml: `python docs/pictures/floors.py`.

The contract lists the packages, their order and their neighbours. This file lists the purpose of each package. A
package that is missing in one of the two is an error.
"""

import textwrap
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from itertools import groupby
from pathlib import Path

ROOT = Path(__file__).parents[2]
PICTURE = Path(__file__).with_suffix(".svg")

PURPOSES: Mapping[str, str] = {
    "cli": "arguments in, a call, text out",
    "testing": "the promises of a robot, tried by pytest",
    "standalone": "a machine, a controller, a motion, a bus or a project alone",
    "run": "an exhibition: its loop, its parts, reload, recovery, stories",
    "lint": "values to diagnostics",
    "robot": "what all robots share; recording, remote",
    "bus": "messages in memory and between processes",
    "clock": "real, virtual, simulated",
    "journal": "the inputs of an exhibition, on disk",
    "project": "YAML to values that remember their file and line",
    "insight": "why, exploration, replay, differences",
    "motion": "trajectories, gestures, life, walking",
    "statechart": "an event and a snapshot become a step",
    "fuzzy": "inference and controllers",
    "expressions": "guards, values and texts: a typed subset of CEL",
    "retrieval": "which passage answers a question",
    "talk": "phrases of visitors, and the rows of `hears`",
    "ports": "Robot, Bus, Clock: what the runtime asks of the world",
    "extras": "which package is missing, and how it comes",
    "upkeep": "threads begun again after a fault, and what is dropped counted",
    "errors": "the faults of the world, as one tree of exceptions",
    "language": "what the YAML can say, as frozen values",
    "feature": "what a manifest can hold, and who reads them",
    "distributions": "which installed packages bring features",
}
"""The purpose of each package."""

ZONES: Mapping[str, str] = {
    "cli": "people",
    "standalone": "an exhibition",
    "lint": "the world and files",
    "project": "the world and files",
    "insight": "values",
    "statechart": "values",
    "expressions": "values",
    "talk": "values",
    "ports": "values",
    "upkeep": "values",
    "errors": "values",
    "language": "values",
    "feature": "values",
    "distributions": "values",
}
"""The zone of a layer, by its first package; the layers of one zone follow each other."""

COLOURS: Mapping[str, tuple[str, str]] = {
    "people": ("#fdf0e3", "#c2621b"),
    "an exhibition": ("#fdf6dc", "#a27a10"),
    "the world and files": ("#e6f3ea", "#2f7d4f"),
    "values": ("#e9ebf8", "#4650a8"),
}
"""For each zone, the colour of its layers and the colour of their names."""

WIDTH, MARGIN, GAP, PADDING = 980, 28, 10, 10
SHAFT, LEGEND = 46, 116
"""The space for the arrow on the left, and for the zones' names on the right [px]."""
TOP, LINE, ALONE = 66, 15, 140
"""The top of the first layer, the height of a line, and the left edge of the purpose of a lone package [px]."""
FONT = "-apple-system, 'Segoe UI', Roboto, Helvetica, Arial, 'DejaVu Sans', sans-serif"
MONO = "ui-monospace, SFMono-Regular, Menlo, Consolas, 'DejaVu Sans Mono', monospace"


def floors(pyproject: str) -> list[list[str]]:
    """Return the packages of each layer of the import contract, the top layer first."""
    contracts = tomllib.loads(pyproject)["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if contract["type"] == "layers")
    return [[room.strip().removeprefix("lumen.") for room in layer.split("|")] for layer in layers]


def picture(house: Sequence[Sequence[str]]) -> str:
    """Return the layers as SVG; raise ValueError if PURPOSES and the contract do not name the same packages."""
    if differing := {room for floor in house for room in floor} ^ PURPOSES.keys():
        raise ValueError(f"the contract and PURPOSES differ in {', '.join(sorted(differing))}")
    drawn: list[str] = []
    y = TOP
    for zone, group in groupby(house, lambda floor: ZONES[floor[0]]):
        begin = y
        for floor in group:
            texts = [textwrap.wrap(PURPOSES[room], _signs(len(floor))) for room in floor]
            height = 46 if len(floor) == 1 else 2 * PADDING + 26 + LINE * max(map(len, texts))
            drawn += _floor(floor, texts, y, height, COLOURS[zone])
            y += height + GAP
        drawn += _zone(zone, begin, y - GAP)
    return _page(drawn, y - GAP)


def _signs(rooms: int) -> int:
    """Return the number of characters of a purpose that fit in a line."""
    return round((_room_width(rooms) - 2 * PADDING - (ALONE if rooms == 1 else 0)) / 6.1)


def _room_width(rooms: int) -> float:
    return (WIDTH - 2 * MARGIN - SHAFT - LEGEND - PADDING * (rooms + 1)) / rooms


def _floor(
    rooms: Sequence[str], texts: Sequence[Sequence[str]], y: float, height: float, colours: tuple[str, str]
) -> Iterator[str]:
    ground, ink = colours
    left, wide = MARGIN + SHAFT, _room_width(len(rooms))
    across = WIDTH - left - MARGIN - LEGEND
    yield f'<rect x="{left}" y="{y}" width="{across}" height="{height}" rx="9" fill="{ground}"/>'
    for i, (room, lines) in enumerate(zip(rooms, texts, strict=True)):
        x = left + PADDING + i * (wide + PADDING)
        yield (
            f'<rect x="{x:.1f}" y="{y + 7}" width="{wide:.1f}" height="{height - 14}" rx="6" fill="#ffffff"'
            f' stroke="{ink}" stroke-opacity="0.28"/>'
        )
        yield f'<text x="{x + 12:.1f}" y="{y + 28}" class="name" fill="{ink}">{escape(room)}</text>'
        right, down = (ALONE, 27.5) if len(rooms) == 1 else (12, 47)
        for n, line in enumerate(lines):
            yield f'<text x="{x + right:.1f}" y="{y + down + LINE * n}" class="purpose">{escape(line)}</text>'


def _zone(name: str, begin: float, end: float) -> Iterator[str]:
    """Draw a bracket beside the layers of a zone, and its name."""
    x, ink = WIDTH - MARGIN - LEGEND + 12, COLOURS[name][1]
    yield (
        f'<path d="M{x} {begin + 4} h5 v{end - begin - 8} h-5" fill="none" stroke="{ink}" stroke-width="1.6"'
        ' stroke-linejoin="round"/>'
    )
    yield f'<text x="{x + 14}" y="{(begin + end) / 2 + 4}" class="zone" fill="{ink}">{escape(name)}</text>'


def _page(drawn: Sequence[str], bottom: float) -> str:
    height = bottom + MARGIN
    x, middle = MARGIN + 16, (TOP + bottom) / 2
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}"'
            ' role="img" aria-labelledby="title">',
            '<title id="title">The floors of engine/lumen: each knows only those beneath it</title>',
            "<style>",
            f"text {{ font-family: {FONT} }}",
            f".name {{ font-family: {MONO}; font-size: 14.5px; font-weight: 600 }}",
            ".purpose { font-size: 11.5px; fill: #4a4f57 }",
            ".zone { font-size: 13px; font-style: italic }",
            ".head { font-size: 19px; font-weight: 600; fill: #23272e }",
            ".side { font-size: 12px; fill: #6b7078 }",
            "</style>",
            f'<rect width="{WIDTH}" height="{height}" rx="14" fill="#fcfcfa"/>',
            f'<text x="{MARGIN + SHAFT}" y="42" class="head">engine/lumen</text>',
            f'<text x="{WIDTH - MARGIN - LEGEND}" y="42" text-anchor="end" class="side">'
            "rooms on one floor do not know each other</text>",
            f'<path d="M{x} {TOP + 6} V{bottom - 8}" stroke="#9aa0a8" stroke-width="1.6" fill="none"/>',
            f'<path d="M{x - 5} {bottom - 14} l5 9 l5 -9" fill="none" stroke="#9aa0a8" stroke-width="1.6"'
            ' stroke-linejoin="round" stroke-linecap="round"/>',
            f'<text transform="translate({x - 8} {middle}) rotate(-90)" text-anchor="middle" class="side">'
            "imports only what is beneath</text>",
            *drawn,
            "</svg>\n",
        ]
    )


def main() -> None:
    house = floors((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    PICTURE.write_text(picture(house), encoding="utf-8")


if __name__ == "__main__":
    main()
