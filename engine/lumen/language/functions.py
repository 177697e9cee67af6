"""A function of the project, `functions/NAME.yaml`: a named expression of its arguments."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.diagnostics import NodePath


@dataclass(frozen=True, slots=True)
class FunctionExample:
    """A call that `lumen test` checks."""

    arguments: Mapping[str, Any]
    """The JSON value of each argument."""
    value: Any
    """The value that the function must return."""
    where: NodePath = field(default=(), compare=False)
    """The path of the example in its file."""


@dataclass(frozen=True, slots=True)
class FunctionDefinition:
    """The content of a file of functions/."""

    name: str
    """The name of the file, by which expressions call it."""
    parameters: Mapping[str, tuple[str, ...]]
    """The kinds of values that each argument accepts, such as `("text", "number")`, in the order of a call."""
    returns: tuple[str, ...]
    """The kinds of values that the function returns."""
    description: Mapping[str, str]
    """The description by language, `""` for any language."""
    expression: str
    """The expression as the author wrote it."""
    expanded: str
    """The expression with all calls of the project's functions replaced by their own expressions."""
    examples: tuple[FunctionExample, ...] = ()

    @property
    def signature(self) -> str:
        """The function's name with its arguments, as in a call: `greeting(name, hour)`."""
        return f"{self.name}({', '.join(self.parameters)})"

    def described(self, language: str) -> str:
        """Return the description in a language, else in English or the first one; empty if there are no texts."""
        texts = self.description
        return texts.get(language) or texts.get("") or texts.get("en") or next(iter(texts.values()), "")
