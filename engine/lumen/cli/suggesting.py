"""A command-line parser that suggests the nearest known word for an unknown one."""

import argparse
from collections.abc import Sequence
from typing import Any

from lumen.feature import found


class Suggesting(argparse.ArgumentParser):
    """Python's parser, with a suggestion for an unknown verb, option or choice."""

    @property
    def options(self) -> list[str]:
        """All options, such as `--strict` and `-o`."""
        return [word for action in self._actions for word in action.option_strings]

    @property
    def verbs(self) -> dict[str, "Suggesting"]:
        """The parsers of the verbs, by name; empty if the parser has none."""
        found = (action for action in self._actions if isinstance(action, argparse._SubParsersAction))
        return {name: parser for action in found for name, parser in action.choices.items()}

    def refuse(self, words: Sequence[str]) -> None:
        """Print an error with a suggestion for the first of these unrecognised words, and exit with 2."""
        word = next((word for word in words if word.startswith("-")), words[0])
        if not word.startswith("-"):
            self.error(f"unexpected word `{word}`")
        name = word.partition("=")[0]
        self.error(f"no option `{name}`{_meant(name, self.options)}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is None or value in action.choices:
            return
        if isinstance(action, argparse._SubParsersAction):
            raise argparse.ArgumentError(None, f"no verb `{value}`{_meant(value, action.choices)}{unusable()}")
        from lumen.language.diagnostics import did_you_mean  # only needed for a wrong choice

        hint = did_you_mean(value, map(str, action.choices), "choose one of")
        name = action.option_strings[-1] if action.option_strings else action.metavar or action.dest
        raise argparse.ArgumentError(
            None, f"invalid `{name} {value}`: {hint}" if action.option_strings else f"invalid {name} `{value}`: {hint}"
        )


def parse(parser: Suggesting, arguments: Sequence[str]) -> argparse.Namespace:
    """Return the parsed options. Exits with 2 if they are invalid, and with 0 after `--help`."""
    options, left = parser.parse_known_args(arguments)
    if left:
        parser.verbs[options.verb].refuse(left)
    return options


def unusable() -> str:
    """Return a remark that names the installed packages whose features can't be used; empty if there are none."""
    named = dict.fromkeys(str(each) for each, _ in found().faults if each not in found().installed.values())
    return f" (not loaded, because of faults that `lumen lint` reports: {', '.join(named)})" if named else ""


def _meant(word: str, known: Any) -> str:
    from lumen.language.diagnostics import nearest

    near = nearest(word, known)
    return f": did you mean `{near}`?" if near else "; --help lists them"
