"""Recordings of the messages of an exhibition."""

from lumen.feature import Feature, Subcommand

FEATURE = Feature(
    name="recording",
    subcommands={
        "record": Subcommand(
            "record the messages of a running exhibition, for Foxglove and Lichtblick",
            "lumen.cli.record",
            after="topic",
        ),
    },
)
