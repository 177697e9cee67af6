"""Rows of `hears` as guards of ordinary transitions.

A row is taken if its phrase is found, its own guard is true, and no better row of its state is taken. The better of two
rows is the one whose phrase has more words, else the upper one. Rows without a word of their own and `else` are late:
they are asked only if no state has taken anything else.
"""

from collections.abc import Callable, Mapping
from functools import partial

from lumen.expressions import ExpressionError, Scope
from lumen.language.machines import MachineDefinition
from lumen.talk.hearing import Hearing, Taken, hearing_of, said_in

RowGuard = Callable[[Scope], bool]


class RowBlock:
    """The rows of one state; `own` are the guards that they have themselves, by the numbers of the rows."""

    __slots__ = ("_any", "_hearing", "_machine", "_own")

    def __init__(self, machine: MachineDefinition, own: Mapping[int, RowGuard | None]) -> None:
        self._machine, self._own, self._any = machine, own, next(iter(own))
        self._hearing: Hearing | None = None  # not made before somebody speaks

    def guards(self, number: int) -> tuple[RowGuard, RowGuard]:
        """The guard of a row, and its guard when it is late."""
        return partial(self._holds, number, False), partial(self._holds, number, True)

    def chosen(self, scope: Scope, late: bool = False) -> int:
        """Return the number of the row that is taken, or -1; raise ExpressionError if a guard fails."""
        for number, _ in self._order(scope, late):
            guard = self._own[number]
            if guard is None or guard(scope):
                return number
        return -1

    def chosen_late(self, scope: Scope) -> int:
        """Return the number of the late row that is taken, as `chosen`."""
        return self.chosen(scope, True)

    def _order(self, scope: Scope, late: bool) -> tuple[Taken, ...]:
        hearing = self._hearing
        if hearing is None:
            hearing = self._hearing = hearing_of(self._machine)
        return hearing.order(self._any, said_in(scope.event), scope.context)[late]

    def _is_true(self, taken: Taken, scope: Scope) -> bool:
        guard = self._own[taken.number]
        return guard is None or guard(scope)

    def _holds(self, number: int, late: bool, scope: Scope) -> bool:
        """Whether this row is the first one whose own guard is true.

        Raises ExpressionError if the row's own guard fails; a better row whose guard fails is not taken.
        """
        order = self._order(scope, late)
        if not any(one.number == number for one in order):
            return False
        for one in order:
            if one.number == number:
                return self._is_true(one, scope)
            try:
                if self._is_true(one, scope):
                    return False
            except ExpressionError:
                continue
        return False
