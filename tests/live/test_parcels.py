"""The data between the process that validates files and the one that runs them: complete, and sent only once."""

from pathlib import Path

import pytest

import lumen
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.reload.delta import LATE, DeltaDecoder, DeltaEncoder
from lumen.run.reload.validation_process import failure
from lumen.run.reload.validation_worker import ValidationWorker

TOUR = "behaviors/tour.yaml"
SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'


@pytest.mark.slow
def test_a_project_arrives_as_it_was(copy: Path) -> None:
    sent = lumen.load(copy)
    came = DeltaDecoder().unpack(DeltaEncoder().pack(sent))
    assert came == sent
    assert list(came.documents) == list(sent.documents)
    where = came.machine.states["guide"].where
    assert came.place(TOUR, where) == sent.place(TOUR, where)
    assert came.documents[TOUR] is came.documents[TOUR]


@pytest.mark.slow
def test_only_what_differs_travels_and_is_new(copy: Path) -> None:
    sender, receiver = DeltaEncoder(), DeltaDecoder()
    before = receiver.unpack(sender.pack(lumen.load(copy)))
    (copy / TOUR).write_text((copy / TOUR).read_text("utf-8").replace(SORRY, PARDON), "utf-8")
    parcel = sender.pack(lumen.load(copy))
    travelled = {piece for piece, data in parcel.items() if data is not None}
    assert {("hash", None), ("behaviors", "tour"), (LATE, TOUR)} <= travelled
    after = receiver.unpack(parcel)
    assert after.machine is not before.machine
    assert PARDON.removeprefix("en: ").strip('"') in str(after.machine)
    assert all(after.motions[name] is motion for name, motion in before.motions.items())
    assert after.body is before.body


def test_a_project_travels_after_its_stories_were_played(copy: Path) -> None:
    project = lumen.load(copy)
    assert failure(project, "refuses", 20.0) is None
    assert DeltaDecoder().unpack(DeltaEncoder().pack(project)) == project


@pytest.mark.process
@pytest.mark.slow
def test_the_same_process_judges_again_and_again(copy: Path) -> None:
    jury = ValidationWorker(copy)
    jury.begin()
    for text in (SORRY, PARDON, "en: [", SORRY):
        files = {**read_files(copy), TOUR: read_files(copy)[TOUR].replace(SORRY.encode(), text.encode())}
        project, diagnostics = jury.load(files)
        assert (project, list(diagnostics)) == (check_files(copy, files)[0], list(check_files(copy, files)[1]))
        if project:
            assert jury.play(project, "refuses", 20.0) is None
    jury.close()
