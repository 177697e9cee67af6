"""All parts of an exhibition in this process, on a bus by its address."""

from lumen.app.narrator import Narrator
from lumen.app.setup import Setup
from lumen.app.whole_node import WholeNode
from lumen.bus import connect
from lumen.buses.validated import validated
from lumen.language.projects import Project
from lumen.language.stories import Story


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
