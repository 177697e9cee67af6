"""The forgetting of people by features, by the rows of their manifests."""

import logging
from collections.abc import Callable
from typing import Any

from lumen.feature import distribution_of, resolve, rows
from lumen.language.people import PersonName

_log = logging.getLogger(__name__)


class FeatureForgetter:
    """A forgetter that calls every feature; `find` returns the part or service of a class in this process, or None.

    If code of an installed package fails, the other features still forget. The log then has only the type of the error,
    because its message may contain the name.
    """

    def __init__(self, find: Callable[[type[Any]], Any]) -> None:
        self._find = find

    def forget(self, person: PersonName) -> None:
        """Call the forgetting function, or the `forget` of the part, of each feature's row."""
        for feature, where in rows("forgets"):
            try:
                self._forget(resolve(where), person)
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # even SystemExit
                if (distribution := distribution_of(feature)) is None:
                    raise
                kind = type(error).__name__
                _log.error("a person is not forgotten by `%s` of the package %s: %s", where, distribution, kind)

    def _forget(self, named: Any, person: PersonName) -> None:
        if not isinstance(named, type):
            named(person)
        elif (one := self._find(named)) is not None:
            one.forget(person)
