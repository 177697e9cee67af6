"""All parts of an exhibition in this process, on a bus by its address."""

import sys
from typing import TextIO

from lumen.app.narrator import Narrator
from lumen.app.setup import Setup
from lumen.app.whole_node import WholeNode
from lumen.bus import connect
from lumen.buses.validated import validated
from lumen.language.projects import Project
from lumen.language.stories import Story


class Printed(Narrator):
    """What happens as lines: who, and what; on standard output, or in a stream."""

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
) -> WholeNode:
    """Not yet begun; its bus ends with it."""
    return WholeNode(
        project, setup, validated(connect(url), project), story, narrator, language=language, silent=silent
    )
