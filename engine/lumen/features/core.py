"""The part that every project needs, and all rows without a feature of their own yet."""

from lumen.feature import Feature, PartRow, Phase

MAKING = "lumen.app.making"
TYPED = "lumen.cli.typed:typed_visitor"

FEATURE = Feature(
    name="core",
    parts=(
        PartRow("recording", Phase.RECORD, f"{MAKING}.watching:recording", "option:directory"),
        PartRow("bundles", Phase.RECORD, f"{MAKING}.processes:follower", "follows", after="recording"),
        PartRow("behaviour", Phase.BEHAVIOR, f"{MAKING}.whole:behavior", "whole"),
        PartRow("remote behaviour", Phase.BEHAVIOR, f"{MAKING}.processes:behavior", "role:brain"),
        PartRow("visitor", Phase.WORLD, f"{MAKING}.whole:visitor", "whole"),
        PartRow("robot", Phase.WORLD, f"{MAKING}.whole:robot", "whole", after="visitor"),
        PartRow("hosted robot", Phase.WORLD, f"{MAKING}.processes:robot", "role:robot"),
        PartRow("motion", Phase.WORLD, f"{MAKING}.processes:motion", "role:motion", after="hosted robot"),
        PartRow("narrator", Phase.WATCH, f"{MAKING}.whole:narrator", "whole"),
        PartRow("remote narrator", Phase.WATCH, f"{MAKING}.processes:narrator", "role:brain"),
        PartRow("journal", Phase.SERVE, f"{MAKING}.serving:journal", "brain option:operated"),
        PartRow("forgetting", Phase.SERVE, f"{MAKING}.serving:forgetting", "option:operated", after="journal"),
        PartRow("reload", Phase.SERVE, f"{MAKING}.serving:reload", "brain option:reload", after="forgetting"),
        PartRow("fleet", Phase.SERVE, f"{MAKING}.serving:fleet", "brain option:reload", after="reload"),
        PartRow("operator", Phase.SERVE, f"{MAKING}.serving:operator", "brain option:operated", after="fleet"),
        PartRow("alerts", Phase.ALERT, f"{MAKING}.watching:alerts", "option:alerts"),
        PartRow(
            "refusals", Phase.ALERT, f"{MAKING}.watching:refusals", "brain option:alerts option:reload", after="alerts"
        ),
        PartRow("film", Phase.SHOW, f"{MAKING}.showing:film", "option:film"),
        PartRow("console", Phase.SHOW, f"{MAKING}.showing:console", "brain option:console", after="film"),
        PartRow("typed visitor", Phase.VISIT, TYPED, "whole option:greeting"),
        PartRow("modules", Phase.MODULES, f"{MAKING}.modules:modules", "option:modules", claimed=True),
        PartRow(
            "troubles",
            Phase.MODULES,
            f"{MAKING}.modules:troubles",
            "brain option:modules",
            after="modules",
            claimed=True,
        ),
        PartRow("brain", Phase.BRAIN, f"{MAKING}.whole:brain", "whole"),
        PartRow("remote brain", Phase.BRAIN, f"{MAKING}.processes:brain", "role:brain"),
        PartRow("records", Phase.KEEP, f"{MAKING}.serving:records", "brain option:operated"),
        PartRow("remote visitor", Phase.KEEP, f"{MAKING}.processes:visitor", "role:visitor", after="records"),
        PartRow("typed remote visitor", Phase.KEEP, TYPED, "role:visitor option:greeting", after="remote visitor"),
    ),
)
