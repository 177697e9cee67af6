"""The story, the language and the length of a run, from the options of `lumen run`."""

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

from lumen.cli.extras import RunExtra, of_extras, returned
from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.project.units import seconds
from lumen.run.chosen_stories import stories_of
from lumen.run.presence import ROBOT_PART
from lumen.run.setup import Setup, robot_options, set_up


def chosen_story(project: Project, options: argparse.Namespace, parts: Sequence[str]) -> Story | None:
    """Return the story that the options choose for a robot of which this process runs these parts; None without one.

    Raises UsageError if no story or several stories match, or if the chosen robot can't play the story.
    """
    if (name := options.story) is None:
        return None
    found = list(stories_of(project, name))
    if len(found) > 1:
        raise UsageError(
            f"choose one story: `{name}` matches {len(found)}, such as `{found[0].name}` and `{found[1].name}`"
        )
    story = found[0]
    if story.robot and (wanted := _player_of_faults(options.robot, parts)):
        raise UsageError(f"the story `{story.name}` has faults of the robot (`robot:`): {wanted}")
    if options.robot == "none":
        raise UsageError("a story needs a robot: leave out --robot none")
    return story


def _player_of_faults(robot: str, parts: Sequence[str]) -> str:
    """Return how to play a story with faults of the robot; empty if this robot, run with these parts, plays them."""
    if parts and ROBOT_PART not in parts:
        return "pass --story to the robot's process, too"
    return "" if robot == "recording" else "play it with --robot recording"


def period_of(text: str | None) -> float | None:
    """Return the length of a run [s] from a text such as `2min`, None if there is no text.

    Raises UsageError if the text is not a duration.
    """
    if text is None:
        return None
    period = seconds(text)
    if period is None:
        raise UsageError(f"invalid `--for {text}`: write a duration such as 60s or 2min")
    return period


def language_of(project: Project, language: str | None) -> str:
    """Return the language, or an empty text for None. Raises UsageError if the project does not have the language."""
    if language is not None and language not in project.languages:
        hint = did_you_mean(language, project.languages, "it has")
        raise UsageError(f"the project has no language `{language}`: {hint}")
    return language or ""


def robot_of(options: argparse.Namespace, project: Project, story: Story | None) -> Setup:
    """Return the set-up of the robot that the options choose.

    Raises UsageError if the options contradict each other.
    """
    return set_up(options.robot, project, options.speed, story, robot_wishes(options))


def robot_wishes(options: argparse.Namespace) -> dict[str, str]:
    """Return the robots' own options that were given on the command line, by name."""
    given = {option.name: vars(options)[option.destination] for option in robot_options()}
    return {name: value for name, value in given.items() if value}


def wishes(options: argparse.Namespace, project: Project, story: Story | None, period: float | None) -> dict[str, Any]:
    """Return the options of one robot's plan that follow from the features' options of `lumen run`.

    Raises UsageError if they can't be fulfilled.
    """

    def wished(extra: RunExtra) -> Mapping[str, Any]:
        found: Mapping[str, Any] = returned(extra.wishes(options, project, story, period), Mapping, str)
        return found

    return {name: value for found in of_extras("run_options", wished) for name, value in found.items()}
