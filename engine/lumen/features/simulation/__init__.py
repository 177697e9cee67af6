"""The physically simulated robot."""

from lumen.feature import BaseRow, Feature, PartRow, Phase, RobotOption, RobotRow, Section, Subcommand

FEATURE = Feature(
    name="simulation",
    sections={
        "imperfections": Section(
            read="lumen.features.simulation.reading:read_imperfections",
            title="the robot's imperfections",
            risk="restart",
            of_house=True,
        )
    },
    extras=("simulation",),
    parts=(PartRow("film", Phase.SHOW, "lumen.features.simulation.filming.part:make", "option:film"),),
    run_options=("lumen.features.simulation.filming.options:FilmOptions",),
    lint_options=("lumen.features.simulation.trials.lint_options:PhysicsOptions",),
    links=("lumen.features.simulation.link_frames:LinkFrames",),
    subcommands={
        "play": Subcommand("play a motion on the simulated robot", "lumen.features.simulation.command", after="hear")
    },
    bases={
        "biped": BaseRow("lumen.features.simulation.biped:Biped", "a biped", legs=True),
        "wheels": BaseRow("lumen.features.simulation.wheels:Wheels", "a base on wheels", drives=True, wheels=True),
        "fixed": BaseRow("lumen.features.simulation.fixed:Fixed", "a base that is built in"),
    },
    robots={
        "simulation": RobotRow(
            "lumen.features.simulation.set_up:set_up",
            "lumen.features.simulation.set_up:set_up_house",
            bounded=True,
            options=(
                RobotOption(
                    "imperfections",
                    "LIST",
                    "imperfections of the simulated robot: `none`, or a list of noise, quantisation, gyro_bias,"
                    " latency, backlash, torque_speed, supply (default: as in lumen.yaml, else all)",
                    short=True,
                    several=True,
                ),
            ),
        )
    },
)
