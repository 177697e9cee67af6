"""Files that crash, fill or block their reader: it is a separate process, so no run and no start fails with it.

The tests end the reader artificially, because every real fault known so far is fixed.
"""

import sys
from pathlib import Path

import pytest

from lumen.errors import FatalFilesError
from lumen.project import kept_contents
from lumen.project.files import fingerprint, read_files
from lumen.run import reaching
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.reload import validation_worker
from lumen.run.reload.validation_worker import ValidationWorker, load_apart
from tests.live.shows import Live

pytestmark = pytest.mark.rest  # expensive

SORRY = 'en: "I am sorry, I did not understand that."'
FATAL, PARDON = 'en: "FATAL"', 'en: "Come again, please?"'
READER = """
import os, signal
from lumen.run.reload import validation_process as process

def check_files(root, files, usual=process.check_files):
    if any(b"FATAL" in content for content in files.values()):
        {ends}
    return usual(root, files)

process.check_files = check_files
process.main()
"""
ENDS = {
    "os.kill(os.getpid(), signal.SIGSEGV)": "it was ended by SIGSEGV",
    "os._exit(3)": "it ended with exit code 3",
    "bytearray(1 << 40)": "it needed more than 1024 MB",
    "while True: pass": "it took more than 2 s",
    "os.kill(os.getpid(), signal.SIGSTOP)": "it took more than 2 s",
}


@pytest.fixture
def reader(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the judging process end at the word FATAL."""
    ends = getattr(request, "param", "os.kill(os.getpid(), signal.SIGSEGV)")
    monkeypatch.setattr(validation_worker, "COMMAND", [sys.executable, "-c", READER.format(ends=ends)])


def fatal(root: Path) -> None:
    tour = root / "behaviors/tour.yaml"
    tour.write_text(tour.read_text("utf-8").replace(SORRY, FATAL), "utf-8")


@pytest.mark.slow
@pytest.mark.parametrize(("reader", "how"), ENDS.items(), indirect=["reader"])
def test_how_the_reader_ended_is_told(copy: Path, reader: None, how: str) -> None:
    worker = ValidationWorker(copy, timeout=2.0 if "more than 2 s" in how else 60.0)
    worker.begin()
    fatal(copy)
    with pytest.raises(FatalFilesError, match=f"the process that reads these files failed: {how}"):
        worker.load(read_files(copy))
    worker.close()


@pytest.mark.slow
def test_a_fault_of_ours_in_the_reader_is_an_answer(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(validation_worker, "COMMAND", [sys.executable, "-c", READER.format(ends="1 / 0")])
    worker = ValidationWorker(copy)
    sound = read_files(copy)
    fatal(copy)
    with pytest.raises(ZeroDivisionError):
        worker.load(read_files(copy))
    assert worker.load(sound)[0] is not None
    worker.close()


@pytest.mark.slow
def test_an_exhibition_refuses_them_and_goes_on(copy: Path, reader: None) -> None:
    one = Live(copy, apart=True)
    try:
        one.edit(SORRY, FATAL)
        one.until_told("refused: the process that reads these files failed: it was ended by SIGSEGV; the exhibition")
        one.edit(FATAL, PARDON)
        one.until_told("the saved files are active")
        assert one.verdicts == ["refused", "applied"]
    finally:
        one.close()


@pytest.mark.slow
def test_a_start_on_them_is_refused_or_takes_the_last_good_ones(copy: Path, reader: None) -> None:
    run_directory, told = RunDirectory(copy), list[str]()
    good = startup_project(copy, run_directory, last_good=False)
    fatal(copy)
    with pytest.raises(FatalFilesError, match="SIGSEGV"):
        startup_project(copy, run_directory, last_good=False, warn=told.append)
    assert told == ["`lumen run --last-good` starts with the last files that had no errors."]
    assert startup_project(copy, run_directory, last_good=True, warn=told.append).hash == good.hash
    assert "THE FILES END THE PROCESS THAT READS THEM" in told[-1]
    [news] = run_directory.news
    assert (news.verdict, run_directory.refused) == ("refused", fingerprint(read_files(copy)))
    assert "the process that reads these files failed" in news.reason
    run_directory.close(forget=False)


def test_where_no_process_can_be_begun_nothing_is_read_here(
    copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(validation_worker, "COMMAND", ["/nowhere/python"])
    with pytest.raises(FatalFilesError, match="the process that reads the files can't start: No such file"):
        load_apart(copy, read_files(copy))


def test_who_reaches_an_exhibition_reads_no_file_but_the_main_one(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    usual, read = kept_contents.read_regular, list[str]()

    def noted(path: Path, most: int, *, follow: bool = True) -> bytes:
        read.append(path.name)
        return usual(path, most, follow=follow)

    monkeypatch.setattr(kept_contents, "read_regular", noted)
    assert reaching._keys(copy, None, "") == ("avatar.NAO.command", "avatar.NAO.stop")
    assert set(read) == {"lumen.yaml"}
    (copy / "lumen.yaml").write_text("[" * 60_000)
    assert reaching._keys(copy, None, "") == ("avatar.NAO.command", "avatar.NAO.stop")
