"""Import of other tools' motions."""

from lumen.feature import Feature, Importer

FEATURE = Feature(
    name="formats_motion",
    importers={
        ".motion": Importer("motion", "lumen.features.formats_motion.webots:read_webots"),
        ".xar": Importer("motion", "lumen.features.formats_motion.choregraphe:read_choregraphe"),
        ".py": Importer("motion", "lumen.features.formats_motion.naoqi:read_naoqi"),
        ".pml": Importer(
            "hint",
            "lumen.features.formats_motion.choregraphe:choregraphe_list",
            "lumen.features.formats_motion.choregraphe:is_choregraphe_list",
        ),
    },
    format_tables={
        "Webots' .motion": "lumen.features.formats_motion.webots:KNOWN",
        "Choregraphe's .xar": "lumen.features.formats_motion.choregraphe:KNOWN",
        "NAOqi's Python": "lumen.features.formats_motion.naoqi_calls:KNOWN",
    },
)
