"""Updates of the robots of many houses."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="fleet",
    pages=("lumen.features.fleet.pages",),
    rules=("lumen.features.fleet.rules:check",),
    codes=("lumen.features.fleet.reading",),
    subcommands={
        "fleet": Subcommand(
            "update the robots of many houses, step by step", "lumen.features.fleet.command", after="doctor"
        ),
    },
)
