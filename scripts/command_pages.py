"""Write docs/commands/ from the parser of the command line: `python scripts/command_pages.py`.

Each verb has a page: its purpose, usage, words, options and examples, and the text of
`engine/lumen/cli/pages/VERB.md`.
"""

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from lumen.cli.main import command_line, subcommands
from lumen.cli.pages import page
from lumen.cli.suggesting import Suggesting

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs/commands"

INTRODUCTION = Path(__file__).with_suffix(".md")
"""The first page, up to its list of verbs."""


def written() -> dict[str, str]:
    """Return the pages of the docs, by file name."""
    parser = command_line(subcommands())
    index = "".join(f"- [`lumen {verb}`]({verb}.md): {row.summary}\n" for verb, row in subcommands().items())
    pages = {f"{verb}.md": _page(verb, parser.verbs[verb]) for verb in subcommands()}
    return {"README.md": INTRODUCTION.read_text(encoding="utf-8") + index, **pages}


def _page(verb: str, parser: Suggesting) -> str:
    found = page(verb)
    examples = "\n".join(f"| `{_cell(one.command)}` | {_cell(one.says)} |" for one in found.examples)
    blocks = [
        f"# lumen {verb}",
        parser.description or "",
        f"```text\n{_usage(parser)}\n```",
        f"## Examples\n\n| command | |\n| --- | --- |\n{examples}",
        *_table("Words", [action for action in parser._actions if not action.option_strings]),
        *_table("Options", [action for action in parser._actions if action.option_strings]),
        *([f"```text\n{parser.epilog}\n```"] if parser.epilog else []),
        *([found.text] if found.text else []),
    ]
    return "\n\n".join(blocks) + "\n"


def _usage(parser: argparse.ArgumentParser) -> str:
    """Return the usage as `--help` prints it, in lines whose width is independent of the terminal and of Python."""
    words, lines = [f"lumen {parser.prog.split()[-1]}"], []
    words += [_in_usage(action) for action in parser._actions if action.help is not argparse.SUPPRESS]
    line = words[0]
    for word in words[1:]:
        if len(line) + len(word) > 98:
            lines.append(line)
            line = " " * len(words[0])
        line += f" {word}"
    return "\n".join([*lines, line])


def _in_usage(action: argparse.Action) -> str:
    left_out = action.option_strings or action.nargs in ("?", "*")
    return f"[{_written(action)[-1]}]" if left_out else _word(action)


def _table(title: str, actions: list[argparse.Action]) -> Iterator[str]:
    rows = [
        f"| {', '.join(f'`{_cell(name)}`' for name in _written(action))} | {_cell(_help(action))} |"
        for action in actions
        if action.help is not argparse.SUPPRESS
    ]
    if rows:
        yield f"## {title}\n\n| | |\n| --- | --- |\n" + "\n".join(rows)


def _written(action: argparse.Action) -> list[str]:
    """Return the notations of an option or word, each with its value."""
    takes = "" if action.nargs == 0 else f" {_word(action)}"
    return [f"{name}{takes}" for name in action.option_strings] or [_word(action)]


def _word(action: argparse.Action) -> str:
    if isinstance(action.metavar, str):
        return action.metavar
    if action.choices is not None:
        return "{" + ",".join(map(str, action.choices)) + "}"
    return action.dest.upper() if action.option_strings else action.dest


def _help(action: argparse.Action) -> str:
    text = (action.help or "").replace("%%", "%")
    return re.sub(r"%\((\w+)\)s", lambda found: str(getattr(action, found[1])), text)


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def main() -> None:
    DOCS.mkdir(exist_ok=True)
    pages = written()
    for name, text in pages.items():
        (DOCS / name).write_text(text, encoding="utf-8")
    for stale in {file.name for file in DOCS.glob("*.md")} - pages.keys():
        (DOCS / stale).unlink()
    print(f"wrote {len(pages)} pages to {DOCS.relative_to(ROOT)}", file=sys.stderr)


if __name__ == "__main__":
    main()
