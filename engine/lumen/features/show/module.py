"""Show control: the exhibition's routes to and from lamps, screens and sound desks that use MQTT, OSC or DMX.

show_control.py   the module: outgoing and incoming messages, limited and checked
health.py         reports once that a device is gone, and that it is back
mqtt.py           an MQTT broker, and bodies as its payloads
osc.py            an OSC device             arguments.py  bodies as its arguments
dmx.py            a universe over sACN      channels.py   bodies as its channels, and the packet
"""

from lumen.features.show.show_control import ShowControl

__all__ = ["ShowControl"]
