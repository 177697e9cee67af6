"""Rows of `hears` as guards of ordinary transitions.

A row is taken if its phrase matches, its own guard is true, and no better row of its state is taken. Of two rows, the
one whose phrase has more words is better, else the upper one. `else` rows and rows without a word of their own are
late: they are evaluated only if no state has taken another transition.
"""

from collections.abc import Callable, Mapping
from functools import partial

from lumen.expressions import ExpressionError, Scope
from lumen.language.machines import MachineDefinition
from lumen.talk.hearing import Hearing, Taken, hearing_of, said_in

RowGuard = Callable[[Scope], bool]


class RowBlock:
    """The `hears` rows of one state; `own` has the guard written in each row, by the row's number."""

    __slots__ = ("_any", "_hearing", "_machine", "_own")

    def __init__(self, machine: MachineDefinition, own: Mapping[int, RowGuard | None]) -> None:
        self._machine, self._own, self._any = machine, own, next(iter(own))
        self._hearing: Hearing | None = None  # compiled when the first sentence is heard

    def guards(self, number: int) -> tuple[RowGuard, RowGuard]:
        """Return the guard of a row, and its guard for the late passes."""
        return partial(self._holds, number, False), partial(self._holds, number, True)

    def chosen(self, scope: Scope, late: bool = False) -> int:
        """Return the number of the row that is taken, or -1; raise ExpressionError if a guard fails."""
        for number, _ in self._order(scope, late):
            guard = self._own[number]
            if guard is None or guard(scope):
                return number
        return -1

    def chosen_late(self, scope: Scope) -> int:
        """Return the number of the late row that is taken, or -1; raise ExpressionError if a guard fails."""
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
        """Return True if this row is the best one whose own guard is true.

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
