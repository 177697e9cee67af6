"""Checks test questions for passages: unknown passages, and questions with the words of an earlier question."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, Place, Related, did_you_mean
from lumen.language.folders import KNOWLEDGE_FOLDER, QUESTIONS_FOLDER
from lumen.language.knowledge import QuestionSet
from lumen.lint.knowledge import words_of
from lumen.lint.lookups import first
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

ASKED_TWICE = Code("asked-twice", "knowledge", WARNING, "a test question for the passages occurs twice")
UNKNOWN_PASSAGE = Code("unknown-passage", "references", ERROR, "a name refers to a passage that is not in knowledge/")


class _Text(NamedTuple):
    path: NodePath
    language: str
    said: str

    @property
    def key(self) -> tuple[str, str]:
        """The language and the words, which are the same for equal questions."""
        return self.language, words_of(self.said)


def check(draft: ProjectDraft) -> None:
    """Report unknown passages and repeated questions."""
    stand = {text.key: place for text, place in _known(draft)}
    for name, questions in draft.questions.items():
        report = draft.report(QUESTIONS_FOLDER, name)
        for passage in questions.asked:
            if passage not in draft.names[KNOWLEDGE_FOLDER]:
                hint = did_you_mean(passage, draft.names[KNOWLEDGE_FOLDER], "knowledge/ has")
                message = f"there is no passage `{passage}`"
                report(UNKNOWN_PASSAGE, ("asked", passage), message, hint, key=True, cause=f"passage {passage}")
        for text in _tried(questions):
            here = _place(report, text)
            if (there := stand.setdefault(text.key, here)) != here:
                hint = "use other words: the same question twice tests nothing new"
                related = Related(there, "the other one is here")
                message = f"`{text.said}` is also in {there.file}"
                report.diagnostics.append(ASKED_TWICE.at(here, message, hint, (related,)))


def _known(draft: ProjectDraft) -> Iterator[tuple[_Text, Place]]:
    """Yield the passages' questions, each with its place."""
    for name, passage in draft.knowledge.items():
        report = draft.report(KNOWLEDGE_FOLDER, name)
        for text in _texts(("questions",), passage.questions):
            yield text, _place(report, text)


def _tried(questions: QuestionSet) -> Iterator[_Text]:
    for passage, texts in questions.asked.items():
        yield from _texts(("asked", passage), texts)
    yield from _texts(("unanswered",), questions.unanswered)


def _texts(path: NodePath, texts: Mapping[str, tuple[str, ...]]) -> Iterator[_Text]:
    for language, each in texts.items():
        for i, text in enumerate(each):
            yield _Text((*path, language, i), language, text)


def _place(report: DocumentReport, text: _Text) -> Place:
    """Return the place of a text; if a language has one text instead of a list, the place of the language's value."""
    return report.document.place(first(report, text.path, text.path[:-1]))
