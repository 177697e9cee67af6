"""Fuzzy controllers from files and dicts: evaluate them, and explain the result; `lumen.fuzzy` offers the class."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from lumen.errors import ProjectError
from lumen.fuzzy.evaluator import Evaluator
from lumen.fuzzy.explanation import Explanation, explain
from lumen.language.controllers import ControllerDefinition
from lumen.language.diagnostics import has_errors
from lumen.project.controllers import build_controller
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.plain import derived, read_document
from lumen.project.schema import check_schema
from lumen.upkeep.arguments import need, need_map, need_numbers, need_path, need_text

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class Controller(ControllerDefinition):
    """A fuzzy controller to evaluate; it is compiled at the first evaluation."""

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the controller in a file; raise UsageError if it can't be read, ProjectError if it has mistakes."""
        path = need_path(path)
        return cls._build(read_document(path), path.stem)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], name: str = "controller") -> Self:
        """Return the controller in a dict with the structure of a file; raise ProjectError if it has mistakes."""
        need_text(name, "the name of a controller")
        need_map(data, "the data of a controller")
        return cls._build(Document(name, data), name)

    @classmethod
    def _build(cls, document: Document, name: str) -> Self:
        report = DocumentReport(document)
        controller = build_controller(check_schema(document, "controller", report), report, name=name)
        if controller is None or has_errors(report.diagnostics):
            raise ProjectError(report.diagnostics)
        return derived(cls, controller)

    @cached_property
    def _evaluator(self) -> Evaluator:
        return Evaluator(self)

    def evaluate(self, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None) -> dict[str, float]:
        """Return all outputs, in the file's units; outputs with `lock-previous` use the values in `previous`.

        Raises UsageError for a missing, unknown or NaN input, LumenError if no rule fires and there is no default.
        """
        if previous is not None:
            need_numbers(previous, "`previous`")
        return self._evaluator.evaluate(inputs, previous)

    def evaluate_batch(
        self, inputs: "Mapping[str, ArrayLike]", previous: Mapping[str, float] | None = None
    ) -> "dict[str, NDArray[np.float64]]":
        """Return all outputs for inputs of shape (n,) each: arrays of shape (n,). Raises as `evaluate` does."""
        need(inputs, Mapping, "`inputs`", "a map of arrays")
        if previous is not None:
            need_numbers(previous, "`previous`")
        return self._evaluator.evaluate_batch(inputs, previous)

    def explain(self, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None) -> Explanation:
        """Return memberships, each rule's degree, the concluded sets and the outputs, for these inputs."""
        need_numbers(inputs, "`inputs`")
        if previous is not None:
            need_numbers(previous, "`previous`")
        return explain(self._evaluator, inputs, previous)
