"""The choice of the parts of an exhibition that a process runs."""

from collections.abc import Mapping

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.modules import ModuleSettings, own_modules
from lumen.run.presence import BRAIN, ROBOT_PART, all_parts, roles


def parts_of(only: str | None, robot: str, modules: Mapping[str, ModuleSettings]) -> tuple[str, ...]:
    """Return the parts that this process runs; none for a whole exhibition. Raises UsageError for an invalid choice.

    `only` has names separated by commas. `modules` are those of lumen.yaml; the programs of the project's own are
    parts, too.
    """
    if only is None:
        return tuple(part for part in roles() if part != ROBOT_PART) if robot == "remote" else ()
    parts = tuple(dict.fromkeys(word.strip() for word in only.split(",") if word.strip()))
    own = own_modules(modules)
    known = (*all_parts(), *own)
    for part in parts:
        if part not in known:
            raise UsageError(f"there is no part `{part}`: {did_you_mean(part, known, 'there are')}")
        if part in own and own[part].here and BRAIN not in parts:
            raise UsageError(
                f"the process of the brain starts `{part}` already, because lumen.yaml has `here: true`: delete that,"
                f" or leave out `--only {part}`"
            )
    if not parts:
        raise UsageError(f"--only must be one or more of {', '.join(known)}")
    if robot == "remote" and ROBOT_PART in parts:
        raise UsageError(
            "the robot can't be both local and remote: leave out --robot remote, or remove `robot` from --only"
        )
    return parts
