"""Findings about features of other installed packages that can't be used."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, redirect_stdout
from traceback import walk_tb
from typing import Any

from lumen.distributions import Distribution, distributions
from lumen.errors import LumenError, UsageError
from lumen.feature import Feature, FeatureFault, described, distribution_of, found, resolve
from lumen.language.diagnostics import WARNING, Code, Diagnostic, Place, Severity
from lumen.project.packaged import PACKAGE
from lumen.project.project_folders import MAIN_FILE

BROKEN_FEATURE = Code("broken-feature", "features", WARNING, "an installed feature, or a part of it, can't be used")


def broken_features() -> list[Diagnostic]:
    """Return a finding for each installed distribution whose feature, or a row of it, is ignored."""
    from lumen.project.added_verbs import faulty_verbs  # imports all of the expressions
    from lumen.project.feature_schemas import faulty_options

    rows = ((distribution_of(feature), fault) for feature, fault in (*faulty_verbs(), *faulty_options()))
    faults = [*found().faults, *(FeatureFault(distribution, fault) for distribution, fault in rows if distribution)]
    return [broken(fault.distribution, fault.message) for fault in faults]


def broken(distribution: Distribution, message: str) -> Diagnostic:
    """Return the finding about one distribution; `message` is the fault."""
    hint = f"update `{distribution.name}`, or remove it: pip uninstall {distribution.name}"
    text = f"the installed package `{distribution.name}` {distribution.version} is faulty: {message}"
    return BROKEN_FEATURE.at(Place(MAIN_FILE), text, hint, cause=distribution.name)


def resolved(feature: Feature, where: str) -> Any:
    """Return the object that an import string of a feature names.

    Raises LumenError with the name of the distribution if the import fails and the feature comes from another
    installed package. Errors of Lumen's own features are not caught.
    """
    with blaming(feature, where):
        return resolve(where)


def called(feature: Feature, where: str, *arguments: Any, **named: Any) -> Any:
    """Call the function that an import string of a feature names, and return its result.

    LumenErrors of the function are not caught. Any other error of a feature from another installed package becomes a
    LumenError with the name of the distribution.
    """
    function = resolved(feature, where)
    with blaming(feature, where, LumenError):
        return function(*arguments, **named)


def called_for_text(feature: Feature, where: str, *arguments: Any, **named: Any) -> str:
    """Return the result of `called`, which must be a text. Raises LumenError as `called` does, or for another type."""
    text = called(feature, where, *arguments, **named)
    if not isinstance(text, str):
        raise faulty(feature, f"`{where}` returned {shown(text)} instead of a text")
    return text


@contextmanager
def blaming(feature: Feature, where: str, *passed: type[Exception]) -> Iterator[None]:
    """Run code of an import string; raise LumenError with the name of the distribution for any fault of that code.

    Errors of Lumen's own features and of the types in `passed` are raised unchanged, and so is KeyboardInterrupt.
    """
    try:
        yield
    except KeyboardInterrupt:
        raise
    except passed:
        raise
    except BaseException as error:  # even SystemExit
        raise blamed(feature, where, error) from error


@contextmanager
def faults_reported(
    feature: Feature, what: str, report: Callable[[Diagnostic], object], *passed: type[Exception]
) -> Iterator[None]:
    """Run code of a feature; report a finding that names the distribution for any fault of that code.

    Errors of Lumen's own features and of the types in `passed` are raised unchanged, and so is KeyboardInterrupt.
    `what` names the code, such as "its rule `NAME`". What code of an installed package prints goes to standard error,
    since a program may read Lumen's standard output.
    """
    try:
        with redirect_stdout(sys.stderr) if distribution_of(feature) else nullcontext():
            yield
    except KeyboardInterrupt:
        raise
    except passed:
        raise
    except BaseException as error:  # even SystemExit
        if (distribution := distribution_of(feature)) is None:
            raise
        report(broken(distribution, f"{what} raised {described(error)}"))


@contextmanager
def faults_named(fault: Callable[[str], LumenError], method: str) -> Iterator[None]:
    """Run a method of an object that a package made; raise an error that names the package for any fault of the method.

    `fault` makes the error, from words such as "raised KeyError: 3 from `send`". LumenErrors are not caught.
    """
    try:
        yield
    except (LumenError, KeyboardInterrupt):
        raise
    except BaseException as error:  # even SystemExit
        named = fault_of_package(error)
        raise (LumenError(named) if named else fault(f"raised {described(error)} from `{method}`")) from error


def blamed(feature: Feature, where: str, error: BaseException) -> LumenError:
    """Return an error that names the distribution in whose module `error` was raised.

    Raises `error` itself if the feature comes with Lumen.
    """
    if distribution_of(feature) is None:
        raise error
    return faulty(feature, f"its module `{where}` raised {described(error)}")


def faulty(feature: Feature, message: str) -> LumenError:
    """Return an error about a fault of a feature; it names the distribution, if the feature was installed with one."""
    distribution = distribution_of(feature)
    if distribution is None:
        return LumenError(f"the feature `{feature.name}` is faulty: {message}")
    return LumenError(_sentence(distribution, message))


def shown(value: object) -> str:
    """Return the `repr` of a value for a message, cut if it is longer than 80 characters.

    If the `__repr__` of a package's object fails, the type is returned.
    """
    try:
        text = repr(value)
    except Exception:
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 80 else f"{text[:77]}…"


def is_finding(value: object) -> bool:
    """Return True if a value, added to a report by code of a package, is a finding that can be shown."""
    match value:
        case Diagnostic(str(), str(), Place(str(), int(), int(), int(), int()), str(), Severity(), tuple()):
            return True
    return False


def fault_of_package(error: BaseException) -> str:
    """Return a sentence about an error that code of an installed package with features raised; empty for other errors.

    The innermost call of Lumen's code or of such a package decides; calls of other modules are skipped.
    """
    found = _raiser(error)
    if not found:
        return ""
    distribution, module, line = found
    return _sentence(distribution, f"line {line} of `{module}` raised {described(error)}")


def package_at_fault(error: BaseException) -> Distribution | None:
    """Return the distribution that caused an error, as `fault_of_package` finds it; None if none did."""
    found = _raiser(error)
    return found[0] if found else None


def _raiser(error: BaseException) -> tuple[Distribution, str, int] | None:
    """Return the distribution, the module and the line that raised an error; None if no package with features did."""
    packages = _packages()
    for module, line in reversed(_calls(error)):
        package = module.partition(".")[0]
        if package == PACKAGE.name:
            return None
        if package in packages:
            return packages[package], module, line
    return None


def fault_of_subscriber(error: BaseException, pattern: str) -> str:
    """Return a sentence about a subscriber's error if it called an installed package with features; empty otherwise.

    The outermost call of such a package's code decides. `pattern` is the pattern of keys that it subscribed to.
    """
    packages = _packages()
    called = (packages.get(module.partition(".")[0]) for module, _ in _calls(error))
    distribution = next(filter(None, called), None)
    what = f"its subscriber of `{pattern}` raised {described(error)}"
    return _sentence(distribution, what) if distribution else ""


def _packages() -> dict[str, Distribution]:
    """Return the distributions that were installed beside Lumen, by the packages and modules that they contain."""
    return {package: each for each in distributions() for package in each.packages}


def _calls(error: BaseException) -> list[tuple[str, int]]:
    """Return the module and the line of each call that an error ended, the outermost first."""
    return [(frame.f_globals.get("__name__", ""), line) for frame, line in walk_tb(error.__traceback__)]


def _sentence(distribution: Distribution, message: str) -> str:
    """Return the fault of a distribution as a sentence, with advice in brackets."""
    finding = broken(distribution, message)
    return f"{finding.message} ({finding.hint})"


def need_made(feature: Feature, where: str, value: Any, kind: type, what: str) -> None:
    """Raise LumenError if `value`, made by the import string `where`, lacks a method of the protocol `kind`.

    `what` names the object in the message.
    """
    from lumen.upkeep.arguments import need_methods  # findings served from the cache need no interpreters

    try:
        need_methods(value, kind, what)
    except UsageError as error:
        raise faulty(feature, f"`{where}` made a wrong object: {error}") from None
