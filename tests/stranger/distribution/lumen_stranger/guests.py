"""A guest book: it keeps what visitors say, except what names a person who wants to be forgotten."""

from lumen.language.people import PersonName
from lumen.run.loop import Observer
from lumen.run.parts.part import Part
from lumen.run.services import Services
from lumen.statechart import Step

FORGOTTEN: list[PersonName] = []
"""Whom this process forgot."""


class GuestBook(Part, Observer):
    """The sentences of the visitors of one exhibition."""

    name, patient, watches = "guest book", True, True

    def __init__(self) -> None:
        self.sentences = list[str]()

    def stepped(self, step: Step) -> None:
        if step.event and step.event.name == "heard":
            self.sentences.append(step.event.data["result"])

    def forget(self, person: PersonName) -> None:
        self.sentences = [sentence for sentence in self.sentences if not person.is_named_in(sentence)]


def make(services: Services) -> GuestBook:
    return GuestBook()


def forget(person: PersonName) -> None:
    FORGOTTEN.append(person)
