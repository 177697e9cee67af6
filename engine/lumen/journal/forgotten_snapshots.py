"""Removes a visitor's name from a snapshot, while it runs and in its written form."""

from collections.abc import Mapping
from typing import Any

from lumen.language.machines import MachineDefinition
from lumen.language.people import PersonName
from lumen.statechart import Snapshot
from lumen.statechart.type_checks import fits, type_checks


def forgetful(machine: MachineDefinition, snapshot: Snapshot, person: PersonName) -> Snapshot:
    """Return the snapshot without the name in its context and its timers; the same object if the name is not in it.

    A value that does not fit its type without the name is replaced by the key's initial value. Initial values stay,
    because the author wrote them.
    """
    checks, context = type_checks(machine), dict(snapshot.context)
    for key, value in snapshot.context.items():
        scrubbed = person.scrubbed(value)
        if scrubbed is not value and value != machine.context.get(key):
            allowed = key not in checks or fits(scrubbed, checks[key])
            context[key] = scrubbed if allowed else machine.context.get(key)
    timers = tuple(timer._replace(data=person.scrubbed(timer.data)) for timer in snapshot.timers)
    invoked = {
        id: child._replace(
            snapshot=forgetful(
                machine.invoked.get(machine.invoked_behavior(child.state, id), machine), child.snapshot, person
            )
        )
        for id, child in snapshot.invoked.items()
    }
    found = snapshot._replace(context=context, timers=timers, invoked=invoked)
    return snapshot if found == snapshot else found


def forgetful_data(frozen: Mapping[str, Any], person: PersonName) -> dict[str, Any]:
    """Return the data of a snapshot (`lumen.statechart.serialize`) without the name in its context and its timers.

    The snapshots of invoked behaviours are replaced in `frozen` itself.
    """
    found = dict(frozen)
    if "context" in found:
        found["context"] = _values(found["context"], person)
    if isinstance(timers := found.get("timers"), list):
        found["timers"] = [{**t, "data": person.scrubbed(t.get("data"))} if isinstance(t, dict) else t for t in timers]
    for child in found["invoked"].values() if isinstance(found.get("invoked"), dict) else ():
        if isinstance(child, dict) and isinstance(child.get("snapshot"), dict):
            child["snapshot"] = forgetful_data(child["snapshot"], person)
    return found


def _values(context: Any, person: PersonName) -> Any:
    """Remove the name from values. Keys stay, because the author chose them."""
    return {key: person.scrubbed(value) for key, value in context.items()} if isinstance(context, dict) else context
