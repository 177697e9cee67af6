"""All features: the manifests that come with Lumen and those of installed packages, and their rows."""

import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import redirect_stdout
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

from lumen.distributions import Distribution, distributions
from lumen.feature.checking import kinds, ordered, wrong_rows
from lumen.feature.manifest import API, Feature

BUILT_IN = (
    "lumen.features.core:FEATURE",
    "lumen.features.expressions:FEATURE",
    "lumen.features.simulation:FEATURE",
    "lumen.features.naoqi:FEATURE",
    "lumen.features.reachy:FEATURE",
    "lumen.features.robots:FEATURE",
    "lumen.features.senses:FEATURE",
    "lumen.features.memory_bus:FEATURE",
    "lumen.features.rabbitmq:FEATURE",
    "lumen.features.visitors:FEATURE",
    "lumen.features.eyes:FEATURE",
    "lumen.features.ears:FEATURE",
    "lumen.features.voice:FEATURE",
    "lumen.features.social:FEATURE",
    "lumen.features.alerts:FEATURE",
    "lumen.features.show:FEATURE",
    "lumen.features.answers:FEATURE",
    "lumen.features.skills:FEATURE",
    "lumen.features.journal:FEATURE",
    "lumen.features.mcap:FEATURE",
    "lumen.features.reload:FEATURE",
    "lumen.features.console:FEATURE",
    "lumen.features.editor:FEATURE",
    "lumen.features.fleet:FEATURE",
    "lumen.features.formats_charts:FEATURE",
    "lumen.features.formats_motion:FEATURE",
    "lumen.features.formats_fuzzy:FEATURE",
    "lumen.features.formats_robots:FEATURE",
    "lumen.features.formats_routes:FEATURE",
)
"""The manifests that come with Lumen, as import strings, in the order of their rows."""


class FeatureFault(NamedTuple):
    """The reason why a feature of an installed distribution, or a row of it, is ignored."""

    distribution: Distribution
    message: str


class Found(NamedTuple):
    """All features, and the faults found in their manifests."""

    features: tuple[Feature, ...]
    """The manifests, those that come with Lumen first."""
    installed: Mapping[str, Distribution]
    """The distributions of the features that do not come with Lumen, by the feature's name."""
    faults: tuple[FeatureFault, ...]


def resolve(where: str) -> Any:
    """Return the object of an import string: a module, or with `:NAME` an object of it.

    Raises ImportError if there is no such module, AttributeError if the module has no such object.
    """
    module, _, name = where.partition(":")
    found = import_module(module)
    return getattr(found, name) if name else found


def features() -> tuple[Feature, ...]:
    """Return the manifests of all features, those that come with Lumen first."""
    return found().features


def rows(kind: str) -> Iterator[tuple[Feature, Any]]:
    """Yield the rows of a kind, such as `extras`, each with its feature.

    If the kind is a mapping, a row is a pair (name, value). Of two rows with the same name, the second is left out.
    """
    names: set[str] = set()
    for feature in features():
        rows_of = getattr(feature, kind)
        if isinstance(rows_of, Mapping):
            yield from ((feature, row) for row in rows_of.items() if row[0] not in names)
            names.update(rows_of)
        else:
            yield from ((feature, row) for row in rows_of)


@cache
def table(kind: str) -> Mapping[str, Any]:
    """Return the rows of a kind by name. The kind must be a mapping."""
    return {name: row for _, (name, row) in rows(kind)}


@cache
def owner(kind: str, name: str) -> Feature:
    """Return the feature that has the row of this name; `kind` must be a mapping with such a row."""
    return next(feature for feature, (key, _) in rows(kind) if key == name)


def distribution_of(feature: Feature) -> Distribution | None:
    """Return the distribution that a feature was installed with; None if it comes with Lumen."""
    return found().installed.get(feature.name)


@cache
def found() -> Found:
    """Return all features, and the faults of those that do not come with Lumen. A faulty feature is left out."""
    built_in = tuple(resolve(where) for where in BUILT_IN)
    others: dict[str, tuple[Feature, Distribution]] = {}
    faults: list[FeatureFault] = []
    names = {feature.name: "Lumen" for feature in built_in}
    for distribution in distributions():
        feature, fault = _manifest(distribution)
        if feature and feature.name in names:
            fault = f"its feature has the name `{feature.name}`, as one of {names[feature.name]} has"
        elif feature and not fault:
            fault = _unordered([*built_in, *(other for other, _ in others.values()), feature])
        if feature and not fault:
            names[feature.name] = str(distribution)
            others[feature.name] = feature, distribution
        else:
            faults.append(FeatureFault(distribution, fault))
    features = (*built_in, *(feature for feature, _ in others.values()))
    installed = {name: distribution for name, (_, distribution) in others.items()}
    return Found(features, installed, (*faults, *(_repeated(features, installed) if installed else ())))


def _manifest(distribution: Distribution) -> tuple[Feature | None, str]:
    """Return the feature of a distribution, and the first fault of its manifest; no feature if it can't be read."""
    try:
        with redirect_stdout(sys.stderr):  # standard output may be JSON that a program reads
            feature = resolve(distribution.manifest)
        if not isinstance(feature, Feature):
            return None, f"its entry point names `{distribution.manifest}`, which is no `Feature`"
        if feature.api != API:
            return None, f"its manifest is written for API {feature.api!r}, and this Lumen has API {API}"
        return feature, next(wrong_rows(feature), "")
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # from code that is not Lumen's: even SystemExit
        return None, f"its manifest `{distribution.manifest}` raised {described(error)}"


def _unordered(features: Iterable[Feature]) -> str:
    """Return the fault of the last of these features if it makes parts wait for each other; empty otherwise."""
    try:
        ordered(row for feature in features for row in feature.parts)
    except ValueError as error:
        return f"its {error}"
    return ""


def described(error: BaseException) -> str:
    """Return the type and the message of an error, such as `KeyError: 'name'`; the type alone if `str` fails."""
    try:
        return f"{type(error).__name__}: {error}"
    except Exception:  # raised by the `__str__` of a package's error
        return type(error).__name__


def _repeated(features: tuple[Feature, ...], installed: Mapping[str, Distribution]) -> Iterator[FeatureFault]:
    """Yield a fault for each row that is left out because an earlier feature has one of that name."""
    owners: dict[tuple[str, str], str] = {}
    for feature in features:
        distribution = installed.get(feature.name)
        for kind in kinds():
            named = getattr(feature, kind)
            for name in named if isinstance(named, Mapping) else ():
                owner = owners.setdefault((kind, name), feature.name)
                if distribution and owner != feature.name:
                    yield FeatureFault(
                        distribution, f"its row `{name}` of `{kind}` is ignored: the feature `{owner}` has that name"
                    )
