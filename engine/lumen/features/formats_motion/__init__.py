"""Motions of other tools."""

from lumen.feature import Feature, Importer

FEATURE = Feature(
    name="formats_motion",
    importers={
        ".motion": Importer("motion", "lumen.formats.gestures.webots:read_webots"),
        ".xar": Importer("motion", "lumen.formats.gestures.choregraphe:read_choregraphe"),
        ".py": Importer("motion", "lumen.formats.gestures.naoqi:read_naoqi"),
    },
    format_tables={
        "Webots' .motion": "lumen.formats.gestures.webots:KNOWN",
        "Choregraphe's .xar": "lumen.formats.gestures.choregraphe:KNOWN",
        "NAOqi's Python": "lumen.formats.gestures.naoqi_calls:KNOWN",
    },
)
