"""The figures of the architecture, in small packages of which everything can be counted by hand."""

import ast
from textwrap import dedent

import pytest
from callables import Callables
from closed_lists import ON_PURPOSE, closed_lists, closed_on_purpose
from figures import (
    Figure,
    beyond_ceilings,
    long_functions,
    statement_count,
    unformatted_statements,
    wide_functions,
)
from scopes import Package
from source_files import SourceFile
from wiring import added_callables, assigned_callables, composition_sites, seam_probes, storing_methods

PARTS = {
    "part.py": "class Part: ...\nclass Node: ...\n",
    "bell.py": "class BellPart(Part): ...\nclass LoudBellPart(BellPart): ...\n",
}


def package(files: dict[str, str]) -> Package:
    return Package([_file(path, dedent(text)) for path, text in files.items()])


def _file(path: str, text: str) -> SourceFile:
    return SourceFile(path, f"lumen.{path.removesuffix('.py').replace('/', '.')}", text, ast.parse(text))


def listed(found: object) -> list[str]:
    return [str(place) for place in found]  # type: ignore[attr-defined]


def test_a_file_that_makes_a_node_or_gives_a_part_away_composes() -> None:
    files = {
        "compose.py": "def compose(rows):\n    return Node([row() for row in rows])\n",
        "run.py": "def run(node):\n    node.add(LoudBellPart())\n    node.add(BellPart())\n",
        "several.py": "def make():\n    return [BellPart(), BellPart()]\n",
    }
    assert listed(composition_sites(package(PARTS | files))) == [
        "compose.py:2: makes Node",
        "run.py:2: makes LoudBellPart, BellPart",
        "several.py:2: makes BellPart",
    ]


def test_a_function_that_only_returns_a_new_part_composes_nothing() -> None:
    rows = (
        "def make(plan):\n    return BellPart(plan)\n\n\ndef perhaps(plan):\n    return BellPart() if plan else None\n"
    )
    assert composition_sites(package(PARTS | {"rows.py": rows})) == []


def test_composition_is_not_zero_because_the_parts_have_another_name() -> None:
    with pytest.raises(LookupError, match="no class is named Part"):
        composition_sites(package({"part.py": "class Limb: ...\n"}))


def test_a_probe_of_a_seam_is_found_by_name_by_annotation_and_by_assignment() -> None:
    ports = "class Dozes(Protocol): ...\n"
    code = """
    def nap(self, setup, world: Robot, sleeper: "Dozes | None", bus_url):
        getattr(self._bus, "host", "")
        hasattr(setup.clock, "doze") and hasattr(setup.clock, "hurry")
        getattr(world, "idle", False)
        hasattr(sleeper, "doze")
        inner = self.bus
        getattr(inner, "dropped", {})
        getattr(bus_url, "scheme")
        isinstance(world, Dozes)
    """
    found = seam_probes(package({"ports/world.py": ports, "nap.py": code}))
    assert [place.line for place in found] == [3, 4, 5, 6, 8]


def test_probes_are_not_zero_because_the_ports_have_another_name() -> None:
    with pytest.raises(LookupError, match="no class in ports/ is a Protocol"):
        seam_probes(package({"seams/world.py": "class Dozes(Protocol): ...\n"}))


CALLED = """
    from collections.abc import Callable

    Handler = Callable[[str], None]


    class Bell:
        loud: bool = False

        def __init__(self, ring: Handler | None = None) -> None:
            self.ring = ring
            self.handlers: list[Handler] = []
            self.title = ""

        def call(self) -> None: ...

        def ring_with(self, ring: Handler) -> None:
            '''Ring so.'''
            self.ring = ring

        def listen(self, handler: Handler) -> None:
            self.handlers.append(handler)

        def forward(self, handler: Handler) -> None:
            self.ring_with(handler)

        @property
        def state(self) -> str: ...


    class Door:
        def __init__(self, bell: Bell) -> None:
            self._bell = bell

        def open(self) -> None: ...
"""


def test_a_callable_assigned_to_anothers_attribute_is_found() -> None:
    code = """
    def wire(door: Door, bell: Bell, parser, handler: Handler, handlers: list[Handler]):
        def close(): ...
        bell.ring = lambda text: None
        bell.ring = door.open
        bell.ring = partial(door.open, 1)
        bell.ring = close if door else None
        door._bell.ring = handler
        bell.ring, bell.title = door.open, "x"
        bell.ring = None
        bell.title = bell.state
        bell.loud = True
        parser.on_start = close
        setattr(bell, "ring", close)
    """
    called = package({"bell.py": CALLED, "wire.py": code})
    found = assigned_callables(called, Callables(called))
    assert [place.line for place in found] == [4, 5, 6, 7, 8, 9, 14]


def test_a_class_may_assign_its_own_attributes() -> None:
    code = "class Bell:\n    def silence(self):\n        self.ring = lambda: None\n"
    called = package({"bell.py": code})
    assert assigned_callables(called, Callables(called)) == []


def test_a_callable_put_into_anothers_collection_is_found() -> None:
    code = """
    def wire(door: Door, bell: Bell, handlers: list[Handler], parts: list[Door]):
        bell.handlers.append(door.open)
        bell.handlers += [door.open]
        bell.handlers.extend(handlers)
        bell.handlers["a"] = lambda _: None
        bell.handlers.append(door)
        bell.handlers += parts
    """
    called = package({"bell.py": CALLED, "wire.py": code})
    found = added_callables(called, Callables(called))
    assert sorted(place.line for place in found) == [3, 4, 5, 6]


def test_a_method_that_only_stores_a_callable_is_found() -> None:
    called = package({"bell.py": CALLED})
    assert [place.why for place in storing_methods(called, Callables(called))] == [
        "method Bell.ring_with stores ring",
        "method Bell.listen stores handler",
    ]


READERS = {
    "formats/scxml.py": "def read_scxml(): ...\n",
    "formats/xstate.py": "def read_xstate(): ...\n",
    "formats/fcl.py": "class Fcl: ...\n",
}


def test_a_table_of_what_other_files_define_is_closed() -> None:
    code = """
    from lumen.formats.scxml import read_scxml
    from lumen.formats.xstate import read_xstate
    from lumen.formats import fcl
    from lumen.formats.limits import MOST

    READERS = {".scxml": read_scxml, ".xml": read_scxml, ".json": read_xstate}
    ROWS = (_A := 1, _B := 2)
    _ONE, _TWO = Row(read_scxml), Row(read_xstate)
    TABLE = (_ONE, _TWO, Row(fcl))
    LIMITS = (MOST, MOST + 1, MOST + 2)
    SAME = (read_scxml(1), read_scxml(2), read_scxml(3))
    TWO = (read_scxml, read_xstate)
    """
    assert listed(closed_lists(package(READERS | {"cli.py": code}))) == [
        "cli.py:7: table READERS: read_scxml, read_xstate",
        "cli.py:10: table TABLE: fcl, read_scxml, read_xstate",
    ]


def test_bare_classes_of_one_module_are_a_union_and_rows_with_them_are_a_table() -> None:
    code = """
    from lumen.commands import Say, Play, Walk

    COMPUTED = {Say: "say", Play: "play", Walk: "walk"}
    VERBS = (Verb(Say, "say"), Verb(Play, "play"), Verb(Walk, "walk"))
    """
    assert listed(closed_lists(package({"verbs.py": code}))) == ["verbs.py:5: table VERBS: Play, Say, Walk"]


def test_a_list_that_is_closed_on_purpose_is_counted_apart_with_its_reason() -> None:
    commands = "class Say: ...\nclass Play: ...\nclass Walk: ...\n"
    code = """
    from lumen.language.commands import Say, Play, Walk

    VERBS = (Verb(Say, "say"), Verb(Play, "play"), Verb(Walk, "walk"))
    """
    files = {"language/commands.py": commands, "language/verbs.py": code, "verbs.py": code}
    reason = ON_PURPOSE["language/verbs.py", "VERBS"]
    found = package(files)
    assert listed(closed_on_purpose(found)) == [f"language/verbs.py:4: table VERBS: {reason}"]
    assert listed(closed_lists(found)) == ["verbs.py:4: table VERBS: Play, Say, Walk"]


def test_names_of_the_modules_of_a_folder_are_closed() -> None:
    code = """
    ALL = NAMES = ("scxml", "xstate", "fcl")
    MANY = ("scxml", "xstate", "fcl", "a", "b")
    """
    assert listed(closed_lists(package(READERS | {"cli.py": code}))) == [
        "cli.py:2: names ALL: modules of formats/, fcl, scxml, xstate"
    ]


def test_a_chain_of_branches_that_chooses_a_class_is_closed() -> None:
    code = """
    def make(name, level):
        if name == "nao":
            from lumen.nao import Nao
            return Nao()
        if name in ("none", NONE):
            from lumen.none import NoRobot
            return NoRobot()
        if level == 1:
            return Nao()
        raise UsageError(name)


    def chosen(robot):
        match robot.kind:
            case "nao":
                return Nao()
            case "none":
                return None
    """
    assert listed(closed_lists(package({"make.py": code}))) == ["make.py:2: chain make: `name` chooses Nao, NoRobot"]


def test_an_enumeration_that_three_files_tell_apart_is_closed() -> None:
    kinds = "class Sense(StrEnum):\n    A = 'a'\n    B = 'b'\n    C = 'c'\n"
    read = "def read(sense):\n    return {Sense.A: 1, Sense.B: 2, Sense.C: 3}[sense]\n"
    few = "def read(sense):\n    return sense is Sense.A\n"
    files = {"ports.py": kinds, "one.py": read, "two.py": read, "few.py": few}
    assert closed_lists(package(files)) == []
    assert listed(closed_lists(package(files | {"three.py": read}))) == [
        "ports.py:1: enumeration Sense: told apart in one.py, three.py, two.py"
    ]


def test_parameters_are_counted_without_the_object() -> None:
    code = """
    class Bell:
        def eight(self, a, b, /, c, d, *e, f, g, **h): ...
        def nine(self, a, b, c, d, e, f, g, h, i=1): ...
    """
    assert listed(wide_functions(package({"bell.py": code}))) == ["bell.py:4: Bell.nine has 9 parameters"]


def test_a_function_is_as_long_as_its_lines_from_def_to_end() -> None:
    code = "@cache\ndef bell():\n    '''Ring.'''\n\n    def ring():\n        return 1\n    return ring\n"
    assert sorted((lines, place.why) for lines, place in long_functions(package({"bell.py": code}))) == [
        (2, "ring"),
        (6, "bell"),
    ]


def test_statements_are_counted_without_imports_and_docstrings() -> None:
    code = """
    '''Bells.'''
    import os
    class Bell:
        '''Rings.'''
        loud = 1
        '''Whether it is loud.'''
        if loud: pass
    """
    assert statement_count(_file("bell.py", dedent(code))) == 4


def test_lines_that_the_formatter_leaves_alone_are_counted() -> None:
    files = [_file("bell.py", "A = (\n    1,\n)  # fmt: skip\nB = 'fmt: skip'\n# fmt: off\n")]
    assert [place.line for place in unformatted_statements(files)] == [3, 5]


def test_a_figure_above_its_ceiling_lists_what_it_counts() -> None:
    found = beyond_ceilings({"probes": Figure(2, ["a.py:1: x", "b.py:2: y"])}, {"probes": 1})
    assert found == ["probes: 2 is above the ceiling of 1\n  a.py:1: x\n  b.py:2: y"]


def test_a_figure_below_its_ceiling_names_the_new_one() -> None:
    assert beyond_ceilings({"probes": Figure(1, [])}, {"probes": 2}) == [
        "probes: 1 is below the ceiling of 2: write 1 into tests/house/ceilings.yaml"
    ]
    assert beyond_ceilings({"probes": Figure(1, [])}, {"probes": 1}) == []


def test_the_ceiling_of_statements_is_a_multiple_of_500() -> None:
    assert beyond_ceilings({"statements": Figure(1201, [])}, {"statements": 1500}) == []
    assert beyond_ceilings({"statements": Figure(1000, [])}, {"statements": 1500}) == [
        "statements: 1000 is below the ceiling of 1500: write 1000 into tests/house/ceilings.yaml"
    ]


def test_a_figure_without_a_ceiling_and_a_ceiling_without_a_figure_are_reported() -> None:
    assert len(beyond_ceilings({"probes": Figure(1, [])}, {"prods": 1})) == 2
