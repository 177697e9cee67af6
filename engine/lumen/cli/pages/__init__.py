"""The help page of each verb without its options, `VERB.md` in this folder.

The indented lines at the top are examples: a command, two or more spaces, and its effect. `--help` shows them.
`scripts/command_pages.py` copies the text after them to `docs/commands/VERB.md`. A section `## JSON` in it describes
the output of `--format json`.
"""

import re
from importlib.resources import files
from typing import NamedTuple

_EXAMPLE = re.compile(r"(?m)^    (lumen .*?)  +(\S.*)\n")


class CommandExample(NamedTuple):
    """A command as it is typed, and its effect."""

    command: str
    says: str


class VerbPage(NamedTuple):
    """The examples of a verb, and the rest of its page in Markdown."""

    examples: tuple[CommandExample, ...]
    text: str


def page(verb: str) -> VerbPage:
    """Return the page of a verb; it is empty if there is no `VERB.md`."""
    file = files(__name__).joinpath(f"{verb}.md")
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    examples = tuple(CommandExample(*found) for found in _EXAMPLE.findall(text))
    return VerbPage(examples, _EXAMPLE.sub("", text).strip())
