"""Fuzzy controllers of other tools."""

from lumen.feature import Exporter, Feature, Importer

FEATURE = Feature(
    name="formats_fuzzy",
    importers={
        ".fll": Importer("controller", "lumen.formats.fll:read_fll"),
        ".fcl": Importer("controller", "lumen.formats.fcl:read_fcl"),
        ".fis": Importer("controller", "lumen.formats.fis:read_fis"),
    },
    exporters={"fll": Exporter("controller", "lumen.formats.fll:write_fll")},
    format_tables={
        "FLL": "lumen.formats.fll.reader:KNOWN",
        "FCL": "lumen.formats.fcl:KNOWN",
        ".fis": "lumen.formats.fis:KNOWN",
    },
)
