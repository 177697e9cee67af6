"""The options of robots can't have the names of Lumen's own options of `lumen run`."""

from lumen.cli.main import command_line
from lumen.feature.checking import TAKEN
from lumen.run.setup import robot_options


def test_the_taken_names_are_those_of_lumens_options_of_run() -> None:
    actions = command_line(("run",)).verbs["run"]._actions
    flags = {word.removeprefix("--").replace("-", "_") for each in actions for word in each.option_strings}
    own = {option.destination for option in robot_options()}
    assert {*flags, *(each.dest for each in actions), "run", "verb"} - own - {"_h"} == TAKEN
