"""The driver of a robot: a class in the project's drivers/NAME.py, or in an installed package as `package:Class`."""

import sys
from collections.abc import Callable, Mapping
from functools import wraps
from hashlib import sha256
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from inspect import getmembers, isabstract, isfunction
from pathlib import Path
from traceback import walk_tb
from types import ModuleType
from typing import Any

from lumen.errors import LumenError, RobotError, UsageError
from lumen.feature import described
from lumen.language.diagnostics import did_you_mean
from lumen.language.folders import DRIVERS_FOLDER
from lumen.language.projects import Project
from lumen.ports import Robot
from lumen.upkeep.arguments import missing_methods


def drivers_in(root: Path) -> dict[str, Path]:
    """Return the files of drivers/ in a project by name, except those whose names begin with `_`."""
    return {file.stem: file for file in sorted((root / DRIVERS_FOLDER).glob("*.py")) if not file.stem.startswith("_")}


def is_driver(name: str, root: Path) -> bool:
    """Return whether a name is a file of drivers/ or has the form `package:Class`."""
    return ":" in name or name in drivers_in(root)


def make_robot(driver: str, project: Project) -> Robot:
    """Return a new robot that a driver's class makes for the project.

    Raises UsageError if there is no such class, RobotError if the class fails or lacks a method of `lumen.ports.Robot`.
    """
    kind = robot_class(driver, Path(project.root))
    try:
        robot: Robot = _guarded(kind, driver)(project)
    except LumenError:
        raise
    except Exception as error:
        raise RobotError(f"the driver `{driver}` can't be used: {described(error)}{_line_of(error, kind)}") from error
    return robot


def robot_class(driver: str, root: Path) -> type:
    """Return the class of a driver. Raises UsageError or RobotError as `make_robot` does."""
    module, _, name = driver.partition(":")
    found = _imported(driver, module, root)
    if not name:
        return _only_robot(driver, found)
    kind = getattr(found, name, None)
    if not isinstance(kind, type):
        hint = did_you_mean(name, [each for each, value in vars(found).items() if isinstance(value, type)], "it has")
        raise UsageError(f"`{module}` has no class `{name}`: {hint}")
    _need_methods(driver, kind)
    return kind


def _guarded(kind: type, driver: str) -> type:
    """Return a subclass whose public methods turn any error of the driver into a RobotError with its line of code."""

    def named(name: str, method: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(method)
        def call(*arguments: Any, **options: Any) -> Any:
            try:
                return method(*arguments, **options)
            except LumenError:
                raise
            except Exception as error:
                what = f"the driver `{driver}` raised {described(error)} from `{name}`{_line_of(error, kind)}"
                raise RobotError(what) from error

        return call

    methods = {name: named(name, each) for name, each in getmembers(kind, isfunction) if not name.startswith("_")}
    return type(kind)(kind.__name__, (kind,), methods)


def fault_of(driver: str) -> Callable[[str], LumenError]:
    """Return a function that turns a description of a driver's fault into the error that ends the run."""
    return lambda what: RobotError(f"the driver `{driver}` {what}")


def _imported(driver: str, module: str, root: Path) -> ModuleType:
    files: Mapping[str, Path] = drivers_in(root)
    try:
        if ":" not in driver:
            if driver not in files:
                raise UsageError(f"no driver `{driver}`: {did_you_mean(driver, files, f'{DRIVERS_FOLDER}/ has')}")
            return _module_of(files[driver])
        return import_module(module)
    except LumenError:
        raise
    except SyntaxError as error:
        raise RobotError(f"{error.filename}:{error.lineno}: the driver `{driver}` can't be read: {error.msg}") from None
    except Exception as error:
        if isinstance(error, ModuleNotFoundError) and error.name in (module, module.partition(".")[0]):
            hint = "install the package into the environment of Lumen, or correct `driver` in lumen.yaml"
            raise UsageError(f"there is no package `{error.name}`: {hint}") from None
        raise RobotError(f"the driver `{driver}` can't be imported: {described(error)}{_last_line(error)}") from error


def _module_of(file: Path) -> ModuleType:
    """Import a file of a project, anew if it has changed.

    A hash of the path and the content in the module's name keeps files of the same name, and versions of one, apart.
    """
    hash = sha256(str(file.absolute()).encode() + file.read_bytes()).hexdigest()
    name = f"lumen_driver_{file.stem}_{hash[:8]}"
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, file)
    assert spec
    assert spec.loader  # a file that ends in .py always has a loader
    found = sys.modules[name] = module_from_spec(spec)
    try:
        spec.loader.exec_module(found)
    except BaseException:
        del sys.modules[name]
        raise
    return found


def _only_robot(driver: str, module: ModuleType) -> type:
    """Return the one class in a file with all methods of a robot. Raises RobotError if there is not exactly one."""
    own = [v for v in vars(module).values() if isinstance(v, type) and v.__module__ == module.__name__]
    robots = [kind for kind in own if not isabstract(kind) and not missing_methods(kind, Robot)]
    if len(robots) == 1:
        return robots[0]
    if robots:
        names = ", ".join(f"`{kind.__name__}`" for kind in robots)
        raise RobotError(f"{DRIVERS_FOLDER}/{driver}.py has several robots: {names}; leave one class in the file")
    nearest = min(own, key=lambda kind: len(missing_methods(kind, Robot)), default=None)
    if nearest is None:
        raise RobotError(f"{DRIVERS_FOLDER}/{driver}.py has no class; `lumen new robot NAME` writes an example")
    _need_methods(driver, nearest)
    return nearest


def _need_methods(driver: str, kind: type) -> None:
    if missing := missing_methods(kind, Robot):
        names = ", ".join(f"`{name}`" for name in missing)
        raise RobotError(f"the class `{kind.__name__}` of the driver `{driver}` is no robot: it lacks {names}")


def _line_of(error: BaseException, kind: type) -> str:
    """Return ` (FILE:LINE)` for the last frame of a traceback in the class's module; empty if there is none."""
    lines = [
        f"{frame.f_code.co_filename}:{line}"
        for frame, line in walk_tb(error.__traceback__)
        if frame.f_globals.get("__name__") == kind.__module__
    ]
    return f" ({lines[-1]})" if lines else ""


def _last_line(error: BaseException) -> str:
    frames = [(frame.f_code.co_filename, line) for frame, line in walk_tb(error.__traceback__)]
    return f" ({frames[-1][0]}:{frames[-1][1]})" if frames else ""
