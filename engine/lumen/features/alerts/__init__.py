"""Alerts to people about an exhibition's trouble."""

from lumen.feature import Feature, PartRow, Phase, Section, Subcommand

FEATURE = Feature(
    name="alerts",
    parts=(
        PartRow("alerts", Phase.ALERT, "lumen.features.alerts.part:make", "option:alerts"),
        PartRow(
            "refusals",
            Phase.ALERT,
            "lumen.features.alerts.reloads:make",
            "brain option:alerts option:reload",
            after="alerts",
        ),
    ),
    failures=("lumen.features.alerts.part:tell_of_failure",),
    pages=("lumen.features.alerts.pages",),
    section_rules={"alerts": "lumen.features.alerts.rules:check"},
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
