"""A lamp on the MQTT broker of $LAMP_BROKER (HOST or HOST:PORT): needs paho-mqtt. Without a broker it only prints."""

import os

from lumen.skills import skill

COLOURS = {"gold": "#ffb000", "blue": "#0040ff", "off": "#000000"}
BROKER = os.environ.get("LAMP_BROKER", "")


@skill
def lamp(call, colour):
    if not BROKER:
        print("lamp:", COLOURS[colour])
        return
    from paho.mqtt import publish

    host, _, port = BROKER.partition(":")
    publish.single("hall/lamp/colour", COLOURS[colour], qos=1, hostname=host, port=int(port or 1883))
