"""Files of other tools, read and written."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="formats",
    subcommands={
        "import": Subcommand(
            "convert another tool's statechart, motion, controller or robot",
            "lumen.cli.importing",
            after="plot",
        ),
        "export": Subcommand(
            "write a behaviour as SCXML, for XState or as a diagram; the routes as AsyncAPI",
            "lumen.cli.exporting",
            after="import",
        ),
    },
)
