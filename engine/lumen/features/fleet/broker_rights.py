"""What a broker has been told, beside what `lumen fleet init` tells it, as RabbitMQ writes definitions; pure."""

import json
import shlex
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from lumen.features.fleet.broker_finding import BrokerFinding
from lumen.features.fleet.brokers import UP

DefinitionRow = Mapping[str, Any]
BrokerDefinitions = Mapping[str, list[dict[str, Any]]]
IMPORT = "rabbitmqctl import_definitions /etc/rabbitmq/definitions.json"
NOT_COMPARED = ("password_hash", "hashing_algorithm", "tags")
SECRET = ("uri", "src-uri", "dest-uri")
"""Addresses with a password, and with files of the broker's machine: of these only the host is compared."""


class _Kind(NamedTuple):
    """One kind of definition: what a row `is` for people, by which keys it is `named`, and the command that sets it."""

    rows: str
    named: tuple[str, ...]
    is_: Callable[[DefinitionRow], str]
    mend: Callable[[DefinitionRow], str] = lambda row: IMPORT


def _words(*words: str) -> str:
    return "rabbitmqctl " + shlex.join(words)


KINDS = (
    _Kind("users", ("name",), lambda row: f"the user {row['name']}"),
    _Kind(
        "permissions",
        ("user",),
        lambda row: f"the permissions of the user {row['user']}",
        lambda row: _words("set_permissions", row["user"], row["configure"], row["write"], row["read"]),
    ),
    _Kind(
        "topic_permissions",
        ("user", "exchange"),
        lambda row: f"the topic permissions of the user {row['user']} on {row['exchange']}",
        lambda row: _words("set_topic_permissions", row["user"], row["exchange"], row["write"], row["read"]),
    ),
    _Kind("exchanges", ("name",), lambda row: f"the exchange {row['name']}"),
    _Kind("queues", ("name",), lambda row: f"the queue {row['name']}"),
    _Kind(
        "bindings",
        ("source", "destination", "destination_type", "routing_key"),
        lambda row: f"the binding of {row['routing_key']} from {row['source']} to {row['destination']}",
    ),
    _Kind("parameters", ("component", "name"), lambda row: f"the {row['component']} {row['name']}"),
    _Kind(
        "policies",
        ("name",),
        lambda row: f"the policy {row['name']}",
        lambda row: _words(
            "set_policy", "--apply-to", row["apply-to"], row["name"], row["pattern"], json.dumps(row["definition"])
        ),
    ),
)


def compare(wanted: BrokerDefinitions, found: BrokerDefinitions) -> Iterator[BrokerFinding]:
    """A finding for each kind that is whole, and for each row that is missing, another, or lets more cross."""
    for kind in KINDS:
        rows = {_name(kind, row): row for row in found.get(kind.rows, ()) if row.get("vhost", "/") == "/"}
        wrong = [row for want in wanted.get(kind.rows, ()) if (row := _judged(kind, want, rows.get(_name(kind, want))))]
        wrong += _leaks(wanted, rows.values()) if kind.rows == "bindings" else ()
        yield from wrong or [BrokerFinding(f"all {kind.rows.replace('_', ' ')}")] * bool(wanted.get(kind.rows))


def _name(kind: _Kind, row: DefinitionRow) -> tuple[Any, ...]:
    return tuple(row.get(key) for key in kind.named)


def _judged(kind: _Kind, want: DefinitionRow, found: DefinitionRow | None) -> BrokerFinding | None:
    if found is None:
        return BrokerFinding(kind.is_(want), "it is missing", mend=kind.mend(want))
    want = {key: value for key, value in want.items() if key not in NOT_COMPARED}
    for key, there, wanted in _differing(want, found):
        anew = f"rabbitmqctl delete_queue {want.get('name')}, which deletes its messages; then {IMPORT}"
        mend = anew if kind.rows == "queues" else kind.mend(want)
        return BrokerFinding(kind.is_(want), f"its {key} is {json.dumps(there)}, not {json.dumps(wanted)}", mend=mend)
    return None


def _differing(want: DefinitionRow, found: DefinitionRow) -> Iterator[tuple[str, Any, Any]]:
    """Each key whose value is another: its path, what is there, and what should be; what is false may be left out."""
    for key, wanted in want.items():
        there = found.get(key)
        if isinstance(wanted, Mapping) and isinstance(there, Mapping):
            yield from _differing(wanted, there)
        elif key in SECRET and _place(there) != _place(wanted):
            yield key, _place(there), _place(wanted)
        elif key not in SECRET and there != wanted and (there or wanted):
            yield key, there, wanted


def _leaks(wanted: BrokerDefinitions, there: Any) -> Iterator[BrokerFinding]:
    """What a binding that nobody wrote into the definitions lets out of the house."""
    known = {(row["source"], row["destination"], row["routing_key"]) for row in wanted["bindings"]}
    for row in there:
        if row["destination"] == UP and (row["source"], UP, row["routing_key"]) not in known:
            yield BrokerFinding(
                f"the binding of {row['routing_key']} from {row['source']} to {UP}",
                "Lumen did not create it, and it sends additional messages to the centre",
                mend=f"`rabbitmqctl delete_queue {UP}` (this also deletes the messages in the queue), then `{IMPORT}`",
            )


def _place(uri: Any) -> str:
    """Scheme, user, host and port."""
    parts = urlsplit(str(uri))
    who = f"{parts.username}@" if parts.username else ""
    return f"{parts.scheme}://{who}{parts.netloc.rpartition('@')[2]}"
