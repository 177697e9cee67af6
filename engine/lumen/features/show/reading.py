"""`modules: {show: …}` of lumen.yaml, from its data to `Show`."""

from collections.abc import Mapping
from typing import Any

from lumen.features.show.settings import (
    MQTT_PORT,
    MQTT_TLS_PORT,
    AddressMapping,
    DmxLink,
    MqttLink,
    OscLink,
    Show,
    TopicMapping,
)
from lumen.language.modules import SHOW
from lumen.project.document_report import DocumentReport


def read_show(main: Mapping[str, Any], report: DocumentReport) -> Show:
    """Return the devices, from the data of lumen.yaml; a link that was refused is left out."""
    data = main["modules"][SHOW]
    return Show(_mqtt(data.get("mqtt", {})), _osc(data.get("osc", {})), _dmx(data.get("dmx", {})))


def _mqtt(data: Mapping[str, Any]) -> MqttLink | None:
    if "host" not in data:
        return None
    tls = data.get("tls", False)
    port = data.get("port", MQTT_TLS_PORT if tls else MQTT_PORT)
    return MqttLink(data["host"], int(port), tls, {n: _topic(row) for n, row in data.get("routes", {}).items()})


def _topic(row: str | Mapping[str, Any]) -> TopicMapping:
    if isinstance(row, str):
        return TopicMapping(row)
    return TopicMapping(row.get("topic", ""), row.get("field", ""), row.get("retain", False))


def _osc(data: Mapping[str, Any]) -> OscLink | None:
    if not {"host", "port"} <= data.keys():
        return None
    listen, rows = data.get("listen"), data.get("routes", {})
    routes = {name: _address(row) for name, row in rows.items()}
    return OscLink(data["host"], int(data["port"]), listen if listen is None else int(listen), routes)


def _address(row: str | Mapping[str, Any]) -> AddressMapping:
    if isinstance(row, str):
        return AddressMapping(row)
    return AddressMapping(row.get("address", ""), tuple(row["fields"]) if "fields" in row else None)


def _dmx(data: Mapping[str, Any]) -> DmxLink | None:
    if "universe" not in data:
        return None
    routes = {name: {key: int(n) for key, n in row.items()} for name, row in data.get("routes", {}).items()}
    return DmxLink(int(data["universe"]), data.get("host", ""), routes)
