"""The manifest of the stranger's feature."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="stranger",
    rules=("lumen_stranger.rules:check",),
    pages=("lumen_stranger.pages",),
    fixes={"small-name": "lumen_stranger.rules:enlarged"},
    subcommands={
        "greet": Subcommand("greet visitors with the name of an exhibition", "lumen_stranger.greet", after="plot"),
    },
)
