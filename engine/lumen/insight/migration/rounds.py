"""`for` through a list that a reload has changed: which entries of the new list those of the old one are."""

from collections.abc import Mapping
from typing import Any

from lumen.language.machines import ForEach, MachineDefinition

_LIST = "lists."


def carried_round(old: MachineDefinition, new: MachineDefinition, loop: ForEach, value: Mapping[str, Any]) -> Any:
    """What the key of a `for` holds under the new machine: the same entries as they are written now.

    One that is gone is not asked any more; the entry that is being asked stays, even so. Of another list than one under
    `lists` nothing is known, and nothing changes.
    """
    name = loop.each.source.strip().removeprefix(_LIST)
    before, after = list(old.lists.get(name, ())), list(new.lists.get(name, ()))
    if not loop.each.source.strip().startswith(_LIST) or before == after:
        return value
    entry, left = value.get("entry"), value.get("left")
    kept = [now for one in left or () if (now := _now(one, before, after)) is not None]
    return {"entry": _now(entry, before, after) or entry, "left": kept}


def _now(entry: Any, before: list[Any], after: list[Any]) -> Any:
    """An entry of the old list as the new one has it: unchanged wherever it stands, else what took its place."""
    if entry in after or entry not in before:
        return entry if entry in after else None
    place = before.index(entry)
    return after[place] if place < len(after) and after[place] not in before else None
