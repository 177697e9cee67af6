"""The step `answers`: what a story says that the module `answers` knows."""

from lumen.errors import BusError
from lumen.language.projects import Project
from lumen.language.stories import AnswerQuestion
from lumen.ports import Bus
from lumen.run.questions import ANSWER_ROUTE
from lumen.run.story_observations import UnmetExpectation

QUESTION_WITHIN = 30.0
"""How long `answers` waits for a question [s]."""


def answered(bus: Bus, project: Project, id: str, answer: AnswerQuestion, waited: float) -> UnmetExpectation | None:
    """Answer the question of that id, none where it is empty; what is wrong, also where none came in time."""
    if not id:
        wanted = f"a question to the module `answers` within {QUESTION_WITHIN:g} s"
        return UnmetExpectation(wanted, "none was asked") if waited >= QUESTION_WITHIN else None
    said = {"raise": {"event": answer.event, "data": dict(answer.data)}} if answer.event else {"text": answer.text}
    try:
        bus.publish(project.key_of(ANSWER_ROUTE), {"id": id, "source": "story", **said})
    except BusError as error:
        return UnmetExpectation("the answer to be sent", str(error))
    return None
