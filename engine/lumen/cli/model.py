"""`lumen model on|off`: switch the language model of a running exhibition."""

import argparse

from lumen.cli.commanding import told
from lumen.cli.formats import configure_format
from lumen.cli.person import person
from lumen.cli.reach import configure_reach, for_each_robot, reach
from lumen.language.operator_requests import MODEL
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.resting import TAKEN


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen model` to its parser."""
    parser.add_argument(
        "state", metavar="STATE", choices=("on", "off"), help="`on` or `off`; it stays off until you switch it on again"
    )
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Switch the model of each robot; return 0, or 1 if a robot refused."""
    return for_each_robot(options, _switch)


def _switch(options: argparse.Namespace) -> int:
    reached = reach(options)
    try:
        question = MODEL(on=options.state == "on", by=person())
        answer = next(send_request(reached.bus, operator_key(reached.robot), question, OPERATOR_ANSWERS))
    finally:
        reached.bus.close()
    kept = f", {answer['text']}" if answer.get("text") else ""
    if answer.get("verdict") == "refused":
        return told(options, answer["reason"], "")
    return told(options, TAKEN, f"the language model is {options.state}{kept}")
