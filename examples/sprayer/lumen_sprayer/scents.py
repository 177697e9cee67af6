"""The scents that each visitor has smelled."""

from lumen.language.commands import Do, Start
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.run.loop import Observer
from lumen.run.parts.part import Part
from lumen.run.services import Services
from lumen.statechart import Step
from lumen_sprayer.settings import Sprayer


class ScentsPart(Part, Observer):
    """Writes down the scents by the visitors' names, as the behaviour keeps these in its context."""

    name = "scents"
    patient = True
    """It has nothing to do between two steps, so the robot may sleep."""
    watches = True

    def __init__(self, project: Project) -> None:
        self._project = project
        self.smelled: dict[str, list[str]] = {}

    def use(self, project: Project) -> None:
        self._project = project

    def stepped(self, step: Step) -> None:
        visitor = step.snapshot.context.get("visitor")
        for command in step.commands:
            match command:
                case Start(command=Do("spray", {"nozzle": nozzle})) if visitor:
                    scent = self._project.section(Sprayer).nozzles.get(nozzle, nozzle)
                    self.smelled.setdefault(visitor, []).append(scent)

    def forget(self, person: PersonName) -> None:
        self.smelled = {name: scents for name, scents in self.smelled.items() if not person.is_named_in(name)}


def make(services: Services) -> ScentsPart:
    """Make the part."""
    return ScentsPart(services.project)
