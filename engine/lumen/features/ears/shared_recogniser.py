"""One recogniser for all robots of a process, so each model is loaded only once."""

import threading
from collections.abc import Callable, Sequence
from weakref import WeakValueDictionary

from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser
from lumen.run.sound import Sound

_lock = threading.Lock()
_loaded: WeakValueDictionary[str, RankingRecogniser] = WeakValueDictionary()


class SharedRecogniser(RankingRecogniser):
    """The process's recogniser with this `name`, whose model is loaded once; concurrent calls wait for each other.

    `load` creates the recogniser. Raises ModuleError if its package or model is missing.
    """

    def __init__(self, name: str, load: Callable[[], RankingRecogniser]) -> None:
        self._expected: Sequence[Sequence[str]] = ()
        with _lock:
            self._recogniser = _loaded.get(name) or load()
            _loaded[name] = self._recogniser
        self.languages = self._recogniser.languages

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """Set the sentences that this robot expects."""
        self._expected = sentences

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        """Return the hypotheses for a sound, with this robot's expected sentences."""
        with _lock:
            self._recogniser.expect(self._expected)
            return self._recogniser.hypotheses(sound)


def shared_sphinx() -> SharedRecogniser:
    """Return a recogniser that shares the process's PocketSphinx."""
    from lumen.features.ears.sphinx import Sphinx  # other recognisers do not need it

    return SharedRecogniser("sphinx", Sphinx)
