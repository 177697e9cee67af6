"""The command line: what each subcommand accepts, its help, and how a table of calls ends.

`accepted.json` holds options and choices, `codes.json` exit codes, `help/` the words of `--help` at 100 columns and
`calls/` what is printed, files of `-o` included. The help is laid out by argparse, of Python 3.11 and 3.12.
"""

import argparse
import re
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from tests.golden.adapters_language import options, table, verbs
from tests.golden.command_line import Outcome, lumen, workplace
from tests.golden.found import write_json
from tests.golden.golden import HERE, PROJECTS, SHIPPED

SUITE = "rest"  # some calls start a program, such as git
TOOK = re.compile(r'("took": |time=")[0-9.e-]+|\b[0-9.]+ s(?= of this machine)|(?<=in )[0-9.]+ s\b')
"""Real time that a call took, which no recording can hold."""
BROKEN = {
    "lumen.yaml": [("story: visitor", "story: visiter")],
    "behaviors/hello.yaml": [("on:", "onn:")],
}
CHART = """<scxml xmlns="http://www.w3.org/2005/07/scxml" initial="a">
  <state id="a"><transition event="go" target="b"/></state>
  <state id="b"><invoke type="x-other" src="x"/></state>
</scxml>
"""


def record(folder: Path) -> None:
    """Write the options of the parsers, their help, and the outcome of each call."""
    parsers = verbs()
    write_json(folder / "accepted.json", {name: list(map(_accepted, options(one))) for name, one in parsers.items()})
    with workplace() as work:
        _prepare(work)
        _record_help(folder / "help", work, parsers)
        write_json(folder / "codes.json", _record_calls(folder / "calls", work, _calls(parsers)))


def _record_help(folder: Path, work: Path, verbs: Iterable[str]) -> None:
    folder.mkdir()
    for verb in verbs:
        words = () if verb == "lumen" else (verb,)
        (folder / f"{verb}.txt").write_text(str(lumen(work, *words, "--help")), "utf-8")


def _record_calls(folder: Path, work: Path, calls: Mapping[str, Iterable[Mapping[str, str]]]) -> dict[str, int]:
    """Write how each call ends, and return the exit codes."""
    codes: dict[str, int] = {}
    folder.mkdir()
    for verb, rows in calls.items():
        texts = []
        for row in rows:
            told, outcome, made = _call(work, row)
            assert told not in codes, f"{told} is twice in the table"
            codes[told] = outcome.code
            texts += [f"$ {told}\n{TOOK.sub(_hidden, str(outcome))}", *(f"--- {name}\n{text}" for name, text in made)]
        (folder / f"{verb}.txt").write_text("\n".join(texts), "utf-8")
    return codes


def _prepare(work: Path) -> None:
    """Make the folder in which calls are typed."""
    for name in SHIPPED:
        shutil.copytree(PROJECTS / name, work / name)
    shutil.copytree(PROJECTS / "minimal", work / "broken")
    for name, edits in BROKEN.items():
        file = work / "broken" / name
        text = file.read_text("utf-8")
        for old, new in edits:
            assert old in text, f"{old!r} is not in {name}"
            text = text.replace(old, new, 1)
        file.write_text(text, "utf-8")
    (work / "empty").mkdir()
    (work / "empty.json").write_text("", "utf-8")
    (work / "chart.scxml").write_text(CHART, "utf-8")


def _calls(parsers: dict[str, argparse.ArgumentParser]) -> dict[str, list[dict[str, str]]]:
    """Return the calls of the table by subcommand, and those that are wrong for each of them."""
    calls = {verb: list(rows) for verb, rows in table(HERE / "invocations.yaml").items()}
    assert calls.keys() == parsers.keys(), sorted(calls.keys() ^ parsers.keys())
    for verb, rows in calls.items():
        if verb != "lumen":
            rows += [{"words": f"{verb} --frobnicate"}, {"words": f"{verb} --formt json"}]
            rows += [{"words": f"{verb} --format yaml"}] if "--format" in _option_strings(parsers[verb]) else []
    return calls


def _call(work: Path, row: Mapping[str, str]) -> tuple[str, Outcome, list[tuple[str, str]]]:
    """Return the call as it was typed, its outcome, and the new files that are pictures or diagrams."""
    before = set(work.iterdir())
    outcome = lumen(work / row.get("in", "."), *row["words"].split(), base=work, typed=row.get("typed", ""))
    made = [file for file in sorted(set(work.iterdir()) - before) if file.suffix in (".svg", ".dot")]
    where = f"{row['in']}: " if "in" in row else ""
    return f"{where}lumen {row['words']}".rstrip(), outcome, [(file.name, file.read_text("utf-8")) for file in made]


def _hidden(found: re.Match[str]) -> str:
    return f"{found[1] or ''}TIME"


def _option_strings(parser: argparse.ArgumentParser) -> set[str]:
    return {word for action in options(parser) for word in action.option_strings}


def _accepted(action: argparse.Action) -> dict[str, Any]:
    """Return the properties that a program could rely on; the words of help are in help/."""
    found = {
        "options": list(action.option_strings),
        "metavar": action.metavar,
        "nargs": action.nargs,
        "choices": None if action.choices is None else list(map(str, action.choices)),
        "default": None if action.default in (None, argparse.SUPPRESS) else str(action.default),
        "required": action.required,
        "into": action.dest,
    }
    return {name: value for name, value in found.items() if value not in (None, [], False)}
