"""Distributions that a test writes are found at once, whatever earlier tests have left."""

import threading
import time
from collections.abc import Callable

import pytest

from lumen import distributions
from lumen.feature import features, finding, resolve
from lumen.lint import check_files
from lumen.project.files import read_files
from tests import ROOT
from tests.stranger.installing import Installed
from tests.waiting import HANG

LAMP = """\
from dataclasses import dataclass

from lumen.feature import Feature, Section


@dataclass(frozen=True)
class Lamp:
    watts: int = 0


def read(data, report):
    return Lamp(**data["lamp"])


SCHEMA = {"type": "object", "properties": {"watts": {"type": "integer"}}}
FEATURE = Feature(name="lamp", sections={"lamp": Section(read="lamp:read", schema="lamp:SCHEMA", title="lamp")})
"""


def test_a_thread_of_an_earlier_test_does_not_hide_a_distribution(
    installed: Installed, monkeypatch: pytest.MonkeyPatch
) -> None:
    read, inside, awaited = distributions._text, threading.Event(), threading.Event()

    def slow(folder: str, name: str) -> str:
        if threading.current_thread() is left:
            inside.set()
            awaited.wait(HANG)
        return read(folder, name)

    def waited(seconds: float, sleep: Callable[[float], None] = time.sleep) -> None:
        awaited.set()  # only now may the thread finish its search
        sleep(seconds)

    left = threading.Thread(target=features)
    monkeypatch.setattr(distributions, "_text", slow)
    monkeypatch.setattr("time.sleep", waited)
    distributions.distributions.cache_clear()
    finding.found.cache_clear()
    left.start()
    assert inside.wait(HANG)
    installed.write("late", "from lumen.feature import *\n\nFEATURE = Feature(name='late')\n")
    awaited.set()
    left.join()
    assert "late" in {feature.name for feature in features()}


def test_a_file_is_read_again_after_another_installation(installed: Installed) -> None:
    files = read_files(ROOT / "tests/lint/base")
    files["lumen.yaml"] += b"lamp: {watts: 3}\n"
    for _ in range(2):
        installed.write("lamp", LAMP)
        project, found = check_files(ROOT, files)
        assert project, found
        assert type(project.sections["lamp"]) is resolve("lamp:Lamp")
