"""The pages in a browser that show an exhibition and control it."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="console",
    rules=("lumen.rules.console:check",),
    subcommands={
        "console": Subcommand(
            "show a running exhibition in a browser, and control it from there",
            "lumen.cli.console",
            after="record",
        ),
    },
)
