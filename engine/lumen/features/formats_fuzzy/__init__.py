"""Import and export of other tools' fuzzy controllers."""

from lumen.feature import Exporter, Feature, Importer

FEATURE = Feature(
    name="formats_fuzzy",
    importers={
        ".fll": Importer("controller", "lumen.features.formats_fuzzy.fll:read_fll"),
        ".fcl": Importer("controller", "lumen.features.formats_fuzzy.fcl:read_fcl"),
        ".fis": Importer("controller", "lumen.features.formats_fuzzy.fis:read_fis"),
    },
    exporters={"fll": Exporter("controller", "lumen.features.formats_fuzzy.fll:write_fll")},
    format_tables={
        "FLL": "lumen.features.formats_fuzzy.fll.reader:KNOWN",
        "FCL": "lumen.features.formats_fuzzy.fcl:KNOWN",
        ".fis": "lumen.features.formats_fuzzy.fis:KNOWN",
    },
)
