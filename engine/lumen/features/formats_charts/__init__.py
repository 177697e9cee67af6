"""Statecharts of other tools, and diagrams."""

from lumen.feature import Exporter, Feature, Importer

FEATURE = Feature(
    name="formats_charts",
    importers={
        ".scxml": Importer("behavior", "lumen.formats.scxml:read_scxml"),
        ".xml": Importer("behavior", "lumen.formats.scxml:read_scxml"),
        ".json": Importer("behavior", "lumen.formats.xstate:read_xstate"),
    },
    exporters={
        "scxml": Exporter("behavior", "lumen.formats.scxml:write_scxml"),
        "xstate": Exporter("behavior", "lumen.formats.xstate:write_xstate"),
        "mermaid": Exporter("diagram", "lumen.formats.mermaid:mermaid"),
        "dot": Exporter("diagram", "lumen.formats.dot:dot"),
    },
    format_tables={
        "SCXML": "lumen.formats.scxml.known:KNOWN",
        "XState": "lumen.formats.xstate.known:KNOWN",
    },
)
