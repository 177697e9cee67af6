"""Scripts that do no more than `<assign>` could."""

import re

_STATEMENT = re.compile(
    r"(?P<name>[A-Za-z_$][\w$]*)\s*(?:(?P<sign>[-+*/%]?)=(?!=)(?P<value>.+)|(?P<step>\+\+|--))", re.DOTALL
)


def assignments(source: str) -> list[tuple[str, str]] | None:
    """The names and values of `x = 1; y += x; z++`, in order; None where the script does anything else."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", source, flags=re.DOTALL)
    if "'" in text or '"' in text:
        return None
    found = []
    for statement in filter(None, map(str.strip, text.split(";"))):
        match = _STATEMENT.fullmatch(statement)
        if match is None:
            return None
        name, value = match["name"], match["value"]
        if match["step"]:
            value = f"{name} {match['step'][0]} 1"
        elif match["sign"]:
            value = f"{name} {match['sign']} ({value})"
        found.append((name, value.strip()))
    return found
