"""Visitor, robot and brain in this process, on a bus by its address."""

import sys
from typing import TextIO

from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.run.exhibition import Exhibition
from lumen.run.narrator import Narrator
from lumen.run.plan import Plan
from lumen.run.setup import Setup


class Printed(Narrator):
    """Prints events as lines, each with its actor, to standard output or to a stream."""

    stream: TextIO | None = None

    def line(self, who: str, text: str) -> None:
        print(f"{who:<8} {text}", file=self.stream or sys.stdout, flush=True)

    def note(self, text: str) -> None:
        print(text, file=self.stream or sys.stdout, flush=True)


def whole(
    project: Project,
    setup: Setup,
    url: str = "memory://",
    story: Story | None = None,
    narrator: Narrator | None = None,
    *,
    language: str = "",
    silent: bool = False,
) -> Exhibition:
    """Make an exhibition of visitor, robot and brain alone, not yet started; the bus ends with them."""
    options = {"operated": False}
    return Exhibition(Plan(project, setup, url, story, narrator, language=language, silent=silent, options=options))
