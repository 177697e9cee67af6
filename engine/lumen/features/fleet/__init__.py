"""Updates of robots in many houses."""

from lumen.feature import Feature, FileRow, PartRow, Phase, Subcommand

FEATURE = Feature(
    name="fleet",
    parts=(
        PartRow(
            "fleet",
            Phase.SERVE,
            "lumen.features.fleet.part:make",
            "brain option:reload file:fleet.yaml",
            after="reload",
        ),
    ),
    before_start=("lumen.features.fleet.installing:finish",),
    pages=("lumen.features.fleet.pages",),
    section_rules={"fleet.yaml": "lumen.features.fleet.rules:check"},
    files={"fleet.yaml": FileRow("lumen.features.fleet.reading:build_fleet")},
    codes=("lumen.features.fleet.reading",),
    subcommands={
        "fleet": Subcommand(
            "update the robots of many houses, step by step", "lumen.features.fleet.command", after="doctor"
        ),
    },
)
