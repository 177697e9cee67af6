"""Every code that a finding can have, gathered from the modules that declare them beside their checks.

`grep -rn '"cut-short"' engine` finds a code's severity, summary and check; `pages/cut-short.md` says the rest.
"""

from collections.abc import Iterable, Mapping
from types import ModuleType

from lumen.interpreters.expressions import expression_findings
from lumen.language.diagnostics import Code
from lumen.loading import (
    actions,
    behaviors,
    bindings,
    bodies,
    broken_features,
    complaints,
    document,
    fleet,
    gestures,
    hears_keys,
    house,
    keyframes,
    knowledge,
    known_words,
    life,
    linking,
    markdown,
    messages,
    misplaced,
    numbers,
    outline,
    poses,
    project,
    role_names,
    roles,
    rounds,
    rulebook,
    schedules,
    settings,
    shapes,
    shared_keys,
    signal_bindings,
    terms,
    transitions,
    units,
    variables,
    yaml_errors,
    yaml_nodes,
    yaml_reader,
)  # fmt: skip
from lumen.rules import aims, ignores, lookups, on_request, routing_keys, rulebooks, surfaces
from lumen.rules import shapes as controller_shapes
from lumen.rules.checks import CHECKS

LOADERS = (
    actions, behaviors, bindings, bodies, broken_features, complaints, document, expression_findings, fleet, gestures,
    hears_keys, house, keyframes, knowledge, known_words, life, linking, markdown, messages, misplaced, numbers,
    outline, poses, project, role_names, roles, rounds, rulebook, schedules, settings, shapes, shared_keys,
    signal_bindings, terms, transitions, units, variables, yaml_errors, yaml_nodes, yaml_reader,
)  # fmt: skip
"""What reads files and declares codes."""

HELPERS = (aims, controller_shapes, ignores, lookups, on_request, routing_keys, rulebooks, surfaces)
"""What rules, or others, ask and what declares codes."""

FAMILY_ORDER = (
    "text", "shape", "references", "statecharts", "reload", "expressions", "hearing", "speech", "knowledge",
    "controllers", "motions", "physics", "robot", "routes", "alerts", "fleet", "features", "comments",
)  # fmt: skip
"""The families as they are listed: what is wrong with a file first."""


def _declared(modules: Iterable[ModuleType]) -> Mapping[str, Code]:
    codes = {value for module in modules for value in vars(module).values() if isinstance(value, Code)}
    return {code: code for code in sorted(codes, key=lambda code: (FAMILY_ORDER.index(code.family), code))}


CODES: Mapping[str, Code] = _declared((*LOADERS, *CHECKS, *HELPERS))
"""Every code by its name, by family and alphabet."""

FAMILIES: Mapping[str, Mapping[str, Code]] = {
    family: {code: code for code in CODES.values() if code.family == family} for family in FAMILY_ORDER
}
"""The codes of each family."""
