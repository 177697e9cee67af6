"""Code of the project that lumen.yaml names: the programs of its modules, and the robot's driver."""

from lumen.feature import rows
from lumen.language.diagnostics import ERROR, WARNING, Code, did_you_mean
from lumen.language.folders import DRIVERS_FOLDER
from lumen.language.modules import own_modules
from lumen.lint.events import BUILT_IN_FAMILIES
from lumen.project.draft import ProjectDraft
from lumen.project.files import on_disk

BAD_MODULE = Code("bad-module", "routes", ERROR, "a module of the project's own can't have this name or setting")
MISSING_PROGRAM = Code("missing-program", "routes", WARNING, "the program of a module is not in the project")

MISSING_DRIVER = Code("missing-driver", "robot", ERROR, "the driver of the robot is not in the project")

_SCRIPTS = (".py", ".js", ".mjs", ".ts", ".sh", ".rb", ".pl", ".lua", ".jar")
SHORTEST_HEALTH = 1.0
"""The shortest interval between two signs of life that can be monitored [s]: programs send two a second."""


def check(draft: ProjectDraft) -> None:
    """Report names that clash with events, too frequent signs of life, and missing programs and drivers."""
    if draft.settings is None or draft.main is None:
        return
    _driver(draft)
    parts = {role for _, role in rows("roles")}
    families = {family.rstrip(".") for family in BUILT_IN_FAMILIES} | {"battery", "motors", "head"}
    for name, module in own_modules(draft.settings.modules).items():
        where = ("modules", name)
        if name in parts or name in families:
            message = f"a module can't be called `{name}`: Lumen has events that begin with `{name}.`"
            draft.main(BAD_MODULE, where, message, "choose another name", key=True)
        elif not name.replace("-", "_").isidentifier():
            message = f"a module can't be called `{name}`: its events begin with its name"
            hint = "write a name of letters, digits, `_` and `-` that begins with a letter"
            draft.main(BAD_MODULE, where, message, hint, key=True)
        if 0 < module.health < SHORTEST_HEALTH:
            message = f"`health` of `{name}` is {module.health:g} s, but signs of life come twice a second at most"
            draft.main(BAD_MODULE, (*where, "health"), message, "write at least `1s`; `5s` is usual")
        _program(draft, name, module.command)


def _driver(draft: ProjectDraft) -> None:
    """Report a driver that is missing in drivers/; a driver in a package is not imported here."""
    if draft.root is None or draft.main is None or draft.settings is None:
        return
    own = draft.settings.robots.get(draft.settings.robot)
    if own is None or not own.driver or ":" in own.driver:
        return
    folder = draft.root / DRIVERS_FOLDER
    draft.looks.at(folder)
    names = [file.stem for file in folder.glob("*.py")]
    if own.driver not in names:
        message = f"there is no {DRIVERS_FOLDER}/{own.driver}.py"
        hint = did_you_mean(own.driver, names, f"{DRIVERS_FOLDER}/ has") if names else ""
        hint = hint or f"`lumen new robot {own.driver}` writes one; a class of a package is `package:Class`"
        draft.main(MISSING_DRIVER, ("robot", "driver"), message, hint)


def _program(draft: ProjectDraft, name: str, command: tuple[str, ...]) -> None:
    """Report a script, or a program given by a path, that is missing in the project."""
    if draft.root is None or draft.main is None:
        return
    for i, word in enumerate(command):
        named = "/" in word if i == 0 else word.endswith(_SCRIPTS) and not word.startswith("-")
        if not named or word.startswith("/"):
            continue
        path = on_disk(draft.root, word)
        draft.looks.at(path)
        if not path.exists():
            message = f"the project has no file `{word}`, which the module `{name}` runs"
            hint = f"write the program, or correct the path; `lumen new module {name}` writes one"
            draft.main(MISSING_PROGRAM, ("modules", name, "command", i), message, hint)
            return
