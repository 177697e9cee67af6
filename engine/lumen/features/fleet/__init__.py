"""Updates of the robots of many houses."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="fleet",
    rules=("lumen.rules.fleet:check",),
    codes=("lumen.loading.fleet",),
    subcommands={
        "fleet": Subcommand("update the robots of many houses, step by step", "lumen.cli.fleet", after="doctor"),
    },
)
