"""What `lumen fleet check` says of the tests' brokers, and what RabbitMQ's own tool makes of it."""

import json
import shlex
from pathlib import Path
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.features.fleet.brokers import CENTRE
from tests.fleet.brokers import FleetBrokers
from tests.guarded import run_guarded


def checked(brokers: FleetBrokers, root: Path, name: str, capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    """What `lumen fleet check` finds, by what it looked at; a house reaches the centre by its own cable."""
    file = root / "fleet.yaml"
    port = brokers.cables[name].port if name in brokers.cables else brokers.brokers[CENTRE].secure
    fleet = json.loads(file.read_text()) | {"centre": {"broker": f"amqps://localhost:{port}/"}}
    file.write_text(json.dumps(fleet))
    where = ["--project", str(root), "--bus", brokers.url(name), "--ca", str(brokers.ca)]
    code = main(["fleet", "check", name, *where, "--rabbitmqctl", brokers.brokers[name].ctl, "--format", "json"])
    told = json.loads(capsys.readouterr().out)
    assert told["ok"] is (code == 0)
    return {row["what"]: row for row in told["found"]}


def wrong(found: dict[str, Any]) -> dict[str, str]:
    return {what: row["wrong"] for what, row in found.items() if row["wrong"]}


def mended(brokers: FleetBrokers, name: str, found: dict[str, Any]) -> None:
    """Type what the command has told for what is wrong."""
    file = brokers.brokers[name].folder / "definitions.json"
    for command in {row["mend"] for row in found.values() if row["mend"]}:
        line = command.replace("/etc/rabbitmq/definitions.json", str(file))
        ctl(brokers, name, *shlex.split(line.removeprefix("rabbitmqctl ")))


def ctl(brokers: FleetBrokers, name: str, *words: str) -> None:
    run_guarded([*shlex.split(brokers.brokers[name].ctl), "-q", *words], check=True, capture_output=True)
