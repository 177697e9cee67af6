"""The choice of the parts of an exhibition that a process runs."""

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.run.presence import ROBOT_PART, all_parts, roles


def parts_of(only: str | None, robot: str) -> tuple[str, ...]:
    """Return the parts that this process runs, none for a whole exhibition. Raises UsageError for an invalid choice."""
    if only is None:
        return tuple(part for part in roles() if part != ROBOT_PART) if robot == "remote" else ()
    parts = tuple(dict.fromkeys(word.strip() for word in only.split(",") if word.strip()))
    known = all_parts()
    for part in parts:
        if part not in known:
            raise UsageError(f"there is no part `{part}`: {did_you_mean(part, known, 'there are')}")
    if not parts:
        raise UsageError(f"--only must be one or more of {', '.join(known)}")
    if robot == "remote" and ROBOT_PART in parts:
        raise UsageError(
            "the robot can't be both local and remote: leave out --robot remote, or remove `robot` from --only"
        )
    return parts
