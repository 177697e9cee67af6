"""The pages in a browser that show an exhibition and control it."""

from lumen.feature import Feature, Section, Subcommand

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
    sections={
        "console": Section(
            read="lumen.loading.console:read_console",
            title="the console",
            risk="restart",
            of_house=True,
        )
    },
)
