"""Manifests of features: the names, data and import strings that a feature adds to Lumen.

A manifest imports nothing but `lumen.feature`, so reading all of them costs milliseconds. The objects that rows name by
import strings are imported when they are first needed. A kind whose rows have names is a mapping; every other kind is a
tuple.
"""

from collections.abc import Mapping
from enum import IntEnum, auto
from typing import Any, Literal, NamedTuple

API = 1
"""The version of the rows below; a manifest of another version is refused."""

VALUE_KINDS = ("null", "boolean", "number", "text", "list", "map", "any")
"""The kinds of values in expressions, and `any` for all of them."""


class RobotOption(NamedTuple):
    """An option of `lumen run` that only some robots have; its value is a text."""

    name: str
    metavar: str
    """The placeholder of the option's value in `--help`."""
    help: str
    short: bool = False
    """True if the option is `--NAME`; else it is `--robot-NAME`."""
    several: bool = False
    """True if the option applies to all of several robots in one process; else it works with one robot only."""

    @property
    def flag(self) -> str:
        return f"--{self.destination.replace('_', '-')}"

    @property
    def destination(self) -> str:
        """The name of the option's value among the parsed options of a command line."""
        return self.name if self.short else f"robot_{self.name}"


class RobotRow(NamedTuple):
    """A robot that performs an exhibition: `lumen run --robot NAME`, `lumen.open(robot="NAME")`."""

    set_up: str = ""
    """An import string of a function from a `RobotRequest` to a `Setup` (both in `lumen.run.setup`).

    Empty if the robot is in a process of its own.
    """
    set_up_house: str = ""
    """An import string of a function that sets up several robots at once; if it is empty, `set_up` is called for each.

    The function gets a mapping of requests by the robots' names, and returns a mapping of setups.
    """
    real_time: bool = False
    """True if the robot's time can't run faster than real time."""
    bounded: bool = False
    """True if the robot keeps the limits and speeds of its body itself; Lumen does that for other robots."""
    options: tuple[RobotOption, ...] = ()
    """The robot's own options of `lumen run`."""
    examine: str = ""
    """An import string of a function for `lumen doctor --robot NAME`.

    It gets the given options by name, and returns triples: the subject of a check, its result (`ok`, `note`, `warning`
    or `error`), and a text about it.
    """


class BaseRow(NamedTuple):
    """A kind of base, which carries a body and moves it about: `roles: {base: {kind: NAME}}` in models/NAME.yaml.

    A base that neither walks nor drives stays in its place.
    """

    simulate: str
    """An import string of a function from a `BaseRequest` to a `RobotBase` (`lumen.features.simulation.base`)."""
    title: str
    """The name of such a body in messages, such as `a biped`."""
    legs: bool = False
    """True if the base walks, as its gait and its joints allow."""
    drives: bool = False
    """True if the base drives, at most at the `speed` and `turn` in its YAML."""
    wheels: bool = False
    """True if its YAML names the joints of its driven wheels, `left` and `right`."""

    @property
    def moves(self) -> bool:
        """True if the robot can leave its place."""
        return self.legs or self.drives


class SenseRow(NamedTuple):
    """A sense of robots. Its readings are sent on the project's route of that name, or on one with that name in `of`.

    A sense without functions is one of images.
    """

    meaning: str
    """The purpose of the sense's route."""
    encode: str = ""
    """An import string of a function from a reading to the body of a message."""
    decode: str = ""
    """An import string of a function from a body and the names of the robot's joints to a reading.

    It returns None if the body is of another robot, and may raise KeyError, TypeError or ValueError for a body that has
    no reading.
    """


class BusRow(NamedTuple):
    """A kind of bus, by the scheme of its addresses.

    `probe`, `stream` and `side_queues` are for a bus with a broker; their classes are in `lumen.bus.brokers`.
    """

    open: str
    """An import string of a function from an address and the name of a sender to a `lumen.ports.Bus`."""
    forms: tuple[str, ...]
    """The forms of the bus's addresses, shown if an address is wrong."""
    example: str = ""
    """An address, shown in `--help`."""
    within_process: bool = False
    """True if no other process can be on the bus."""
    probe: str = ""
    """An import string of a function from an address to a `Probe`, with which `lumen doctor` examines the broker."""
    stream: str = ""
    """An import string of a function from an address, the stream's name and an offset to a `Stream`.

    It returns None if there is no such stream.
    """
    side_queues: str = ""
    """The names of the queues for unusable messages, in words for `lumen doctor`."""


class ModuleRow(NamedTuple):
    """A module: a program on the bus that runs alongside the behaviour, such as the eyes.

    The settings of Lumen's own modules are described in schemas/lumen.schema.json.
    """

    module: str
    """An import string of a subclass of `lumen.run.module.Module`."""
    description: str = ""
    """A description of the module's settings in lumen.yaml."""
    options: Mapping[str, Mapping[str, Any]] = {}
    """The JSON Schema of each option in these settings."""


class FunctionRow(NamedTuple):
    """A function of the expression language. Without `clock` and `draws`, the same arguments give the same value."""

    call: str
    """The import string of the function; editors show the first paragraph of its docstring."""
    parameters: tuple[str, ...]
    """The kinds that each argument may have: `text`, several as `text|list`, or `any`."""
    returns: str
    """The kinds that the function's value may have."""
    example: str = ""
    """Arguments as an author would write them."""
    scoped: bool = False
    """True if the function gets the `Scope` before its arguments."""
    clock: bool = False
    """True if the function reads the time of day."""
    draws: bool = False
    """True if the function draws random values."""
    exact: bool = False
    """True if it checks its arguments itself and returns JSON data within Lumen's bounds; else Lumen checks both."""


class VerbRow(NamedTuple):
    """A verb of the YAML that the robot performs by code of a feature."""

    performer: str
    """An import string of a `SkillPerformer` (`lumen.ports`), which reads lumen.yaml with `call.section`."""
    description: str = ""
    arguments: Mapping[str, Any] = {}
    """The JSON Schema of an object, without `$ref`s.

    If exactly one property is required, its value can be written alone: `blink: 3`. Properties that the YAML leaves out
    get their `default`.
    """
    result: Mapping[str, Any] = {}
    """The JSON Schema of the performer's result, an object."""
    takes: str = "0s"
    """The time that the verb takes: a duration that can contain expressions of the arguments, `{{ times * 0.4 }}s`."""
    parts: tuple[str, ...] = ()
    """The parts of the body that no other command may use meanwhile (`lumen.language.body_parts`)."""
    moves: bool = False
    """True if the verb moves the robot; then it is refused while the robot rests."""
    cancel: bool = True
    """True if the performer ends early after a stop, or after its state was left.

    Otherwise it continues. In either case the robot does not wait for it.
    """
    details: object = None
    """The settings for the verb's performer, if a file of a project declares the verb; else None."""
    root: str = ""
    """The project's folder, for a verb that a loaded project declares; else empty."""
    robot: str = ""
    """The robot's name, for a verb that a loaded project declares; else empty."""


RiskName = Literal["cosmetic", "behavior", "motion", "wiring", "restart"]
"""The part of a running exhibition that a change can touch, as `lumen diff` prints it."""


class Section(NamedTuple):
    """A section of lumen.yaml: how its settings are read, checked and compared.

    The settings are an object of a frozen dataclass of which each field has a default. `project.section(TYPE)` returns
    them.
    """

    read: str
    """An import string of `read(data, report)`, which returns the settings if lumen.yaml has the section.

    `data` is all of lumen.yaml, without the nodes that its schema refuses. `report(CODE, path, message, hint)` adds a
    finding at a path in `data`.
    """
    schema: str = ""
    """An import string of the JSON Schema of the section, a `dict` without `$ref`.

    Empty if schemas/lumen.schema.json has the section, for editors that read no manifests.
    """
    title: str = ""
    """The name of the section in a list of changes, such as `the console`; if empty, the list quotes both values.

    With `entries`, it is the name of a single entry, such as `place`.
    """
    risk: RiskName = "cosmetic"
    """The risk of a change. With `restart` the old settings stay active until the next start."""
    entries: str = ""
    """The field of the settings that maps names to entries, which are compared one by one."""
    of_house: bool = False
    """True if the section belongs to the house: then no bundle of a fleet changes it."""

    @property
    def fixed(self) -> bool:
        """True if a change takes effect only at the next start."""
        return self.risk == "restart"


class FileRow(NamedTuple):
    """A YAML file next to lumen.yaml that belongs to the project."""

    build: str
    """An import string of a function that builds the file's settings, which `ProjectDraft.beside` has by its name.

    The function gets the file's data, its `DocumentReport`, and the file's `name` without its ending as a keyword.
    """
    schema: str = ""
    """An import string of the file's JSON Schema, a `dict` without `$ref`; empty if it is schemas/NAME.schema.json."""


class Subcommand(NamedTuple):
    """A subcommand of `lumen`."""

    summary: str
    """The subcommand's description in `lumen --help`."""
    module: str
    """A module with two functions.

    `configure` adds arguments to an `ArgumentParser`; `run` returns the exit code.
    """
    after: str = ""
    """The subcommand of this or an earlier feature after which `lumen --help` lists it; empty to list it last."""


class EditorRow(NamedTuple):
    """The answer of `lumen lsp` to a method of the Language Server Protocol."""

    answer: str
    """An import string of a function of a `LanguageServer` and the method's parameters.

    The class is in `lumen.features.editor.language_server`.
    """
    options: str = ""
    """An import string of the method's options for the editor, such as the letters that begin a completion."""


IMPORTED_KINDS = ("behavior", "controller", "motion", "robot", "hint")
EXPORTED_KINDS = ("behavior", "controller", "diagram", "project")


class Importer(NamedTuple):
    """A kind of file of another tool that `lumen import` converts to one of Lumen's."""

    kind: str
    """`behavior`, `controller`, `motion`, `robot`, or `hint` for a file that holds nothing to convert."""
    read: str
    """An import string of a `FileReader`, `MotionReader` (for a motion) or `RobotReader` (for a robot).

    These are in `lumen.project.formats.importers`. For a `hint` it is a function from the content to the words that
    complete a sentence about the file, with advice.
    """
    begins: str = ""
    """An import string of a function that returns True for the content of such a file, whatever its name."""


class Exporter(NamedTuple):
    """A format that `lumen export` writes."""

    kind: str
    """`behavior`, `controller`, `diagram` or `project`."""
    write: str
    """An import string of a function that returns the text.

    For a diagram it gets a `MachineDefinition`, for a project a `Project`. For a behaviour or a controller it gets a
    `MachineDefinition` or `ControllerDefinition` and a function from paths to places, and also returns diagnostics.
    """


class Phase(IntEnum):
    """The phase in which a part of an exhibition is made and ticked; parts of a lower phase come first."""

    RECORD = auto()
    """Parts that receive everything that the others report."""
    BEHAVIOR = auto()
    """The behaviour itself, which the other parts serve or watch."""
    WORLD = auto()
    """The visitor and the robot."""
    WATCH = auto()
    """Observers of the behaviour's steps."""
    SERVE = auto()
    """Parts that act on the behaviour between two steps: saved files, operators, people to forget."""
    ALERT = auto()
    SHOW = auto()
    """The film and the console."""
    VISIT = auto()
    """A person who types."""
    MODULES = auto()
    BRAIN = auto()
    """The part that steps the behaviour."""
    KEEP = auto()
    """Parts that keep or show what the behaviour did."""


PART_CONDITIONS = dict.fromkeys(("whole", "brain", "follows"), False) | dict.fromkeys(
    ("role", "option", "section", "file"), True
)
"""The conditions of a part, and whether a name follows each."""


class PartRow(NamedTuple):
    """A part of an exhibition."""

    name: str
    phase: Phase
    """The phase in which the part is made and ticked.

    Within a phase, parts are ordered by name, except where `after` demands another order.
    """
    make: str
    """An import string of a function from the services made so far to a part, a list of parts, or None."""
    when: str = ""
    """The conditions under which the part is made, separated by spaces: all must be true.

    `whole` (one process has everything), `brain` (the behaviour runs in this process), `follows` (it does not),
    `role:NAME` (this is that process of several), `option:NAME` (the plan has that option), `section:NAME` (lumen.yaml
    has that section), `file:NAME` (the project has that file next to lumen.yaml).
    """
    after: str = ""
    """The part of the same phase after which it comes; empty for the order by name.

    A package that makes parts wait for each other is left out.
    """
    claimed: bool = False
    """True if the part is made only after the process has claimed the robot on the bus.

    Such a part opens a resource that another process may still have open.
    """


class Feature(NamedTuple):
    """One capability: its rows by kind. A text such as `package.module:name` is an import string.

    `extras` are those of the distribution that install what the feature needs.
    """

    name: str
    api: int = API
    extras: tuple[str, ...] = ()
    parts: tuple[PartRow, ...] = ()
    """Parts of an exhibition."""
    roles: tuple[str, ...] = ()
    """Roles of one of several processes: `lumen run --only ROLE` makes the parts with the condition `role:ROLE`."""
    rules: tuple[str, ...] = ()
    """Functions that report faults of a `ProjectDraft`. Their modules declare the codes of these reports."""
    section_rules: Mapping[str, str] = {}
    """By a section of lumen.yaml, or the name of a file next to it: the rule that runs if the project has it.

    A project without it does not import the rule's module.
    """
    last_rules: tuple[str, ...] = ()
    """Rules that run after all others, because they report unused names."""
    codes: tuple[str, ...] = ()
    """Other modules that declare codes, such as those that read files."""
    pages: tuple[str, ...] = ()
    """Packages with a page `CODE.md` for each code, in the form that `lumen.lint.pages` describes."""
    fixes: Mapping[str, str] = {}
    """By code, the function that proposes repairs of a finding, as `lumen.lint.fixes` describes."""
    subcommands: Mapping[str, Subcommand] = {}
    run_options: tuple[str, ...] = ()
    """Classes of options of `lumen run`: each a `RunExtra` of `lumen.cli.extras`."""
    lint_options: tuple[str, ...] = ()
    """Classes of options of `lumen lint`: each a `LintExtra` of `lumen.cli.extras`."""
    finding_formats: Mapping[str, str] = {}
    """By the name in `--format NAME` of findings, the `Renderer` of `lumen.cli.render`."""
    verdict_formats: Mapping[str, str] = {}
    """By the name in `lumen test --format NAME`, the function from a `Verdict` to text."""
    editor_requests: Mapping[str, EditorRow] = {}
    """Requests and notifications of editors that `lumen lsp` answers, by method: `textDocument/formatting`."""
    editor_commands: Mapping[str, str] = {}
    """By command of an editor, the function that the language server runs, with a `LanguageServer` and arguments."""
    importers: Mapping[str, Importer] = {}
    """Readers of other tools' files, by the ending of a file's name in lower case, such as `.scxml`."""
    exporters: Mapping[str, Exporter] = {}
    """Writers for `lumen export`, by the name of the format."""
    format_tables: Mapping[str, str] = {}
    """By imported format, its `FormatTable` of names that are read, lost or without meaning."""
    sections: Mapping[str, Section] = {}
    """Sections of lumen.yaml by their keys; `modules.show` is the key `show` under `modules`."""
    files: Mapping[str, FileRow] = {}
    """YAML files next to lumen.yaml by their names, such as `fleet.yaml`."""
    verbs: Mapping[str, VerbRow] = {}
    """Verbs of the YAML that the robot performs, by their names."""
    verb_files: Mapping[str, str] = {}
    """By a folder of a project whose YAML files each declare a verb, the function that makes a file's `VerbRow`.

    It gets the checked data of a file, its `DocumentReport`, and `name` and `languages` as keywords, and returns None
    if the file does not describe a usable verb.
    """
    new_files: Mapping[str, str] = {}
    """By the kind in `lumen new KIND NAME`, the function that adds the files to a project.

    It gets the project's folder and the name, and returns the paths of the files, beginning with the one to read first.
    It raises UsageError if the files can't be made, for example because the name exists.
    """
    modules: Mapping[str, ModuleRow] = {}
    robots: Mapping[str, RobotRow] = {}
    functions: Mapping[str, FunctionRow] = {}
    bases: Mapping[str, BaseRow] = {}
    links: tuple[str, ...] = ()
    """Functions from a `Body` and its models' folder to `BodyLinks` (`lumen.robot.links`); the first one is used."""
    buses: Mapping[str, BusRow] = {}
    senses: Mapping[str, SenseRow] = {}
    voices: Mapping[str, str] = {}
    """By the name in `lumen run --voice NAME`, a class that is a `lumen.run.voices.RobotVoice`.

    It is made with a language, the WAV file to write or None, and the `AudioTrack` of a film or None.
    """
    before_start: tuple[str, ...] = ()
    """Functions that a run calls with the project's folder before it reads the files, to finish interrupted work."""
    failures: tuple[str, ...] = ()
    """Functions that inform people of a `RunFailure` (`lumen.run.run_start`), an error that ends a run.

    They return a function that waits until the message is delivered, or None.
    """
    file_forgetters: tuple[str, ...] = ()
    """Functions that delete a person's data in files for `lumen memory forget NAME`, in the order of the features.

    A function gets the folder of an exhibition's home, the name, and a `Forgetting` (`lumen.run.forgetting.added`), to
    which it adds the deleted and the remaining data.
    """
    forgets: tuple[str, ...] = ()
    """Functions and classes that delete a person's data for `lumen memory forget NAME` while an exhibition runs.

    A function gets a `PersonName` (`lumen.language.people`). For a class, the method `forget` of the process's part or
    service of that class gets it, if there is one.
    """
