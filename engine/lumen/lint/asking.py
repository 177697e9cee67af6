"""Visitors' questions that can't be answered, because the project has neither knowledge nor a module for answers."""

from lumen.language.actions import AskQuestion
from lumen.language.diagnostics import WARNING, Code
from lumen.language.modules import ANSWERS
from lumen.language.stories import AnswerQuestion
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft

ASKS_NOBODY = Code("asks-nobody", "knowledge", WARNING, "a question is asked, but nothing can answer it")


def check(draft: ProjectDraft) -> None:
    """Report each `ask` that neither a passage nor a module can answer, and stories that use a missing module."""
    if draft.settings is None or ANSWERS in draft.settings.modules:
        return
    for name, story in draft.stories.items():
        for step in story.steps:
            if isinstance(step.action, AnswerQuestion):
                message = "no module can give this answer: lumen.yaml has no module `answers`"
                hint = "add `answers` under `modules`, or put the answer into a passage in knowledge/"
                draft.report("behaviors/stories", name)(ASKS_NOBODY, (*step.where, "answers"), message, hint, key=True)
    if draft.knowledge:
        return
    for name, machine in draft.behaviors.items():
        for site in action_sites(machine):
            if isinstance(site.step.action, AskQuestion):
                message = (
                    "nothing can answer this question: knowledge/ is empty, and lumen.yaml has no module `answers`"
                )
                hint = "write knowledge/NAME.yaml with a question and its answer, or use the actions of `else` instead"
                draft.report("behaviors", name)(ASKS_NOBODY, (*site.step.where, "ask"), message, hint, key=True)
