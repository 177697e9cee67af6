"""What is to be read of a verb beside its options: `VERB.md` here, with examples first.

The indented lines on top are examples: a command, two spaces or more, what it does. What follows them stands in
`docs/commands/VERB.md` as it is; `## JSON` there says what `--format json` prints. `scripts/command_pages.py` writes
those pages, and `--help` shows the examples.
"""

import re
from importlib.resources import files
from typing import NamedTuple

_EXAMPLE = re.compile(r"(?m)^    (lumen .*?)  +(\S.*)\n")


class CommandExample(NamedTuple):
    """A command as it is typed, and what it does."""

    command: str
    says: str


class VerbPage(NamedTuple):
    """The examples of a verb, and what else is to be said in Markdown."""

    examples: tuple[CommandExample, ...]
    text: str


def page(verb: str) -> VerbPage:
    """The page of a verb; an empty one where nobody has written any."""
    file = files(__name__).joinpath(f"{verb}.md")
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    examples = tuple(CommandExample(*found) for found in _EXAMPLE.findall(text))
    return VerbPage(examples, _EXAMPLE.sub("", text).strip())
