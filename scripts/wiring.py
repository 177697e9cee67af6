"""Find the places at which an exhibition is composed, and at which its parts are connected after their creation."""

import ast
from collections import defaultdict
from collections.abc import Iterator

from callables import Callables, Held
from scopes import OWN, Function, Package, Place, Scoped, assigned, is_property, last_word, parameters

SEAMS = {"bus", "clock", "robot"}
"""The objects that access the world, by the last word of their names in the code."""
SEAM_TYPES = {"Bus", "Clock", "Robot"}
PORTS = "ports/"
"""The folder whose protocols are the seams and their abilities."""
ADDING = {"append", "appendleft", "add", "extend", "insert", "setdefault", "update"}
"""The methods that put a value into a list, a set or a table."""
CONSTRUCTORS = {"__init__", "__post_init__", "__new__"}


def composition_sites(package: Package) -> list[Place]:
    """Return the files that make a node, or make a part other than to return it, as the one function of a row does."""
    parts, nodes = package.family("Part"), package.family("Node")
    returned = {
        id(value)
        for scoped in package.of(ast.Return)
        for value in ([scoped.node.value.body, scoped.node.value.orelse] if _is_choice(scoped) else [scoped.node.value])
    }
    made: dict[str, dict[str, int]] = defaultdict(dict)
    for scoped in package.of(ast.Call):
        name = last_word(scoped.node.func)
        if name in nodes or (name in parts and id(scoped.node) not in returned):
            made[scoped.file.path].setdefault(name, scoped.node.lineno)
    return [Place(path, min(lines.values()), f"makes {', '.join(lines)}") for path, lines in made.items()]


def _is_choice(scoped: Scoped) -> bool:
    return isinstance(scoped.node, ast.Return) and isinstance(scoped.node.value, ast.IfExp)


def seam_probes(package: Package) -> list[Place]:
    """Return the lines that probe a bus, a clock or a robot with `getattr` or `hasattr`.

    An expression is such an object if its last name ends in one of `SEAMS`, if its annotation names a seam or one of
    the protocols of `PORTS`, or if the file assigns it from such an expression. Raises LookupError if there are no such
    protocols, because then the folder has another name.
    """
    types = {
        scoped.node.name
        for scoped in package.of(ast.ClassDef)
        if scoped.file.path.startswith(PORTS) and any(last_word(base) == "Protocol" for base in scoped.node.bases)
    }
    if not types:
        raise LookupError(f"no class in {PORTS} is a Protocol")
    names = _seam_names(package, types | SEAM_TYPES)
    probes = {
        (scoped.file.path, scoped.node.lineno, ast.unparse(scoped.node))
        for scoped in package.of(ast.Call)
        if isinstance(scoped.node.func, ast.Name) and scoped.node.func.id in ("getattr", "hasattr")
        if scoped.node.args and _is_seam(scoped.node.args[0], names[scoped.file.path])
    }
    lines: dict[tuple[str, int], str] = {}
    for path, line, text in sorted(probes):
        lines.setdefault((path, line), text)
    return [Place(path, line, text) for (path, line), text in lines.items()]


def _seam_names(package: Package, types: set[str]) -> dict[str, set[str]]:
    """Return the names in each file that are annotated as a seam, or assigned from one."""
    found: dict[str, set[str]] = defaultdict(set)
    for scoped in package.of(ast.FunctionDef, ast.AsyncFunctionDef, ast.AnnAssign):
        node = scoped.node
        pairs = [(node.target, node.annotation)] if isinstance(node, ast.AnnAssign) else []
        if isinstance(node, Function):
            found[scoped.file.path] |= {
                each.arg for each in parameters(node) if each.annotation and _names_type(each.annotation, types)
            }
        found[scoped.file.path] |= {last_word(target) for target, type_ in pairs if _names_type(type_, types)}
    for scoped in package.of(ast.Assign):
        for target, value in assigned(scoped.node):
            if value is not None and _is_seam(value, found[scoped.file.path]):
                found[scoped.file.path].add(last_word(target))
    return found


def _names_type(annotation: ast.expr, types: set[str]) -> bool:
    """Return True if an annotation is one of these types, or a union with one."""
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        return _names_type(ast.parse(annotation.value, mode="eval").body, types)
    if isinstance(annotation, ast.BinOp):
        return _names_type(annotation.left, types) or _names_type(annotation.right, types)
    return not isinstance(annotation, ast.Subscript) and last_word(annotation) in types


def _is_seam(expression: ast.expr, names: set[str]) -> bool:
    if not isinstance(expression, ast.Name | ast.Attribute):
        return False
    name = last_word(expression)
    return name.rpartition("_")[2].lower() in SEAMS or name in names


def assigned_callables(package: Package, callables: Callables) -> list[Place]:
    """Return the assignments of a callable to an attribute of another object, if a class of the package has it."""
    found = []
    for scoped in package.of(ast.Assign, ast.AnnAssign):
        for target, value in assigned(scoped.node):
            if isinstance(target, ast.Attribute) and not _is_own(target.value) and callables.has(target.attr):
                known = callables.held(target, scoped) is Held.CALLABLE and not _is_none(value)
                if known or callables.is_callable(value, scoped):
                    found.append(scoped.place(_assignment(target, value)))
    for scoped in package.of(ast.Call):
        match scoped.node:
            case ast.Call(func=ast.Name("setattr"), args=[receiver, name, value]) if not _is_own(receiver):
                if callables.is_callable(value, scoped):
                    found.append(scoped.place(f"setattr({ast.unparse(receiver)}, {ast.unparse(name)}, …)"))
    return found


def _is_none(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Constant) and value.value is None


def _is_own(expression: ast.expr) -> bool:
    return isinstance(expression, ast.Name) and expression.id in OWN


def _assignment(target: ast.expr, value: ast.expr | None) -> str:
    shown = "…" if value is None else "lambda" if isinstance(value, ast.Lambda) else ast.unparse(value)
    return f"{ast.unparse(target)} = {shown}"


def added_callables(package: Package, callables: Callables) -> list[Place]:
    """Return the callables added to a list, a set or a table that is an attribute of another object."""
    found = []
    for scoped in package.of(ast.Call, ast.AugAssign, ast.Assign):
        for collection, value in _added(scoped.node):
            anothers = isinstance(collection, ast.Attribute) and not _is_own(collection.value)
            if anothers and callables.has(last_word(collection)) and callables.is_or_holds(value, scoped):
                found.append(scoped.place(f"{ast.unparse(collection)} gets {ast.unparse(value)[:60]}"))
    return found


def _added(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the collections that a statement changes, each with a value that it adds."""
    match node:
        case ast.Call(func=ast.Attribute(value=collection, attr=method), args=values) if method in ADDING:
            yield from ((collection, each) for value in values for each in _elements(value))
        case ast.AugAssign(target=collection, op=ast.Add(), value=value):
            yield from ((collection, each) for each in _elements(value))
        case ast.Assign(targets=[ast.Subscript(value=collection)], value=value):
            yield from ((collection, each) for each in _elements(value))


def _elements(value: ast.expr) -> list[ast.expr]:
    return value.elts if isinstance(value, ast.List | ast.Tuple | ast.Set) else [value]


def storing_methods(package: Package, callables: Callables) -> list[Place]:
    """Return the methods, other than constructors, that only store a callable parameter."""
    found = []
    for scoped in package.of(ast.FunctionDef):
        method = scoped.node
        if scoped.owner is None or scoped.functions or method.name in CONSTRUCTORS:
            continue
        given = {each.arg for each in parameters(method) if callables.kind(each.annotation) is Held.CALLABLE}
        body = [each for each in method.body if not _is_docstring(each)]
        if given and body and all(_stores(each) for each in body) and any(_reads(each, given) for each in body):
            setter = "property" if is_property(method) else "method"
            found.append(scoped.place(f"{setter} {scoped.owner.name}.{method.name} stores {', '.join(sorted(given))}"))
    return found


def _is_docstring(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _stores(node: ast.stmt) -> bool:
    """Return True if a statement only changes an attribute of the object, or of an object that it contains."""
    match node:
        case ast.Assign() | ast.AugAssign() | ast.AnnAssign():
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            return all(_is_within_own(each) for target in targets for each in _elements(target))
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=collection, attr=method))):
            return method in ADDING and _is_within_own(collection)
    return False


def _is_within_own(expression: ast.expr) -> bool:
    while isinstance(expression, ast.Attribute | ast.Subscript):
        expression = expression.value
        if _is_own(expression):
            return True
    return False


def _reads(node: ast.stmt, names: set[str]) -> bool:
    return any(isinstance(each, ast.Name) and each.id in names for each in ast.walk(node))
