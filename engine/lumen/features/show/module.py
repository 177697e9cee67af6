"""Show control: routes of the exhibition to lamps, screens and sound desks that speak MQTT, OSC or DMX, and back.

show_control.py   the module: what goes out and what comes in, limited and checked
health.py         whether a device is there, said once
mqtt.py           a broker of MQTT          payloads.py   bodies as its payloads
osc.py            a device that takes OSC   arguments.py  bodies as its arguments
dmx.py            a universe over sACN      channels.py   bodies as its channels, and the packet
"""

from lumen.features.show.show_control import ShowControl

__all__ = ["ShowControl"]
