"""Which parts of an exhibition a process is to be."""

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.run.presence import ROBOT_PART, all_parts, roles


def parts_of(only: str | None, robot: str) -> tuple[str, ...]:
    """The parts that this process is to be; none where it is to be a whole exhibition. Raises UsageError."""
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
