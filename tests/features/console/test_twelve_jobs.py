"""Twelve jobs at the console need as many clicks and keys as docs/console.md says."""

import re
from pathlib import Path

import pytest
from console_jobs import JOBS, done_jobs

from tests import ROOT
from tests.rabbitmq import GivenBroker, RabbitMQ

ROW = re.compile(r"(?m)^\| (?P<job>[^|]+) \| (?P<clicks>\d+) \| (?P<keys>\d+) \| [\d.]+ s \|$")


@pytest.mark.slow
def test_jobs_need_as_many_clicks_and_keys_as_the_docs_say(tmp_path: Path, broker: RabbitMQ | GivenBroker) -> None:
    rows = ROW.finditer((ROOT / "docs/console.md").read_text("utf-8"))
    told = {row["job"]: (int(row["clicks"]), int(row["keys"])) for row in rows}
    assert list(told) == [job.name for job in JOBS]
    assert {name: (done.clicks, done.keys) for name, done in done_jobs(tmp_path, broker.url).items()} == told
