"""The pages in a browser that show an exhibition and control it."""

from lumen.feature import Feature, PartRow, Phase, Section, Subcommand

FEATURE = Feature(
    name="console",
    parts=(
        PartRow(
            "console",
            Phase.SHOW,
            "lumen.features.console.part:make",
            "brain section:console option:console",
            after="film",
        ),
    ),
    pages=("lumen.features.console.explained",),
    section_rules={"console": "lumen.features.console.rules:check"},
    subcommands={
        "console": Subcommand(
            "show a running exhibition in a browser, and control it from there",
            "lumen.features.console.command",
            after="record",
        ),
    },
    sections={
        "console": Section(
            read="lumen.features.console.reading:read_console",
            title="the console",
            risk="restart",
            of_house=True,
        )
    },
)
