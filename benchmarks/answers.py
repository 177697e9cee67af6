"""How many questions in other words than the passages' are answered, and how many wrongly, by each method.

    python benchmarks/answers.py [--curve]

Passages are those of knowledge/. Thresholds are set by knowledge/questions/visitors.yaml (of which each question is
judged by those that all others set), and tried on answers.yaml beside this, which no threshold has seen. Wanted: recall
of 90 %, 2 % wrong, 20 ms.
The questions were written for this, by who wrote the passages: real visitors will say other things.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import yaml

from lumen.interpreters.retrieval.calibration import Sample, calibrate, left_out, outcome
from lumen.interpreters.retrieval.ranking import AnswerRates, Thresholds
from lumen.interpreters.retrieval.retriever import Retriever
from lumen.interpreters.retrieval.scorers import METHODS
from lumen.language.projects import Project
from lumen.loading.files import read_files
from lumen.rules import check_files

ROOT = Path(__file__).parents[1]
HALVES = {"dev": ROOT / "knowledge/questions/visitors.yaml", "test": Path(__file__).with_suffix(".yaml")}
LANGUAGES = ("en", "id")
CURVE = 12
"""Thresholds of a curve."""


def main(arguments: list[str] | None = None) -> int:
    """Prints the table, and the curves where they are asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--curve", action="store_true", help="what each threshold would give, by the half for tests")
    options = parser.parse_args(arguments)
    project = shipped()
    print("| method | language | dev: recall | wrong | test: recall | wrong | refused | first is right | ms (CPU) |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    curves: list[str] = []
    for method in METHODS:
        for language in LANGUAGES:
            dev, test, cost = measured(project, method, language)
            thresholds = calibrate(dev)
            print(row(method, language, left_out(dev), test, thresholds, cost))
            curves += [f"\n{method}, {language}: threshold -> recall, wrong", *curve(test, thresholds)]
    if options.curve:
        print("\n".join(curves))
    return 0


def shipped() -> Project:
    """The shipped tour with its passages."""
    project, found = check_files(ROOT, read_files(ROOT))
    assert project, found
    return project


def asked(half: str) -> dict[str, Any]:
    """The questions of a half: `asked` by passage and language, `unanswered` by language."""
    found: dict[str, Any] = yaml.safe_load(HALVES[half].read_text("utf-8"))
    return found


def measured(project: Project, method: str, language: str) -> tuple[list[Sample], list[Sample], float]:
    """The samples of both halves, and what a question costs [ms of CPU]."""
    retriever = Retriever(project.knowledge.values(), language, method=METHODS[method])
    halves = []
    began = time.process_time()
    for questions in (asked("dev"), asked("test")):
        by_passage = {name: texts[language] for name, texts in questions["asked"].items()}
        halves.append(retriever.samples(by_passage, questions["unanswered"][language]))
    cost = 1000 * (time.process_time() - began) / sum(map(len, halves))
    return halves[0], halves[1], cost


def row(method: str, language: str, dev: AnswerRates, test: list[Sample], thresholds: Thresholds, cost: float) -> str:
    """A line of the table."""
    seen = outcome(test, thresholds)
    refused = sum(not thresholds.allow(sample.ranked) for sample in test) / len(test)
    known = [sample for sample in test if sample.wanted]
    first = sum(sample.is_right for sample in known) / len(known)
    shares = (dev.recall, dev.wrong, seen.recall, seen.wrong, refused, first)
    return f"| {method} | {language} | {' | '.join(f'{100 * share:.0f} %' for share in shares)} | {cost:.1f} |"


def curve(test: list[Sample], thresholds: Thresholds) -> list[str]:
    """Recall and wrong answers by the least score, with the margin that was calibrated."""
    rows = []
    for i in range(CURVE):
        least = i / CURVE
        seen = outcome(test, Thresholds(least, thresholds.margin))
        rows.append(f"  {least:.2f} -> {100 * seen.recall:.0f} %, {100 * seen.wrong:.0f} %")
    return rows


if __name__ == "__main__":
    sys.exit(main())
