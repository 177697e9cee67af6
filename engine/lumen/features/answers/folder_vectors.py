"""Vectors from a folder with static embeddings, as saved by Model2Vec and Sentence Transformers.

The folder has `tokenizer.json`, and `model.safetensors` with a row for each token in `embeddings` or
`embedding.weight`. A text's vector is the mean of its tokens' rows, each multiplied by its entry in `weights`, if
present. If present, `mapping` has the index of each token's row. Nothing is ever downloaded.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import ModuleError
from lumen.features.answers.vectors import MAX_LENGTH, KnownText, TextVector, unit

INSTALL = "pip install 'lumen-robot[answers-folder]'"
PLACES = ("", "0_StaticEmbedding")
"""The subfolders that can contain both files; the empty name is the folder itself."""
ROWS = ("embeddings", "embedding.weight")
"""The possible names of the tensor with a row for each token."""
WANTED = "name a folder that Model2Vec has saved, with tokenizer.json and model.safetensors"
BATCH = 256


class _Static(NamedTuple):
    tokenizer: Any
    rows: Any
    weights: Any
    mapping: Any


class FolderVectors:
    """Static embeddings in a folder, which the first call loads."""

    is_here = True
    batch = BATCH

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._model: _Static | None = None

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Return the vectors of these texts. Raises ModuleError if the folder is unusable or a package is missing."""
        model = self._model = self._model or _loaded(self.folder)
        return [_vector(model, text[:MAX_LENGTH]) for text, _ in texts]


def _vector(model: _Static, text: str) -> TextVector:
    """Return a text's vector. Without a known token it is the mean of all tokens, which resembles no text."""
    tokens = [id for id in model.tokenizer.encode(text, add_special_tokens=False).ids if id < len(model.mapping)]
    rows = model.rows[model.mapping[tokens]] * model.weights[tokens, None] if tokens else model.rows
    try:
        return unit(rows.mean(axis=0).tolist())
    except ValueError:
        return unit([1.0] * model.rows.shape[1])


def _loaded(folder: Path) -> _Static:
    try:
        import numpy as np
        from safetensors.numpy import load_file
        from tokenizers import Tokenizer
    except ImportError as error:
        raise ModuleError(f"embeddings from a folder need {error.name}: {INSTALL}") from None
    place = next((folder / each for each in PLACES if (folder / each / "model.safetensors").is_file()), folder)
    try:
        tensors = load_file(place / "model.safetensors")
        tokenizer = Tokenizer.from_file(str(place / "tokenizer.json"))
        tokenizer.no_padding()
        rows = next(tensors[name] for name in ROWS if name in tensors).astype(np.float32)
        mapping = tensors.get("mapping", np.arange(len(rows))).astype(np.intp)
        weights = tensors.get("weights", np.ones(len(mapping))).astype(np.float32)
        if rows.ndim != 2 or len(weights) != len(mapping) or mapping.max(initial=0) >= len(rows) or not rows.size:
            raise ValueError("its tensors do not match")
    except StopIteration:
        raise ModuleError(f"{place / 'model.safetensors'} has no {' or '.join(ROWS)}: {WANTED}") from None
    except Exception as error:  # tokenizers raises plain Exception
        raise ModuleError(f"the embeddings in {folder} cannot be read ({error}): {WANTED}") from None
    return _Static(tokenizer, rows, weights, mapping)
