"""The shipped project, and modules of it on a bus of their own."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.language.modules import ModuleSettings
from lumen.language.projects import Project
from lumen.run.module import Module
from tests.waiting import HANG, Collector


@pytest.fixture(scope="session")
def project() -> Project:
    return lumen.load(".")


def with_options(project: Project, name: str, **options: Any) -> Project:
    """Return the project with these options of a module in its lumen.yaml."""
    modules: Mapping[str, ModuleSettings] = {**project.modules, name: ModuleSettings(True, options)}
    return replace(project, modules=modules)


class Stand:
    """A bus with modules on it: `told` is what the operator read, `ask` sends a body and waits for the answer."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self.bus: Bus = connect("memory://", project)
        self.told: list[str] = []
        self.modules: list[Module] = []

    def add(self, module: Module) -> Module:
        module.begin()
        self.modules.append(module)
        return module

    def listen(self, key: str) -> Collector:
        """Return a collector of the messages under that key from now on."""
        collector = Collector()
        self.bus.subscribe(key, collector)
        return collector

    def ask(self, key: str, body: Any) -> Any:
        answers = self.listen("lumen.answers")
        self.bus.publish(key, body, reply_to="lumen.answers", correlation_id="7")
        return answers.wait(1)[0]

    def settle(self) -> None:
        for module in self.modules:
            assert module.settle(HANG)

    def close(self) -> None:
        for module in self.modules:
            module.close()
        self.bus.close()


@pytest.fixture
def stand(project: Project) -> Iterator[Callable[..., Stand]]:
    """Return a function that makes stands, which are closed after the test."""
    stands: list[Stand] = []

    def make(other: Project | None = None) -> Stand:
        stands.append(Stand(other or project))
        return stands[-1]

    yield make
    for one in stands:
        one.close()
