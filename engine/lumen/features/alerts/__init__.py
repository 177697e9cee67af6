"""Messages to people about trouble of an exhibition."""

from lumen.feature import Feature, Section, Subcommand

FEATURE = Feature(
    name="alerts",
    rules=("lumen.rules.alerts:check",),
    subcommands={
        "alerts": Subcommand("send a test alert to every recipient", "lumen.cli.alerts", after="doctor"),
    },
    sections={
        "alerts": Section(
            read="lumen.loading.alerts:read_alerts",
            title="the recipients of alerts (`alerts`)",
            of_house=True,
        )
    },
)
