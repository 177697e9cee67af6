"""Builds a Python code object from the tree of an expression, node by node: no text of a user is ever executed.

The code uses only names of this package's functions; a path becomes subscripts, so that no attribute of a Python object
can be reached. The line number of an instruction is the number of its node (in the order of `walk`, from 1), from which
`explain` finds the place of a failure.
"""

import ast
from itertools import count
from types import CodeType

from lumen.expressions.error_explanation import EXPRESSION_FILE
from lumen.expressions.function_table import all_functions
from lumen.expressions.kinds import BOOLEAN
from lumen.expressions.scope import MAX_INT, MIN_INT, Scope
from lumen.expressions.tree import (
    Binary,
    Conditional,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    ListLiteral,
    Literal,
    Logic,
    MapLiteral,
    Unary,
    walk,
)

OPERATOR_FUNCTIONS = {
    "==": "equal", "<": "less", "<=": "at_most", ">": "greater", ">=": "at_least", "in": "contained",
    "+": "add", "-": "subtract", "*": "multiply", "/": "divide", "%": "remainder",
}  # fmt: skip
_ORDER = {"<": ast.Lt, "<=": ast.LtE, ">": ast.Gt, ">=": ast.GtE}
_SHIFT = {"+": ast.Add, "-": ast.Sub}
_YES_OR_NO = {"==", "!=", "<", "<=", ">", ">=", "in"}


def is_condition(node: ExpressionNode) -> bool:
    """Return True if the node's value can only be a boolean."""
    match node:
        case Literal(value=bool()) | Logic() | Unary(sign="!"):
            return True
        case Binary(sign=sign):
            return sign in _YES_OR_NO
        case FunctionCall(function=function):
            return all_functions()[function].returns == {BOOLEAN}
        case Conditional(then=then, otherwise=otherwise):
            return is_condition(then) and is_condition(otherwise)
    return False


def _builds(tree: ExpressionNode) -> bool:
    """Return True if the expression can create a new list, map or text."""
    if is_condition(tree):
        return False
    return any(
        isinstance(n, ListLiteral | MapLiteral) or (isinstance(n, Binary) and n.sign == "+") for n, _ in walk(tree)
    )


class CodeBuilder:
    """Builds the Python tree of one expression."""

    def __init__(self, tree: ExpressionNode, *, careful: bool) -> None:
        self.tree, self.careful = tree, careful
        self.numbers = {id(node): number for number, (node, _) in enumerate(walk(tree), 1)}
        self.temporary = count()

    def code(self, guard: bool) -> CodeType:
        """Return the code of a module that defines `evaluate(scope)`."""
        result = self.place(self.result(guard), self.tree)
        failed = self.call("failed", _load("error"), _load("scope"))
        handler = ast.ExceptHandler(_load("Exception"), "error", [ast.Return(failed)])
        body: list[ast.stmt] = [ast.Try([ast.Return(result)], [handler], [], [])]
        scope = ast.arguments([], [ast.arg("scope")], None, [], [], None, [])
        define = ast.FunctionDef("evaluate", scope, body, [])
        define.lineno = define.end_lineno = 1
        module = ast.fix_missing_locations(ast.Module([define], []))
        return compile(module, EXPRESSION_FILE, "exec", dont_inherit=True, optimize=0)

    def result(self, guard: bool) -> ast.expr:
        """Return the node of the whole expression: a boolean for a guard, else bounded if it creates a value."""
        if guard:
            return self.condition(self.tree)
        built = self.node(self.tree)
        return self.call("bounded", built) if _builds(self.tree) else built

    def node(self, node: ExpressionNode) -> ast.expr:
        """Return the Python node for a node of the expression, with its place."""
        return self.place(self.build(node), node)

    def place(self, built: ast.expr, node: ExpressionNode) -> ast.expr:
        """Return the Python node, with the number of the expression's node as its line number."""
        built.lineno = built.end_lineno = self.numbers[id(node)]
        built.col_offset = built.end_col_offset = 0
        return built

    def call(self, name: str, *arguments: ast.expr) -> ast.expr:
        """Return the Python node of a call of a function by name."""
        return ast.Call(_load(name), list(arguments), [])

    def condition(self, node: ExpressionNode) -> ast.expr:
        """Return the Python node for a node of the expression, with a check that its value is a boolean."""
        built = self.node(node)
        if is_condition(node):
            return built
        value, again = self.named(built)
        yes = ast.Compare(value, [ast.Is()], [ast.Constant(True)])
        no = ast.Compare(again, [ast.Is()], [ast.Constant(False)])
        test = ast.BoolOp(ast.Or(), [yes, no])
        return self.place(ast.IfExp(test, again, self.call("truth", again)), node)

    def named(self, value: ast.expr) -> tuple[ast.expr, ast.expr]:
        """Return an assignment of the value to a new variable, and a read of that variable."""
        name = f"v{next(self.temporary)}"
        return ast.NamedExpr(ast.Name(name, ast.Store()), value), _load(name)

    def hidden(self, node: ExpressionNode) -> ast.expr:
        """Return the Python node, hidden from Python's constant check, which warns about `1['a']` and `1 is None`."""
        built = self.node(node)
        return (
            built if isinstance(node, Identifier | FieldAccess | IndexAccess | FunctionCall) else self.named(built)[0]
        )

    def build(self, node: ExpressionNode) -> ast.expr:
        """Return the Python node for a node of the expression, without its place."""
        match node:
            case Literal(value=value):
                return ast.Constant(value)
            case Identifier(name=name):
                return _at(_load("scope"), Scope._fields.index(name))
            case FieldAccess(base=base, name=name):
                return _at(self.hidden(base), name)
            case IndexAccess(base=base, key=Literal(value=str() as key)):
                return _at(self.hidden(base), key)
            case ListLiteral(items=items):
                return ast.List([self.node(item) for item in items], ast.Load())
            case MapLiteral(keys=keys, values=entries):
                return ast.Dict([ast.Constant(key) for key in keys], [self.node(value) for value in entries])
            case Logic(sign=sign, operands=operands):
                return self.logic(sign, [self.condition(operand) for operand in operands])
            case Conditional(condition=condition, then=then, otherwise=otherwise):
                return ast.IfExp(self.condition(condition), self.node(then), self.node(otherwise))
            case Binary(sign=sign, left=left, right=right):
                return self.binary(sign, left, right)
            case Unary(sign="!", operand=operand) if is_condition(operand):
                return ast.UnaryOp(ast.Not(), self.node(operand))
            case Unary(sign=sign, operand=operand):
                return self.call("negation" if sign == "!" else "negative", self.node(operand))
            case IndexAccess(base=base, key=index):
                return self.call("item", self.node(base), self.node(index))
            case FunctionCall(function="has", arguments=(target,)):
                return self.has(target)
            case FunctionCall(function=function, arguments=arguments):
                first = [_load("scope")] if all_functions()[function].scoped else []
                return self.call(f"call_{function}", *first, *map(self.node, arguments))

    def logic(self, sign: str, operands: list[ast.expr]) -> ast.expr:
        """Return the node of `&&` or `||`; in careful mode, the other operands may decide despite an error of one."""
        if not self.careful:
            return ast.BoolOp(ast.And() if sign == "&&" else ast.Or(), operands)
        nothing = ast.arguments([], [], None, [], [], None, [])
        return self.call("both" if sign == "&&" else "either", *(ast.Lambda(nothing, o) for o in operands))

    def has(self, target: ExpressionNode) -> ast.expr:
        """Return the node of `has(a.b.c)`: it tests the keys in turn, without a call as long as the maps are dicts."""
        keys: list[ast.expr] = []
        while isinstance(target, FieldAccess | IndexAccess):
            keys.append(ast.Constant(target.name) if isinstance(target, FieldAccess) else self.node(target.key))
            target = target.base
        return self.reaches(self.node(target), keys[::-1])

    def reaches(self, base: ast.expr, keys: list[ast.expr]) -> ast.expr:
        """Return the node that tests whether `keys` lead to a value from `base`."""
        if not keys or not isinstance(keys[0], ast.Constant):
            return self.call("has", base, *keys)
        value, again = self.named(base)
        inside: ast.expr = ast.Compare(keys[0], [ast.In()], [again])
        if keys[1:]:
            following = self.reaches(ast.Subscript(again, keys[0], ast.Load()), keys[1:])
            inside = ast.BoolOp(ast.And(), [inside, following])
        is_map = ast.Compare(self.call("type", value), [ast.Is()], [_load("map")])
        return ast.IfExp(is_map, inside, self.call("has", again, *keys))

    def binary(self, sign: str, left: ExpressionNode, right: ExpressionNode) -> ast.expr:
        """Return the node of a binary operator, specialized for literals on the right."""
        if sign in ("==", "!=") and isinstance(right, Literal):
            return self.equals_literal(sign, left, right)
        if sign == "!=":
            return ast.UnaryOp(ast.Not(), self.call("equal", self.node(left), self.node(right)))
        if sign in _ORDER and isinstance(right, Literal) and type(right.value) in (int, float):
            return self.compares_number(sign, left, right)
        if sign in _SHIFT and isinstance(right, Literal) and type(right.value) is int:
            return self.adds_number(sign, left, right)
        return self.call(OPERATOR_FUNCTIONS[sign], self.node(left), self.node(right))

    def equals_literal(self, sign: str, left: ExpressionNode, right: Literal) -> ast.expr:
        """Return the node of `left == literal`, without a call except for 0 and 1, which equal booleans in Python."""
        identity = right.value is None or isinstance(right.value, bool)
        negated = sign == "!="
        if not identity and right.value in (0, 1):
            same = self.call("equal", self.node(left), self.node(right))
            return ast.UnaryOp(ast.Not(), same) if negated else same
        if identity:
            operator: ast.cmpop = ast.IsNot() if negated else ast.Is()
        else:
            operator = ast.NotEq() if negated else ast.Eq()
        return ast.Compare(self.hidden(left), [operator], [self.node(right)])

    def compares_number(self, sign: str, left: ExpressionNode, right: Literal) -> ast.expr:
        """Return the node of `left < number`: direct if `left` is a number, with all checks otherwise."""
        value, again = self.named(self.node(left))
        is_number = ast.Compare(self.call("type", value), [ast.In()], [_load("numbers")])
        fast = ast.Compare(again, [_ORDER[sign]()], [ast.Constant(right.value)])
        return ast.IfExp(is_number, fast, self.call(OPERATOR_FUNCTIONS[sign], again, ast.Constant(right.value)))

    def adds_number(self, sign: str, left: ExpressionNode, right: Literal) -> ast.expr:
        """Return the node of `left + number`: direct if both are integers with a sum in range, else with all checks."""
        value, again = self.named(self.node(left))
        total, sum_ = self.named(ast.BinOp(again, _SHIFT[sign](), ast.Constant(right.value)))
        is_whole = ast.Compare(self.call("type", value), [ast.Is()], [_load("whole")])
        fits = ast.Compare(ast.Constant(MIN_INT), [ast.LtE(), ast.LtE()], [total, ast.Constant(MAX_INT)])
        slow = self.call(OPERATOR_FUNCTIONS[sign], again, ast.Constant(right.value))
        return ast.IfExp(ast.BoolOp(ast.And(), [is_whole, fits]), sum_, slow)


def _load(name: str) -> ast.expr:
    return ast.Name(name, ast.Load())


def _at(base: ast.expr, key: int | str) -> ast.expr:
    return ast.Subscript(base, ast.Constant(key), ast.Load())
