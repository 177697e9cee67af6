"""The robot Reachy Mini, controlled through its daemon."""

from lumen.feature import Feature, RobotOption, RobotRow

URL = RobotOption(
    "url", "URL", "with --robot reachy: the address of the robot's daemon (default: http://reachy-mini.local:8000)"
)

VOICE = RobotOption(
    "voice", "NAME", "with --robot reachy: the voice that its loudspeaker plays, or `none` (default: espeak)"
)

FEATURE = Feature(
    name="reachy",
    extras=("reachy",),
    robots={
        "reachy": RobotRow(
            "lumen.features.reachy.set_up:set_up",
            real_time=True,
            bounded=True,
            options=(URL, VOICE),
            examine="lumen.features.reachy.examining:examine",
        )
    },
    rules=("lumen.features.reachy.reach_rule:check",),
    pages=("lumen.features.reachy.pages",),
)
