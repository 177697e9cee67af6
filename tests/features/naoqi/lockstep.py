"""The adapter and the fake in one virtual time: nothing passes before every answer has arrived."""

from lumen.features.naoqi.offers import NaoqiRobot
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Reading, Sense
from tests.features.naoqi.fake import FakeNao
from tests.waiting import HANG, until


class Lockstep(NaoqiRobot):
    """The robot behind the seam, on a fake of its own (`nao`), in a hall; `advance` lets time pass for both."""

    def __init__(self, project: Project, nao: FakeNao | None = None, *, all_fresh: bool = True) -> None:
        self.nao = nao or FakeNao(project.body)
        self._fresh = tuple(Sense) if all_fresh else (Sense.JOINT,)
        super().__init__(project.body, self.nao.url, lambda: self.nao.times.now, stage=project.stage, patience=HANG)
        self.place, self.face = self.nao.place, self.nao.face

    def advance(self, dt: float) -> None:
        self.settle()
        self.nao.times.advance(dt)
        self.settle()

    def settle(self) -> None:
        """Wait until every call but those that block has been answered, and every event heard."""
        until(self._settled, every=0.0005)

    def _settled(self) -> bool:
        """Return whether the fake robot and the adapter wait for nothing of each other."""
        answered = self._session.pending == self.nao.times.waiting and self._naoqi_events.heard >= self.nao.told
        return answered or not self._session.up

    def read(self, sense: Sense) -> Reading | None:
        return self._senses[sense].fresh(HANG) if sense in self._fresh else super().read(sense)

    def touch(self, sensor: str, pressed: bool) -> None:
        self.nao.touch(sensor, pressed)
        self.settle()

    def sound(self) -> None:
        """Do nothing: the tour's visitor is heard as words, without sound."""

    def plug(self, plugged: bool) -> None:
        self.nao.world.plugged = plugged

    def place(self, visitor: Visitor | None) -> None:  # type: ignore[no-redef]
        self.nao.place(visitor)

    def close(self) -> None:
        super().close()
        self.nao.close()
