"""`lumen stop`: make the robot of a running exhibition rest at once, and stay so until a person resumes it."""

import argparse

from lumen.cli.commanding import answered, told
from lumen.cli.formats import configure_format
from lumen.cli.person import person
from lumen.cli.reach import configure_reach, names_meant, reach
from lumen.errors import BusError, BusUnreachableError
from lumen.run.resting import STOP_TIMEOUT, no_robot, rest_body, stop_behavior


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen stop` to its parser."""
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Stop every chosen robot; return 0, or 1 if one refused.

    Raises BusError if a robot could not be reached, but only after all others were stopped.
    """
    troubles, codes = list[BusError](), list[int]()
    for name in names_meant(options):
        options.robot_name = name
        try:
            codes.append(_stop(options))
        except BusError as error:
            troubles.append(error)
    if troubles:
        raise troubles[0]
    return max(codes)


def _stop(options: argparse.Namespace) -> int:
    """Send the stop on its own route; the robot informs the behaviour.

    If no robot answers, stop the behaviour directly, and raise BusUnreachableError.
    """
    reached = reach(options)
    try:
        answer = answered(reached.bus, reached.stop, rest_body(person()), STOP_TIMEOUT)
    except BusError:
        stop_behavior(reached.bus, reached.robot)
        raise BusUnreachableError(no_robot(reached.stop)) from None
    finally:
        reached.bus.close()
    return told(
        options,
        answer,
        f"{options.robot_name or 'the robot'} rests; hold its head or run `lumen resume` to let it move again",
    )
