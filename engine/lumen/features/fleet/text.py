"""The output of `lumen fleet status` and `lumen fleet log` as text."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.cli.tables import table
from lumen.language.counts import counted
from lumen.language.iso_time import iso_time

SHORT = 12


def fleet_lines(found: Mapping[str, Any]) -> Iterator[str]:
    """Yield lines about the rollout, its trials, each robot, and the centre's problems, from `Centre.overview`."""
    yield from _rollout(found["rollout"])
    yield from _trial(found["trying"])
    rows = [
        [
            f"{row['house']}/{row['name']}",
            row["bundle"][:SHORT] or "-",
            f"{row['state']}{', pinned' if row['pinned'] else ''}",
            row["since"] or "-",
            row["trouble"] or _outcome(row.get("tried"), found["trying"]),
        ]
        for row in found["robots"]
    ]
    yield table(("robot", "bundle", "state", "since", ""), rows)
    here, houses = sum(row["here"] for row in found["robots"]), len(found["houses"])
    yield f"{here} of {counted(len(rows), 'robot')} online, in {counted(houses, 'house')}"
    for name in ("trouble",):
        if found.get(name):
            yield f"!! {found[name]}"
    if found["centre"]["overruled"]:
        yield f"!! this centre gives no orders: {found['centre']['overruled']}"


def _trial(trying: Mapping[str, Any] | None) -> Iterator[str]:
    if trying is not None:
        counts = ", ".join(f"{name}: {count}" for name, count in trying.items() if name != "bundle")
        yield f"all robots try {trying['bundle'][:SHORT]} ({counts})"


def log_lines(found: Mapping[str, Any]) -> Iterator[str]:
    """Yield lines about the last incidents, the count of each kind, and the measures of each bundle."""
    for row in found["incidents"]:
        at = iso_time(row["at"], "seconds")
        yield f"{at}  {row['robot']}: {row['kind']}: {row['text']}"
    yield ", ".join(f"{kind}: {count}" for kind, count in found["kinds"].items()) or "no incidents"
    if found["numbers"]:
        names = sorted({name for row in found["numbers"] for name in row["measures"]})
        rows = [
            [row["bundle"][:SHORT], f"{row['robots']}", f"{row['hours']:.1f}"]
            + [f"{row['measures'][name]:.3g}" if name in row["measures"] else "-" for name in names]
            for row in found["numbers"]
        ]
        yield table(("bundle", "robots", "hours", *names), rows)


def _outcome(tried: Mapping[str, Any] | None, trying: Mapping[str, Any] | None) -> str:
    if not tried or not trying or tried["bundle"] != trying["bundle"]:
        return ""
    why = f": {tried['why']}" if tried["why"] else ""
    return f"tried: {tried['verdict']}, {tried['same']} of {tried['played']} visits unchanged{why}"


def _rollout(rollout: Mapping[str, Any] | None) -> Iterator[str]:
    if rollout is None:
        yield "no rollout"
        return
    reason = f": {rollout['reason']}" if rollout["reason"] else ""
    yield f"rollout of {rollout['bundle'][:SHORT]} is {rollout['state']}{reason}"
    for i, step in enumerate(rollout["steps"]):
        now = i == rollout["step"] and not step["done"] and rollout["tried"]
        watched = f", watched {rollout['watched'] / 60:.0f} of {rollout['pause'] / 60:.0f} min" if now else ""
        mark = "ok" if step["done"] else "->" if now else "  "
        yield f"{mark} {step['to']}: at most {counted(step['most'], 'robot')}{watched}"
