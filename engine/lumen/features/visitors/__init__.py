"""The visitors that the exhibition remembers, and its journal of events."""

from lumen.feature import Feature, ModuleRow, Subcommand

FEATURE = Feature(
    name="visitors",
    modules={"memory": ModuleRow("lumen.features.visitors.module:Memory")},
    file_forgetters=("lumen.features.visitors.memory:forget_in_database",),
    subcommands={
        "memory": Subcommand(
            "list what the robot remembers, or forget a visitor", "lumen.features.visitors.command", after="play"
        )
    },
)
