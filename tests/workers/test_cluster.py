"""Work on a cluster of Dask with three workers on loopback: one is killed, and the results are the same."""

import importlib.util
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

import lumen
from lumen.errors import WorkersError
from lumen.extras import MissingExtraError
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.trials.cases import cases
from lumen.features.simulation.trials.playing import play_case
from lumen.project.files import read_files
from lumen.run.workers.tasks import WorkKit, models_in
from lumen.run.workers.workers import Workers, workers_of
from tests import ROOT
from tests.workers.clusters import dask_cluster
from tests.workers.small_tasks import play_or_die

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with dask_cluster(tmp_path_factory.mktemp("cluster"), 3) as address:
        yield address


def test_a_cluster_of_which_one_worker_dies_plays_what_this_process_plays(cluster: str, tmp_path: Path) -> None:
    """The shortest motion, three robots: all load a project and compile models, which takes seconds."""
    project = lumen.load(ROOT)
    found = cases(project)
    standing = [number for number, case in enumerate(found) if case.motion.tracks and not case.before]
    shortest = min(standing, key=lambda number: found[number].motion.duration)
    kit = WorkKit({"": read_files(ROOT)}, models_in(ROOT))
    tasks = [(shortest, robot, project.section(Imperfections)) for robot in range(3)]
    here = [outcome.to_json() for _, outcome in Workers().results(play_case, kit, tasks)]
    marked = [(*task, str(tmp_path / "died")) for task in tasks]
    there = sorted(workers_of(cluster).results(play_or_die, kit, marked), key=lambda row: row[0])
    assert (tmp_path / "died").exists()
    assert [outcome.to_json() for _, outcome in there] == here


def test_where_nobody_listens_that_is_said() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    with pytest.raises(WorkersError, match=f"^no Dask scheduler answers at dask://127.0.0.1:{port}: start one"):
        list(workers_of(f"dask://127.0.0.1:{port}").results(play_case, WorkKit({}, {}), [()]))


def test_a_scheduler_without_workers_is_told(tmp_path: Path) -> None:
    with dask_cluster(tmp_path, 0) as address, pytest.raises(WorkersError, match="has no workers: start some with"):
        list(workers_of(address).results(play_case, WorkKit({}, {}), [()]))


def test_without_the_extra_the_command_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr("lumen.extras.find_spec", lambda name: None if name == "distributed" else find(name))
    with pytest.raises(MissingExtraError, match=r"pip install 'lumen-robot\[cluster\]'"):
        workers_of("dask://here:8786")
