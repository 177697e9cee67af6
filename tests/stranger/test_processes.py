"""A stranger's module runs in a process of its own."""

from pathlib import Path

import pytest

from tests.rabbitmq import RabbitMQ
from tests.stranger.installing import Lumen


@pytest.mark.process
def test_a_module_is_a_process_of_its_own(stranger_lumen: Lumen, hall: Path, broker: RabbitMQ) -> None:
    done = stranger_lumen(hall, "run", "--only", "mood", "--bus", broker.url, "--for", "3s")
    assert done.returncode == 0, done.stderr
    assert "My exhibition: mood of NAO" in done.stdout
