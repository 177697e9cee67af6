"""The check of saved files on recorded visits."""

from lumen.feature import Feature, Section

FEATURE = Feature(
    name="reload",
    codes=("lumen.project.replay_check",),
    sections={
        "reload": Section(
            read="lumen.project.replay_check:read_replay_check",
            title="the check of saved files on recorded visits (`reload`)",
        )
    },
)
