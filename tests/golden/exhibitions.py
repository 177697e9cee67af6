"""The frozen small exhibition, with one robot or two, and with a program that receives its alerts."""

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.golden.golden import PROJECTS
from tests.rabbitmq import RabbitMQ

ONE = "robot: {name: NAO, model: nao}"
TWO = "robots:\n  ana: {model: nao, at: {y: -0.4}}\n  ben: {model: nao, at: {y: 0.4}}"
ALERTS = "alerts: {to: [{command: [./told.sh]}]}\n"
TOLD = "alerts.jsonl"
PROGRAM = f'#!/bin/sh\nread -r line\necho "$line" >> {TOLD}\n'
"""The program that receives alerts: it writes each as one line at once, since two may come at the same time."""


def small(folder: Path, *, robots: int = 1, more: str = "") -> Path:
    """Write the small exhibition into a new folder, and return it; `more` is appended to its lumen.yaml."""
    shutil.copytree(PROJECTS / "minimal", folder)
    main = folder / "lumen.yaml"
    text = main.read_text("utf-8")
    assert ONE in text
    main.write_text(text.replace(ONE, ONE if robots == 1 else TWO) + ALERTS + more, "utf-8")
    program = folder / "told.sh"
    program.write_text(PROGRAM, "utf-8")
    program.chmod(0o755)
    return folder


@contextmanager
def broker() -> Iterator[str]:
    """Start a broker that nothing else uses, and yield its address."""
    rabbitmq = RabbitMQ()
    try:
        rabbitmq.start()
        yield rabbitmq.url
    finally:
        rabbitmq.stop()


def plain(text: str, *folders: Path) -> str:
    """Return a text without what differs between runs: paths, ports, numbers of processes, times and durations."""
    for number, folder in enumerate(folders, 1):
        text = text.replace(str(folder), "<folder>" if number == 1 else f"<folder {number}>")
    for pattern, instead in UNFIXED:
        text = pattern.sub(instead, text)
    return text


UNFIXED = [
    (re.compile(pattern), instead)
    for pattern, instead in (
        (r"ready after [\d.]+ s", "ready after … s"),
        (r"in \d+ s \([\d.]+ × real time\)", "in … s (… × real time)"),
        (r"\b\d{4}-\d\d-\d\dT\d\d[:-]\d\d[:-]\d\d(?:\.\d+)?(?:\+00:00|Z)?", "<time>"),
        (r"\b127\.0\.0\.1:\d+", "127.0.0.1:<port>"),
        (r"\b[0-9a-f]{16,64}\b", "<hash>"),
        (r"\bprocess \d+", "process <pid>"),
        (r"\b[0-9a-f]{10}-\d+\b", "<id>"),
        (r"\b1[6-9]\d{8}\.\d+", "<time>"),
    )
]
