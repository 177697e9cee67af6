"""The feature that records an exhibition's messages."""

from lumen.feature import Feature, PartRow, Phase, Section, Subcommand

FEATURE = Feature(
    name="recording",
    parts=(PartRow("recording", Phase.RECORD, "lumen.features.mcap.part:make", "option:directory"),),
    file_forgetters=("lumen.features.mcap.forgetting:forget_recordings",),
    subcommands={
        "record": Subcommand(
            "record the messages of a running exhibition, for Foxglove and Lichtblick",
            "lumen.features.mcap.command",
            after="topic",
        ),
    },
    sections={"record": Section(read="lumen.project.retention:read_record", of_house=True)},
)
