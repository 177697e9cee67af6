"""The manifest of the stranger's feature."""

from lumen.feature import (
    BaseRow,
    BusRow,
    EditorRow,
    Exporter,
    Feature,
    FileRow,
    FunctionRow,
    Importer,
    ModuleRow,
    PartRow,
    Phase,
    RobotOption,
    RobotRow,
    Section,
    SenseRow,
    Subcommand,
    VerbRow,
)

FEATURE = Feature(
    name="stranger",
    rules=("lumen_stranger.rules:check",),
    pages=("lumen_stranger.pages",),
    fixes={"small-name": "lumen_stranger.rules:enlarged"},
    subcommands={
        "greet": Subcommand("greet visitors with the name of an exhibition", "lumen_stranger.greet", after="plot"),
    },
    finding_formats={"count": "lumen_stranger.counting:findings"},
    verdict_formats={"count": "lumen_stranger.counting:verdict"},
    importers={".states": Importer("behavior", "lumen_stranger.lists:read_states")},
    exporters={"states": Exporter("behavior", "lumen_stranger.lists:write_states")},
    format_tables={"lists of states": "lumen_stranger.lists:KNOWN"},
    codes=("lumen_stranger.lamp", "lumen_stranger.invitations"),
    parts=(PartRow("guest book", Phase.WATCH, "lumen_stranger.guests:make", "brain"),),
    forgets=("lumen_stranger.guests:GuestBook", "lumen_stranger.guests:forget"),
    sections={
        "lamp": Section(
            read="lumen_stranger.lamp:read_lamp",
            schema="lumen_stranger.lamp:SCHEMA",
            title="scene of the lamp",
            risk="wiring",
            entries="scenes",
            of_house=True,
        )
    },
    files={"guests.yaml": FileRow("lumen_stranger.invitations:build_guests", "lumen_stranger.invitations:SCHEMA")},
    verbs={
        "shine": VerbRow(
            performer="lumen_stranger.shining",
            description="Switch the lamp to a scene.",
            arguments={
                "required": ["scene"],
                "properties": {"scene": {"type": "string", "description": "A scene of lumen.yaml"}},
            },
            result={"properties": {"brightness": {"type": "number", "default": 0}}},
        )
    },
    robots={
        "teddy": RobotRow(
            "lumen_stranger.teddy:set_up",
            options=(RobotOption("voice", "VOICE", "with --robot teddy: its voice, deep or high (default: deep)"),),
        )
    },
    bases={"glider": BaseRow("lumen_stranger.glider:Glider", "a glider", drives=True)},
    buses={"postbox": BusRow("lumen_stranger.postbox:Postbox", ("postbox://NAME",), "postbox://hall", True)},
    modules={
        "mood": ModuleRow(
            "lumen_stranger.mood:Mood",
            "How cheerful the visitors are, by their words",
            {"cheerful": {"description": "Words of cheerful visitors", "type": "array", "items": {"type": "string"}}},
        )
    },
    voices={"growl": "lumen_stranger.growl:Growl"},
    functions={"shout": FunctionRow("lumen_stranger.shouting:shout", ("text", "number"), "text", "text, 2")},
    editor_requests={
        "textDocument/documentColor": EditorRow("lumen_stranger.colours:colours", "lumen_stranger.colours:OPTIONS")
    },
    editor_commands={"stranger.count": "lumen_stranger.colours:count"},
    senses={"honey": SenseRow("the pots of honey", "lumen_stranger.honey:encode", "lumen_stranger.honey:decode")},
)
