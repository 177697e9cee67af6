"""One PocketSphinx for all robots of a process: they have the same files, so the same is expected of their visitors."""

import threading
from collections.abc import Sequence
from weakref import WeakValueDictionary

from lumen.modules.ears.recogniser import Hypothesis
from lumen.modules.ears.sphinx import Sphinx
from lumen.modules.sound import Sound

_lock = threading.Lock()
_loaded: WeakValueDictionary[str, Sphinx] = WeakValueDictionary()


class SharedSphinx:
    """The process's recogniser, whose model is loaded once; who asks waits for who asked before.

    Raises ModuleError where the package or its model is missing.
    """

    languages: tuple[str, ...] = Sphinx.languages

    def __init__(self) -> None:
        self._expected: Sequence[Sequence[str]] = ()
        with _lock:
            self._sphinx = _loaded.get("") or Sphinx()
            _loaded[""] = self._sphinx

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        self._expected = sentences

    def recognise(self, sound: Sound) -> str:
        found = self.hypotheses(sound)
        return found[0].text if found else ""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        with _lock:
            self._sphinx.expect(self._expected)
            return self._sphinx.hypotheses(sound)
