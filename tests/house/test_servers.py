"""A run has one browser and one broker, whose end fails tests and whose run may be killed."""

import os
import sys
from pathlib import Path

import pytest

from tests import ROOT
from tests.guarded import PIPE, Guarded
from tests.house.test_guarded import gone, left
from tests.waiting import HANG, until

SHARES = """
from pathlib import Path
from tests.rabbitmq import RabbitMQ
from tests.servers import given
from tests.waiting import until

def test_a_part_is_given_to_each(broker: RabbitMQ) -> None:
    Path(__file__).with_suffix(".new").write_text(f"{given('chromium')['port']} {broker.port} {broker.host}")
    Path(__file__).with_suffix(".new").rename(Path(__file__).with_suffix(".given"))
    until(lambda: len([*Path().glob("*.given")]) == 2)
    (browser, port, host), other = [path.read_text().split() for path in Path().glob("*.given")]
    assert [browser, port] == other[:2]
    assert host != other[2]
"""
ENDS = """
import pytest
from tests.features.console.chromium import Chromium

def test_a_browser_that_ends_fails_who_uses_it() -> None:
    one, other = Chromium(), Chromium()
    other.open("data:text/html,<p>here")
    other.find("p")
    with pytest.raises(pytest.fail.Exception, match="Chromium has ended"):
        one._browser._browser.ask("Browser.crash")
    with pytest.raises(pytest.fail.Exception, match="Chromium has ended"):
        other.find("h1")
    other.close()

def test_the_next_has_another() -> None:
    one = Chromium()
    one.open("data:text/html,<p>here")
    assert one.find("p").text == "here"
    Path("started").touch()
    until(lambda: False)
"""


@pytest.mark.slow
@pytest.mark.broker
def test_servers_are_shared_end_with_a_sentence_and_end_with_their_run(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    folder = tmp_path_factory.mktemp("s")  # Chromium refuses a long path of its socket
    (folder / "test_one.py").write_text(SHARES)
    (folder / "test_two.py").write_text(SHARES + ENDS)
    words = ["-p", "tests.servers", "-p", "no:cacheprovider", "-c", os.devnull, "--rootdir", ".", "-x"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(folder)}
    line = [sys.executable, "-m", "pytest", *words, "-n", "2", "--dist", "loadfile", "test_one.py", "test_two.py"]
    session = Guarded(line, cwd=folder, env=environment, stdout=PIPE, text=True)
    until(lambda: (folder / "started").exists() or session.poll() is not None, 2 * HANG)
    if session.poll() is not None:
        pytest.fail(session.communicate()[0])
    assert any("chromium" in Path(one, "cmdline").read_text() for one in left(folder) if one.startswith("/proc"))
    session.kill()
    session.communicate()
    gone(folder)
