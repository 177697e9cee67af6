"""One recogniser for all robots of a process: they have the same files, so the same is expected of their visitors."""

import threading
from collections.abc import Callable, Sequence
from weakref import WeakValueDictionary

from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser
from lumen.run.sound import Sound

_lock = threading.Lock()
_loaded: WeakValueDictionary[str, RankingRecogniser] = WeakValueDictionary()


class SharedRecogniser(RankingRecogniser):
    """The process's recogniser of that `name`, whose model is loaded once; who asks waits for who asked before.

    `load` makes it. Raises ModuleError where its package or its model is missing.
    """

    def __init__(self, name: str, load: Callable[[], RankingRecogniser]) -> None:
        self._expected: Sequence[Sequence[str]] = ()
        with _lock:
            self._recogniser = _loaded.get(name) or load()
            _loaded[name] = self._recogniser
        self.languages = self._recogniser.languages

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        self._expected = sentences

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        with _lock:
            self._recogniser.expect(self._expected)
            return self._recogniser.hypotheses(sound)


def shared_sphinx() -> SharedRecogniser:
    """PocketSphinx, as it comes with its package."""
    from lumen.features.ears.sphinx import Sphinx  # needless for another recogniser

    return SharedRecogniser("sphinx", Sphinx)
