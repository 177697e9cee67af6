"""The section `modules: {show: …}` of lumen.yaml, read into `Show`."""

from collections.abc import Mapping
from typing import Any

from lumen.features.show.settings import MQTT_PORT, MQTT_TLS_PORT, Show
from lumen.language.modules import SHOW
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields


def read_show(main: Mapping[str, Any], report: DocumentReport) -> Show:
    """Return the devices in the data of lumen.yaml, with MQTT's default port if none is given."""
    data = main["modules"][SHOW]
    mqtt = data.get("mqtt", {})
    port = MQTT_TLS_PORT if mqtt.get("tls") else MQTT_PORT
    return read_fields(Show, {**data, "mqtt": {"port": port, **mqtt}})
