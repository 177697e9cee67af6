"""Find the expressions of a package that are callables, by its annotations, constructors and definitions."""

import ast
from collections import defaultdict
from enum import Enum
from functools import cached_property

from scopes import OWN, Function, Package, Scoped, assigned, is_property, last_word, parameters

MAX_STEPS = 8
"""Steps from a name to the value assigned to it, and so on, after which its class counts as unknown."""


class Held(Enum):
    """The kinds of values that an attribute holds."""

    CALLABLE = "a callable"
    CALLABLES = "a collection of callables"
    OTHER = "another value"


class Callables:
    """The callables of a package.

    The class of an expression is derived from annotations and constructor calls. If it is unknown, an attribute counts
    as a callable if it is one in all classes that have an attribute or a method of that name.
    """

    def __init__(self, package: Package) -> None:
        self._package = package

    def is_callable(self, value: ast.expr | None, at: Scoped) -> bool:
        """Return whether a value is a callable."""
        match value:
            case ast.Lambda():
                return True
            case ast.Call():
                return last_word(value.func) == "partial" or last_word(value.func) in self._returning
            case ast.IfExp():
                return self.is_callable(value.body, at) or self.is_callable(value.orelse, at)
            case ast.BoolOp():
                return any(self.is_callable(each, at) for each in value.values)
            case ast.Name():
                return self._is_callable_name(value.id, at)
            case ast.Attribute():
                held = self.held(value, at)
                return held is Held.CALLABLE or (held is None and value.attr in self._only_methods)
        return False

    def is_or_holds(self, value: ast.expr, at: Scoped) -> bool:
        """Return whether a value is a callable, or a parameter that is a collection of callables."""
        annotations = [each.annotation for f in at.functions for each in parameters(f) if each.arg == last_word(value)]
        collection = isinstance(value, ast.Name) and any(self.kind(each) is Held.CALLABLES for each in annotations)
        return collection or self.is_callable(value, at)

    def held(self, attribute: ast.Attribute, at: Scoped) -> Held | None:
        """Return the kind of an attribute's value, as its class declares it, else None; a method is a callable."""
        if owner := self._class_of(attribute.value, at):
            for name in self._package.ancestors(owner):
                if attribute.attr in self._methods[name]:
                    return Held.CALLABLE
                if kinds := self._attributes[name].get(attribute.attr):
                    return next((kind for kind in (Held.CALLABLE, Held.CALLABLES) if kind in kinds), Held.OTHER)
        everywhere = self._everywhere.get(attribute.attr, set())
        return next(iter(everywhere)) if len(everywhere) == 1 and attribute.attr not in self._method_names else None

    def has(self, name: str) -> bool:
        """Return whether a class of the package declares an attribute of that name."""
        return name in self._everywhere

    def kind(self, annotation: ast.expr | None) -> Held:
        """Return the kind of values that an annotation allows; an optional callable is a callable."""
        match annotation:
            case ast.Constant(value=str(text)):
                return self.kind(ast.parse(text, mode="eval").body)
            case ast.BinOp():
                sides = {self.kind(annotation.left), self.kind(annotation.right)}
                return next((kind for kind in (Held.CALLABLE, Held.CALLABLES) if kind in sides), Held.OTHER)
            case ast.Name() | ast.Attribute() | ast.Subscript() if last_word(annotation) in self._types:
                return Held.CALLABLE
            case ast.Subscript() if any(last_word(each) in self._types for each in _names(annotation.slice)):
                return Held.CALLABLES
        return Held.OTHER

    @cached_property
    def _types(self) -> set[str]:
        """Return `Callable`, its aliases, and the protocols with a `__call__` method."""
        found = {"Callable"}
        for scoped in self._package.of(ast.Assign):
            value = scoped.node.value
            if not scoped.functions and isinstance(value, ast.Subscript) and last_word(value) == "Callable":
                found |= {last_word(target) for target in scoped.node.targets}
        for scoped in self._package.of(ast.ClassDef):
            members = {member.name for member in scoped.node.body if isinstance(member, Function)}
            if "__call__" in members and any(last_word(base) == "Protocol" for base in scoped.node.bases):
                found.add(scoped.node.name)
        return found

    @cached_property
    def _returning(self) -> set[str]:
        """Return the names of the functions that return a callable, or None."""
        functions = [scoped.node for scoped in self._package.of(ast.FunctionDef, ast.AsyncFunctionDef)]
        other = {each.name for each in functions if self.kind(each.returns) is not Held.CALLABLE}
        return {each.name for each in functions} - other

    @cached_property
    def _methods(self) -> dict[str, set[str]]:
        """Return the names of the methods of each class, without properties."""
        found: dict[str, set[str]] = defaultdict(set)
        for scoped in self._package.of(ast.FunctionDef, ast.AsyncFunctionDef):
            if scoped.owner and not scoped.functions and not is_property(scoped.node):
                found[scoped.owner.name].add(scoped.node.name)
        return found

    @cached_property
    def _method_names(self) -> set[str]:
        return set().union(*self._methods.values())

    @cached_property
    def _only_methods(self) -> set[str]:
        return self._method_names - self._everywhere.keys()

    @cached_property
    def _attributes(self) -> dict[str, dict[str, set[Held]]]:
        """Return the attributes of each class, with the kinds of the values that it assigns to them."""
        found: dict[str, dict[str, set[Held]]] = defaultdict(lambda: defaultdict(set))
        for scoped in self._package.of(ast.AnnAssign, ast.Assign, ast.FunctionDef):
            if scoped.owner is None:
                continue
            own, node = found[scoped.owner.name], scoped.node
            if isinstance(node, ast.FunctionDef):
                if not scoped.functions and is_property(node):
                    own[node.name].add(self.kind(node.returns))
            elif isinstance(node, ast.AnnAssign):
                if name := _own_attribute(node.target, scoped):
                    own[name].add(self.kind(node.annotation))
            else:
                for target, value in assigned(node):
                    if name := _own_attribute(target, scoped):
                        own[name].add(self._given(value, scoped))
        return found

    def _given(self, value: ast.expr | None, at: Scoped) -> Held:
        """Return the kind of a value that a class assigns to its attribute; a parameter has that of its annotation."""
        if isinstance(value, ast.Name):
            for parameter in (each for function in at.functions for each in parameters(function)):
                if parameter.arg == value.id:
                    return self.kind(parameter.annotation)
        return Held.CALLABLE if isinstance(value, ast.Lambda) else Held.OTHER

    @cached_property
    def _everywhere(self) -> dict[str, set[Held]]:
        """Return the kinds of values of all attributes of each name, whatever their class."""
        found: dict[str, set[Held]] = defaultdict(set)
        for own in self._attributes.values():
            for name, kinds in own.items():
                found[name] |= kinds
        return found

    def _is_callable_name(self, name: str, at: Scoped) -> bool:
        for function in reversed(at.functions):
            for parameter in parameters(function):
                if parameter.arg == name:
                    return self.kind(parameter.annotation) is Held.CALLABLE
        return name in self._functions[at.file.path]

    @cached_property
    def _functions(self) -> dict[str, set[str]]:
        """Return the names of functions that each file defines, at any depth, or imports from the package."""
        found: dict[str, set[str]] = defaultdict(set)
        for scoped in self._package.of(ast.FunctionDef, ast.AsyncFunctionDef):
            if scoped.owner is None or scoped.functions:
                found[scoped.file.path].add(scoped.node.name)
        everywhere = set().union(*found.values())
        for scoped in self._package.of(ast.ImportFrom):
            if (scoped.node.module or "").partition(".")[0] == scoped.file.module.partition(".")[0]:
                names = {alias.asname or alias.name for alias in scoped.node.names if alias.name in everywhere}
                found[scoped.file.path] |= names
        return found

    def _class_of(self, expression: ast.expr | None, at: Scoped, steps: int = MAX_STEPS) -> str:
        """Return the name of the class of an expression; empty if it is unknown, or not a class of the package."""
        if steps == 0:
            return ""
        match expression:
            case ast.Name(id="self"):
                return at.owner.name if at.owner else ""
            case ast.Name():
                return self._class_of_name(expression.id, at, steps - 1)
            case ast.Attribute():
                owner = self._class_of(expression.value, at, steps - 1)
                for name in self._package.ancestors(owner):
                    if found := self._made.get((name, expression.attr)):
                        return self._class_of_source(*found, steps - 1)
            case ast.IfExp():
                body = self._class_of(expression.body, at, steps - 1)
                return body or self._class_of(expression.orelse, at, steps - 1)
            case ast.Call():
                name = last_word(expression.func)
                return name if name in self._package.classes else ""
        return ""

    def _class_of_name(self, name: str, at: Scoped, steps: int) -> str:
        for function in reversed(at.functions):
            for parameter in parameters(function):
                if parameter.arg == name:
                    return self._annotated(parameter.annotation)
            if found := self._local.get((id(function), name)):
                return self._class_of_source(*found, steps)
        return ""

    def _class_of_source(self, annotation: ast.expr | None, value: ast.expr | None, at: Scoped, steps: int) -> str:
        return self._annotated(annotation) or self._class_of(value, at, steps)

    def _annotated(self, annotation: ast.expr | None) -> str:
        """Return the class of the package that an annotation names, alone or in a union."""
        if isinstance(annotation, ast.BinOp):
            return self._annotated(annotation.left) or self._annotated(annotation.right)
        if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
            return self._annotated(ast.parse(annotation.value, mode="eval").body)
        found = last_word(annotation) if isinstance(annotation, ast.Name | ast.Attribute) else ""
        return found if found in self._package.classes else ""

    @cached_property
    def _local(self) -> dict[tuple[int, str], tuple[ast.expr | None, ast.expr | None, Scoped]]:
        """Return the first assignment to each name in a function: its annotation and value."""
        found: dict[tuple[int, str], tuple[ast.expr | None, ast.expr | None, Scoped]] = {}
        for scoped in self._package.of(ast.AnnAssign, ast.Assign):
            for target, value in assigned(scoped.node) if scoped.functions else ():
                if isinstance(target, ast.Name):
                    annotation = scoped.node.annotation if isinstance(scoped.node, ast.AnnAssign) else None
                    found.setdefault((id(scoped.functions[-1]), target.id), (annotation, value, scoped))
        return found

    @cached_property
    def _made(self) -> dict[tuple[str, str], tuple[ast.expr | None, ast.expr | None, Scoped]]:
        """Return the first assignment to each attribute of a class: its annotation and value."""
        found: dict[tuple[str, str], tuple[ast.expr | None, ast.expr | None, Scoped]] = {}
        for scoped in self._package.of(ast.AnnAssign, ast.Assign):
            for target, value in assigned(scoped.node) if scoped.owner else ():
                if name := _own_attribute(target, scoped):
                    annotation = scoped.node.annotation if isinstance(scoped.node, ast.AnnAssign) else None
                    found.setdefault((scoped.owner.name, name), (annotation, value, scoped))
        for scoped in self._package.of(ast.FunctionDef):
            if scoped.owner and not scoped.functions and is_property(scoped.node):
                found.setdefault((scoped.owner.name, scoped.node.name), (scoped.node.returns, None, scoped))
        return found


def _names(expression: ast.expr) -> list[ast.expr]:
    return [each for each in ast.walk(expression) if isinstance(each, ast.Name | ast.Attribute)]


def _own_attribute(target: ast.expr, at: Scoped) -> str:
    """Return the attribute that a class declares by this target, in its body or on `self`; else empty."""
    if isinstance(target, ast.Name):
        return "" if at.functions else target.id
    own = isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and target.value.id in OWN
    return target.attr if own else ""
