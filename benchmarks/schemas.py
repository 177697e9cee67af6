"""Measure the cost of checking data against a JSON Schema, in Lumen and in other validators, in µs of CPU time.

    python benchmarks/schemas.py [--rounds N]

For each kind of file, it measures compiling the schema and checking all shipped files of that kind. Then it measures
the bodies of messages, from the position of a face to a camera image, and the explanation of an error. Figures are
medians of several rounds, in which the validators take turns. `fastjsonschema` is measured if it is installed.
"""

import argparse
import json
import platform
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from statistics import geometric_mean
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzzy import processor
from patterns import importable, imports, measured

from lumen.bus.checking import SchemaCheck
from lumen.expressions.json_schema import JsonSchema
from lumen.project.files import read_files
from lumen.project.project_folders import file_kinds, kind_of
from lumen.project.schema import load_schema
from lumen.project.yaml_reader import parse

Schema = Mapping[str, Any]
Fits = Callable[[Any], object]
Makers = Mapping[str, Callable[[Any], Fits]]

ROOT = Path(__file__).parents[1]
JOINTS = [f"Joint{number}" for number in range(26)]
BODIES: list[tuple[str, Any]] = [
    ("face.detection", {"x": 160, "y": 120, "time": 12.5}),
    ("sonar", {"rightSensor": 0.5, "leftSensor": 2.55}),
    ("command", {"type": "motion", "method": "moveTo", "parameter": {"x": 0.2, "y": 0, "tetha": 0}}),
    ("speech.recognition", {"name": "speech", "result": "Could you dance for me? " * 6, "date": "2015-06-01"}),
    ("joint", {"name": JOINTS, "angle": [0.1 * n for n in range(26)], "stiffness": [1.0] * 26}),
    ("image", {"name": "1", "contentType": "image/jpeg", "contentUrl": "data:image/jpeg;base64," + "A" * 15_000}),
]
WRONG = {"x": "left", "y": 120}


def by_jsonschema(schema: Any) -> Fits:
    """Return jsonschema's check of a schema."""
    from jsonschema import Draft202012Validator

    return Draft202012Validator(schema).is_valid


def by_jsonschema_rs(schema: Any) -> Fits:
    """Return jsonschema-rs's check of a schema."""
    from jsonschema_rs import Draft202012Validator, RegexOptions

    return Draft202012Validator(schema, pattern_options=RegexOptions()).is_valid


def by_fastjsonschema(schema: Any) -> Fits:
    """Return fastjsonschema's check of a schema."""
    import fastjsonschema

    return fastjsonschema.compile(schema)  # type: ignore[no-any-return]


def by_lumen(schema: Any) -> Fits:
    """Return Lumen's check of a schema."""
    fits = JsonSchema(schema).fits
    fits(None)  # the first call compiles it
    return fits


VALIDATORS: dict[str, tuple[Callable[[Any], Fits], str]] = {
    "Lumen": (by_lumen, "import lumen.expressions.json_schema"),
    "jsonschema-rs": (by_jsonschema_rs, "import jsonschema_rs"),
    "jsonschema": (by_jsonschema, "import jsonschema"),
    "fastjsonschema": (by_fastjsonschema, "import fastjsonschema"),
}
"""The function that compiles a schema, and the import that it needs."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    makers = {name: make for name, (make, needs) in VALIDATORS.items() if importable(needs)}
    print(f"Python {platform.python_version()}, {platform.machine()}, {processor()}; CPU time, median of {rounds}")
    needs = {name: VALIDATORS[name][1] for name in makers}
    print(f"\nimporting it, ms beyond Python itself: {imports(needs, rounds)}")
    compiled, checked = files(makers, rounds)
    bodies = messages(makers, rounds)
    print("\nit takes Lumen's time so many times, geometric mean:")
    for name in makers:
        if name != "Lumen":
            ratios = (f"{geometric_mean(of[name]):.1f} x" for of in (compiled, checked, bodies))
            print(f"  {name:16} {', '.join(map('{} {}'.format, ('compiling', 'files', 'bodies'), ratios))}")
    explaining(rounds)
    return 0


def files(makers: Makers, rounds: int) -> tuple[dict[str, list[float]], dict[str, list[float]]]:
    """Return the times relative to Lumen of compiling schemas of files, and of checking all shipped files of a kind."""
    documents: dict[str, list[Any]] = {kind: [] for kind in file_kinds()}
    for file, content in read_files(ROOT).items():
        kind = kind_of(file)
        document = parse(file, content)[0] if kind else None
        if document:
            documents[kind].append(document.data)
    compiling: dict[str, list[float]] = {name: [] for name in makers}
    checking: dict[str, list[float]] = {name: [] for name in makers}
    print(f"\n{'ms: compiling, all the files':32}" + "".join(f"{name:>20}" for name in makers))
    for kind, data in documents.items():
        schema = load_schema(kind)
        able = {name: make(schema) for name, make in makers.items()}
        made = measured({name: partial(make, schema) for name, make in makers.items()}, rounds)
        took = measured({name: partial(each, fits, data) for name, fits in able.items()}, rounds)
        cells = "".join(f"{1e3 * made[name]:12.2f}{1e3 * took[name]:8.2f}" for name in makers)
        print(f"  {kind:12}{len(data):3} files{'':9}{cells}")
        for name in makers:
            compiling[name].append(made[name] / made["Lumen"])
            checking[name].append(took[name] / took["Lumen"])
    return compiling, checking


def each(fits: Fits, data: list[Any]) -> None:
    """Check each of the data."""
    for one in data:
        fits(one)


def messages(makers: Makers, rounds: int) -> dict[str, list[float]]:
    """Return the times relative to Lumen of checking bodies."""
    ratios: dict[str, list[float]] = {name: [] for name in makers}
    print(f"\n{'µs: a body that fits':32}" + "".join(f"{name:>20}" for name in makers))
    for message, body in BODIES:
        schema = message_schema(message)
        took = measured({name: partial(make(schema), body) for name, make in makers.items()}, rounds)
        cells = "".join(f"{1e6 * took[name]:20.2f}" for name in makers)
        print(f"  {message:20}{len(json.dumps(body)):6,} B{'':2}{cells}")
        for name in makers:
            ratios[name].append(took[name] / took["Lumen"])
    return ratios


def explaining(rounds: int) -> None:
    """Measure the explanation of an invalid body."""
    from jsonschema import Draft202012Validator

    schema = message_schema("face.detection")
    alone = Draft202012Validator(schema)
    check = SchemaCheck(schema)
    work = {"Lumen": partial(check, WRONG), "jsonschema": lambda: next(alone.iter_errors(WRONG)).message}
    took = measured(work, rounds)
    print(f"\nµs: saying that {check(WRONG)!r}: " + ", ".join(f"{name} {1e6 * took[name]:.1f}" for name in work))


def message_schema(name: str) -> Any:
    """Return the schema of a message."""
    return json.loads((ROOT / "schemas/messages" / f"{name}.schema.json").read_text(encoding="utf-8"))


if __name__ == "__main__":
    sys.exit(main())
