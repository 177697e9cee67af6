"""The story, the language and the length of a run, from the options of `lumen run`."""

import argparse
from typing import Any

from lumen.cli.extras import run_extras
from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.project.units import seconds
from lumen.run.chosen_stories import stories_of
from lumen.run.setup import Setup, robot_options, set_up


def chosen_story(project: Project, name: str | None) -> Story | None:
    """Return the story that a name or pattern matches; None if `name` is None.

    Raises UsageError if no story or several stories match.
    """
    if name is None:
        return None
    found = list(stories_of(project, name))
    if len(found) > 1:
        raise UsageError(
            f"choose one story: `{name}` matches {len(found)}, such as `{found[0].name}` and `{found[1].name}`"
        )
    return found[0]


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
    found: dict[str, Any] = {}
    for extra in run_extras():
        found |= extra.wishes(options, project, story, period)
    return found
