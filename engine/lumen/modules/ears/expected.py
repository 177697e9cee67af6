"""What visitors are expected to say, by what the behaviours wait for and what visitors say in the stories."""

import re
from collections.abc import Iterator

from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.language.stories import Speak

_WORD = re.compile(r"[a-z][a-z']*")


def expected(project: Project) -> list[list[str]]:
    """Sentences as words: the phrases and questions that the behaviours listen for in any language, and examples."""
    found = [phrase for machine in project.behaviors.values() for phrase in _phrases(machine)]
    found += [s.action.text for story in project.stories.values() for s in story.steps if isinstance(s.action, Speak)]
    return [words for text in dict.fromkeys(found) if (words := _WORD.findall(text.lower()))]


def _phrases(machine: MachineDefinition) -> Iterator[str]:
    for by_language in machine.phrases.values():
        for phrases in by_language.values():
            yield from phrases
    for rows in machine.answers.values():
        for row in rows:
            for phrases in row.phrases.values():
                yield from phrases
