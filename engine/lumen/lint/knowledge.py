"""Passages: questions in two passages, long answers, dates that have passed, unknown robots."""

from datetime import date

from lumen.language.diagnostics import ERROR, WARNING, Code, Place, Related, did_you_mean
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.language.knowledge import Passage
from lumen.lint.lookups import first
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.talk.folding import folded

CLAIMED_TWICE = Code("claimed-twice", "knowledge", WARNING, "two passages have the same question")
OUT_OF_DATE = Code("out-of-date", "knowledge", WARNING, "the `until` date of a passage has passed")
LONG_ANSWER = Code("long-answer", "knowledge", WARNING, "an answer is too long for the robot to say at once")
UNKNOWN_ROBOT = Code("unknown-robot", "references", ERROR, "a name refers to a robot that is not in lumen.yaml")

MAX_ANSWER = 400
"""The maximum length of an answer [characters]: about half a minute of speech."""


def check(draft: ProjectDraft) -> None:
    """Report faults of single passages, questions that two passages share, and robots that are not in lumen.yaml."""
    claims: dict[tuple[str, str], tuple[Passage, Place]] = {}
    for name, passage in draft.knowledge.items():
        report = draft.report(KNOWLEDGE_FOLDER, name)
        _claims(passage, report, claims)
        _days(passage, report, draft.today)
        for language, text in passage.answer.items():
            if len(text) > MAX_ANSWER:
                message = f"this answer has {len(text)} characters: too many for the robot to say at once"
                hint = f"shorten it to {MAX_ANSWER} characters, or split it into two passages"
                report(LONG_ANSWER, ("answer", language), message, hint, key=True)
        if draft.settings and draft.main:
            for i, robot in enumerate(passage.who):
                if robot not in draft.settings.robots and robot not in draft.main.lost:
                    hint = did_you_mean(robot, draft.settings.robots, "lumen.yaml has")
                    path = first(report, ("who", i), ("who",))
                    report(UNKNOWN_ROBOT, path, f"there is no robot `{robot}`", hint, cause=f"robot {robot}")


def _claims(passage: Passage, report: DocumentReport, claims: dict[tuple[str, str], tuple[Passage, Place]]) -> None:
    """Report questions that an earlier passage for the same robots has, with the same words in the same order."""
    for language, questions in passage.questions.items():
        for i, question in enumerate(questions):
            here = report.document.place(first(report, ("questions", language, i), ("questions", language)))
            other, there = claims.setdefault((language, words_of(question)), (passage, here))
            if there == here or (other.who and passage.who and not {*other.who} & {*passage.who}):
                continue
            message = f"`{question}` is also a question in {there.file}"
            related = Related(there, "the other one is here")
            hint = "delete it from one of the two: the robot gives only one of the answers"
            report.diagnostics.append(CLAIMED_TWICE.at(here, message, hint, (related,)))


def _days(passage: Passage, report: DocumentReport, today: date | None) -> None:
    if today and passage.is_past(today):
        message = f"this passage was valid until {passage.until}: the robot no longer uses it"
        report(OUT_OF_DATE, ("until",), message, "write the current answer and a later date, or delete the passage")


def words_of(question: str) -> str:
    """Return the words of a question, without punctuation and differences of spelling that hearing ignores."""
    return " ".join(folded(question))
