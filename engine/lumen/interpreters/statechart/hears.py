"""Rows of `hears` as guards of ordinary transitions.

A row is taken if its phrase is found, its own guard is true, and no better row of its state is taken. The better of two
rows is the one whose phrase has more words, else the upper one. Rows without a word of their own and `else` are late:
they are asked only if no state has taken anything else.
"""

from collections.abc import Callable, Mapping

from lumen.interpreters.expressions import ExpressionError, Scope
from lumen.interpreters.talk.hearing import Taken, hearing_of, said_in
from lumen.language.machines import MachineDefinition

CompiledGuard = Callable[[Scope], bool]


def row_guards(
    machine: MachineDefinition, number: int, own: Mapping[int, CompiledGuard | None]
) -> tuple[CompiledGuard, CompiledGuard]:
    """Return the guard of the row with that number, and its late guard; `own` are the guards that the rows have."""

    def first(scope: Scope) -> bool:
        text = said_in(scope.event)
        return bool(text) and _best(hearing_of(machine).order(number, text, scope.context).first, number, own, scope)

    def late(scope: Scope) -> bool:
        order = hearing_of(machine).order(number, said_in(scope.event), scope.context)
        return _best(order.late, number, own, scope)

    return first, late


def _best(taken: tuple[Taken, ...], number: int, own: Mapping[int, CompiledGuard | None], scope: Scope) -> bool:
    """Whether this row is the first of these whose own guard is true.

    Raises ExpressionError if the row's own guard fails; a better row whose guard fails is not taken.
    """
    if not any(one.number == number for one in taken):
        return False
    for one in taken:
        guard = own[one.number]
        if one.number == number:
            return guard is None or guard(scope)
        try:
            if guard is None or guard(scope):
                return False
        except ExpressionError:
            continue
    return False
