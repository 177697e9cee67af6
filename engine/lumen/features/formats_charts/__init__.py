"""Import and export of other tools' statecharts, and diagrams of behaviours."""

from lumen.feature import Exporter, Feature, Importer, Subcommand

FEATURE = Feature(
    name="formats_charts",
    subcommands={
        "graph": Subcommand("draw a behaviour as a diagram", "lumen.features.formats_charts.command", after="memory")
    },
    importers={
        ".scxml": Importer("behavior", "lumen.features.formats_charts.scxml:read_scxml"),
        ".xml": Importer("behavior", "lumen.features.formats_charts.scxml:read_scxml"),
        ".json": Importer("behavior", "lumen.features.formats_charts.xstate:read_xstate"),
    },
    exporters={
        "scxml": Exporter("behavior", "lumen.features.formats_charts.scxml:write_scxml"),
        "xstate": Exporter("behavior", "lumen.features.formats_charts.xstate:write_xstate"),
        "mermaid": Exporter("diagram", "lumen.features.formats_charts.mermaid:mermaid"),
        "dot": Exporter("diagram", "lumen.features.formats_charts.dot:dot"),
    },
    format_tables={
        "SCXML": "lumen.features.formats_charts.scxml.known:KNOWN",
        "XState": "lumen.features.formats_charts.xstate.known:KNOWN",
    },
)
