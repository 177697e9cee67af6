"""The tables of all formats that `lumen import` reads."""

from collections.abc import Mapping

from lumen.formats import fcl, fis
from lumen.formats.fll import reader as fll
from lumen.formats.gestures import choregraphe, naoqi_calls, webots
from lumen.formats.known import FormatTable
from lumen.formats.robot_models import mjcf_known, urdf
from lumen.formats.scxml import known as scxml
from lumen.formats.xstate import known as xstate

TABLES: Mapping[str, FormatTable] = {
    "SCXML": scxml.KNOWN,
    "XState": xstate.KNOWN,
    "Webots' .motion": webots.KNOWN,
    "Choregraphe's .xar": choregraphe.KNOWN,
    "NAOqi's Python": naoqi_calls.KNOWN,
    "FLL": fll.KNOWN,
    "FCL": fcl.KNOWN,
    ".fis": fis.KNOWN,
    "URDF": urdf.KNOWN,
    "MJCF": mjcf_known.KNOWN,
}
"""The names of each format that are read, lost or without meaning, by the kind of place in a file."""
