"""The cases in which a motion is played: after each posture in which the behaviours can leave the robot before it."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from lumen.language.actions import If, Parallel, PlacedAction
from lumen.language.commands import Play, Posture, Wake, Walk
from lumen.language.machines import MachineDefinition
from lumen.language.motions import MotionDefinition
from lumen.language.projects import Project
from lumen.motion.postures import standing
from lumen.ports import Live, Perform, RobotCommand
from lumen.project.project_folders import KINDS, LIFE_FOLDER, MOTIONS, PASSAGES, kind_in

FIRST_POSTURE = "Stand"
"""The posture in which a robot begins."""

LIVED = 20.0
"""The time for which a style of life is played [s]: several periods of its sways."""

Before = tuple[RobotCommand, ...]


@dataclass(frozen=True)
class Case:
    """A motion to play in simulation, and the commands before it.

    A style of life counts as a motion without keyframes.
    """

    folder: str
    """The folder of the motion's file."""
    motion: MotionDefinition
    """The motion."""
    before: Before
    """The commands before the motion."""
    command: RobotCommand
    """The command that plays the motion."""

    @property
    def file(self) -> str:
        """The path of the motion's file in the project."""
        return f"{self.folder}/{self.motion.name}.yaml"

    @property
    def passage(self) -> bool:
        """True if the motion is a passage between postures, in which feet may slide and links may touch on purpose."""
        return self.folder == PASSAGES

    @property
    def living(self) -> bool:
        """True if the case is a style of life instead of a motion."""
        return kind_in(self.folder) == KINDS[LIFE_FOLDER]

    @property
    def way(self) -> str:
        """The case in words: `from Stand`, `after photo` or `alive`."""
        if self.living:
            return "alive"
        match self.before[-1:]:
            case (Posture(posture),):
                return f"from {posture}"
            case (Perform(motion),):
                return f"after {motion.name}"
        return f"from {FIRST_POSTURE}"


def cases(project: Project) -> list[Case]:
    """Return a project's cases: every motion, every passage, and every style of life.

    A motion is played from its starting posture, and after each movement that can precede it in the behaviours.
    """
    motions = project.motions
    ways: dict[str, list[Before]] = {name: [_to(motion.start or FIRST_POSTURE)] for name, motion in motions.items()}
    blocks = [block for machine in project.behaviors.values() for block in _blocks(machine)]
    ends = [end for block in blocks for step in block if (end := _end(motions, step.action)) is not None]
    upright = standing(project.body)
    anywhere = [end for end in ends if _upright(end, upright)]
    for block in blocks:
        for i, step in enumerate(block):
            for name in ways.keys() & set(_played(step)):
                last = next((end for s in block[:i][::-1] if (end := _end(motions, s.action)) is not None), None)
                ways[name] += anywhere if last is None else [last]
    folders, lives = _own(project, MOTIONS), _own(project, LIFE_FOLDER)
    found = [
        Case(folders.get(name, MOTIONS), motion, before, Perform(motion))
        for name, motion in motions.items()
        for before in ways[name]
    ]
    for passage in project.body.passages:
        before = Posture(passage.start, 1.0)
        found.append(Case(PASSAGES, passage, (before,), Posture(passage.end, 1.0)))
    for name, style in project.life.items():
        found.append(Case(lives.get(name, LIFE_FOLDER), MotionDefinition(name, LIVED, {}), (), Live(style)))
    return list({(case.file, case.way): case for case in found}.values())


def _own(project: Project, shared: str) -> dict[str, str]:
    """Return, by file name, the robot's own folder of each file that replaces a file of the folder `shared`.

    The files of other robots are not in the project.
    """
    files = [PurePosixPath(file) for file in project.documents]
    own = {file.stem: str(file.parent) for file in files if str(file.parent) != shared}
    return {name: folder for name, folder in own.items() if kind_in(folder) == KINDS[shared] and folder not in KINDS}


def _to(posture: str) -> Before:
    return () if posture == FIRST_POSTURE else (Posture(posture, 1.0),)


def _end(motions: Mapping[str, MotionDefinition], action: object) -> Before | None:
    """Return the commands that bring the robot to its posture after this action.

    Return None if the action leaves the posture unchanged or plays an unknown motion.
    """
    match action:
        case Posture(name):
            return _to(name)
        case Walk() | Wake():
            return ()
        case Play(name) if name in motions:
            motion = motions[name]
            return _to(motion.end) if motion.end else (*_to(motion.start or FIRST_POSTURE), Perform(motion))
    return None


def _upright(end: Before, upright: Collection[str]) -> bool:
    match end[:1]:
        case (Posture(name),):
            return name in upright
    return True


def _played(step: PlacedAction) -> Iterator[str]:
    match step.action:
        case Play(name):
            yield name
        case Parallel(branches):
            for branch in branches:
                yield from _played(branch)


def _blocks(machine: MachineDefinition) -> Iterator[Sequence[PlacedAction]]:
    """Yield every list of actions in a behaviour, nested ones included."""
    for state in machine.states.values():
        for block in (state.entry, state.do, state.exit, *(t.actions for t in state.transitions)):
            yield from _nested(block)


def _nested(block: Sequence[PlacedAction]) -> Iterator[Sequence[PlacedAction]]:
    yield block
    for step in block:
        match step.action:
            case If(_, then, otherwise):
                yield from _nested(then)
                yield from _nested(otherwise)
            case Parallel(branches):
                for branch in branches:
                    if isinstance(branch.action, If):
                        yield from _nested((branch,))
