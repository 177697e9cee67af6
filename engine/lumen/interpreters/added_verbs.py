"""The durations of the verbs that features add."""

from collections.abc import Mapping

from lumen.errors import BadCommandError, ExpressionError
from lumen.interpreters.expressions import Scope, compile_template, split_template, substituted
from lumen.language.added_verbs import added_verbs
from lumen.language.commands import Do
from lumen.language.durations import seconds


def time_taken(command: Do) -> float:
    """Return how long a verb of a feature takes with its arguments [s].

    Raises BadCommandError if no feature here has the verb, or if `takes` of its row gives no duration.
    """
    if (row := added_verbs().get(command.skill)) is None:
        raise BadCommandError(f"no feature here has a verb `{command.skill}`")
    names = {name: f"context.{name}" for name in (*row.arguments.get("properties", ()), *command.arguments)}
    try:
        parts = split_template(row.takes)
        holes = [part if isinstance(part, str) else _hole(part.source, names) for part in parts]
        text = compile_template("".join(holes))(Scope(context=command.arguments))
    except ExpressionError as error:
        raise BadCommandError(f"how long `{command.skill}` takes is not known: {error}") from None
    if (found := seconds(text)) is None:
        raise BadCommandError(f"how long `{command.skill}` takes is not known: `{text}` is no duration such as `2s`")
    return found


def _hole(source: str, names: Mapping[str, str]) -> str:
    return "{{ " + substituted(source, names, localized=False) + " }}"
