"""Messages to people about trouble of an exhibition."""

from lumen.feature import Feature, Section, Subcommand

FEATURE = Feature(
    name="alerts",
    pages=("lumen.features.alerts.pages",),
    rules=("lumen.features.alerts.rules:check",),
    subcommands={
        "alerts": Subcommand("send a test alert to every recipient", "lumen.features.alerts.command", after="doctor"),
    },
    sections={
        "alerts": Section(
            read="lumen.features.alerts.reading:read_alerts",
            title="the recipients of alerts (`alerts`)",
            of_house=True,
        )
    },
)
