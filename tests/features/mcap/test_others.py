"""The reader libraries of Foxglove and Lichtblick read our recordings of an exhibition's whole traffic."""

import json
from pathlib import Path

import pytest

import lumen
from lumen.features.mcap.files.foxglove import form_class
from lumen.features.mcap.files.rewriting import recover
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import set_up
from tests import ROOT
from tests.features.mcap.making import bodies
from tests.fetched import fetched
from tests.guarded import run_guarded
from tests.waiting import HANG

READER = Path(__file__).with_name("read.mjs")


@pytest.fixture(scope="module")
def tour(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Some seconds of a visit by the recording robot, which has joints, and a hall of its own."""
    folder = tmp_path_factory.mktemp("tour")
    project = lumen.load(ROOT)
    story = project.stories["visitor"]
    directory = RunDirectory(folder)
    path = folder / "tour.mcap"
    setup = set_up("recording", project, "max", story)
    with Exhibition(Plan(project, setup, story=story, options={"directory": directory, "record": path})) as exhibition:
        exhibition.start()
        exhibition.run(4.0)
    directory.close(forget=True)
    return path


@pytest.mark.network
def test_a_visit_is_recorded_with_the_robot_s_links(tour: Path) -> None:
    found = dict(bodies(tour))
    frames = form_class("FrameTransforms").FromString(found["avatar.NAO.data.joint.frames"])
    links = {frame.child_frame_id: frame for frame in frames.transforms}
    assert links["Torso"].parent_frame_id == "hall"
    assert 0.2 < links["Torso"].translation.z < 0.45
    assert links["HeadPitch"].parent_frame_id == "HeadYaw"
    assert all(abs(sum(getattr(f.rotation, a) ** 2 for a in "wxyz") - 1) < 1e-6 for f in frames.transforms)
    look = form_class("SceneUpdate").FromString(found["avatar.NAO.data.joint.look"])
    assert {entity.frame_id for entity in look.entities} <= {*links}
    assert sum(len(entity.triangles) for entity in look.entities) > 20
    assert found["avatar.NAO.data.joint"]["name"][0] == "HeadYaw"


@pytest.mark.npm
@pytest.mark.parametrize("cut", [False, True], ids=["whole", "recovered"])
def test_others_read_it(tour: Path, tmp_path: Path, cut: bool) -> None:
    path = tmp_path / "tour.mcap"
    path.write_bytes(tour.read_bytes()[: -tour.stat().st_size // 20 if cut else None])
    if cut:
        recover(path)
    done = run_guarded(
        ["node", READER, fetched("mcap"), path], capture_output=True, text=True, timeout=HANG, check=True
    )
    said = json.loads(done.stdout)
    assert said["done"]
    assert said["inOrder"]
    assert said["records"]["ChunkIndex"] == said["records"]["Chunk"]
    assert said["counted"] == sum(topic["count"] for topic in said["topics"].values()) == len(bodies(path))
    assert said["topics"]["avatar.NAO.data.joint"]["schema"] == "lumen.joint"
    assert said["topics"]["avatar.NAO.data.joint.frames"]["schema"] == "foxglove.FrameTransforms"
    assert any(name.startswith("bundle-") for name in said["attachments"])
