"""`lumen test`: play a project's stories on the recording robot, and check its sayings and examples of functions."""

import argparse
import sys
import time
from contextlib import nullcontext
from pathlib import Path

import lumen
from lumen.cli.model_option import configure_model, use_model
from lumen.cli.progress import progress
from lumen.cli.terminal import coloured
from lumen.cli.verdicts import render, text, verdict_formats
from lumen.cli.writing import write_file
from lumen.errors import UsageError
from lumen.insight.explaining.function_examples import tried_examples
from lumen.insight.explaining.sayings import tried as tried_sayings
from lumen.insight.exploration import MAX_CONFIGURATIONS
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.sayings import SayingSet
from lumen.language.stories import Story
from lumen.project.project_folders import MAIN_FILE
from lumen.project.running_project import own_project
from lumen.retrieval.ranking import QuestionTrial
from lumen.run.chosen_stories import project_of, tests_of
from lumen.run.coverage import Coverage
from lumen.run.exploring import Explored, explored
from lumen.run.kept_explorations import KeptExplorations
from lumen.run.rehearsal import Rehearsal, rehearse
from lumen.run.verdict import JudgedExample, JudgedSaying, Verdict


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen test` to its parser."""
    add = parser.add_argument
    add(
        "words",
        nargs="*",
        metavar="[PROJECT] STORY",
        help="the project's folder, then stories or files of sayings: names, files or 'safety_*' (default: all)",
    )
    add("--format", choices=verdict_formats(), default="text", help="output format (default: text)")
    configure_model(parser)
    add("-o", "--output", metavar="FILE", type=Path, help="write to this file instead of printing")
    add("-x", "--exitfirst", action="store_true", help="stop at the first story that fails")
    add("-v", "--verbose", action="store_true", help="print everything that happens in each story")
    add("--coverage", action="store_true", help="list the states, transitions and skills that were never used")
    add("--fail-under", metavar="N", type=float, help="fail if less than N %% is covered (implies --coverage)")
    add("--real-skills", action="store_true", help="run the programs of skills instead of only letting their time pass")
    add("--explore", action="store_true", help="search the behaviour for dead ends instead of playing the stories")
    add("--behavior", metavar="NAME", help="with --explore: a behaviour other than the one that lumen.yaml names")
    add(
        "--home",
        metavar="STATE",
        help="with --explore: the state that must stay reachable (default: the initial states)",
    )
    add(
        "--bound",
        metavar="N",
        type=int,
        default=MAX_CONFIGURATIONS,
        help=f"with --explore: explore at most N configurations (default: {MAX_CONFIGURATIONS:,})",
    )


def run(options: argparse.Namespace) -> int:
    """Run the tests and print the verdict; return 1 if a test failed or the exploration found a fault, else 0."""
    folder, names = _words(options.words)
    _check(options)
    root = own_project(folder)
    use_model(options.model, [root])
    project = lumen.load(root)
    began = time.perf_counter()
    live = options.format == "text" and options.output is None
    rehearsals: list[Rehearsal] = []
    coverage = Coverage(project) if options.coverage or options.fail_under is not None else None
    sayings: list[SayingSet] = []
    if names or coverage or not options.explore:
        stories, sayings = _chosen(project, names)
        with nullcontext(_untold) if live else progress() as tell:  # on a terminal each story is printed as it ends
            for story in stories:
                tell(len(rehearsals), len(stories), f"stories, {story.name}")
                observers = [coverage.of(story.behavior or project.behavior)] if coverage else []
                how = {"whole": options.verbose, "real_skills": options.real_skills}
                rehearsals.append(rehearse(project, story, observers=observers, **how))
                if live:
                    _print(text.story(rehearsals[-1], coloured=coloured()))
                if options.exitfirst and rehearsals[-1].failed:
                    break
    walked = _explore(project, options) if options.explore else None
    trials = _tried(project) if project.questions and not names and not options.explore else ()
    halted = options.exitfirst and any(rehearsal.failed for rehearsal in rehearsals)
    judged = () if halted else _judged(project, sayings)
    examples = () if halted or names or options.explore else _examples(project)
    took = time.perf_counter() - began
    verdict = Verdict(
        project.name, tuple(rehearsals), coverage, options.fail_under or 0.0, walked, took, trials, judged, examples
    )
    if live:
        _print("\n".join(text.conclusion(verdict, coloured=coloured())))
    else:
        _deliver(render(options.format, verdict), options.output)
    return 0 if verdict.well else 1


def _words(words: list[str]) -> tuple[str | None, list[str]]:
    """Return the project's folder, None for the default, and the names of stories and sayings.

    If the first word is a folder or a lumen.yaml, it is the project; else the project is that of the named files.
    """
    if words and (Path(words[0]).is_dir() or Path(words[0]).name == MAIN_FILE):
        return words[0], words[1:]
    return project_of(words), words


def _check(options: argparse.Namespace) -> None:
    if options.fail_under is not None and not 0 <= options.fail_under <= 100:
        raise UsageError("--fail-under must be a number from 0 to 100")
    if options.bound < 1:
        raise UsageError("--bound must be at least 1")
    if not options.explore and (options.behavior or options.home):
        raise UsageError("--behavior and --home need --explore")


def _chosen(project: Project, names: list[str]) -> tuple[list[Story], list[SayingSet]]:
    """Return the stories and the files of sayings with these names, each once; all if there are no names.

    Raises UsageError if a name matches none, or if the project has no tests at all.
    """
    if not (project.stories or project.sayings or any(each.examples for each in project.functions.values())):
        raise UsageError(
            "the project has no stories and no sayings: write a story in behaviors/stories/, as docs/stories.md shows"
        )
    if not (names or project.stories or project.sayings):
        return [], []
    stories, sayings = zip(*(tests_of(project, name) for name in names or ["*"]), strict=True)
    return (
        list({story.name: story for each in stories for story in each}.values()),
        list({each.name: each for several in sayings for each in several}.values()),
    )


def _judged(project: Project, sets: list[SayingSet]) -> tuple[JudgedSaying, ...]:
    return tuple(
        JudgedSaying(one, project.place(one.file, one.saying.where)) for one in tried_sayings(sets, project.behaviors)
    )


def _examples(project: Project) -> tuple[JudgedExample, ...]:
    found = tried_examples(project.functions.values())
    return tuple(JudgedExample(one, project.place(one.file, one.example.where)) for one in found)


def _tried(project: Project) -> tuple[QuestionTrial, ...]:
    """Return the results of the project's test questions, one for each language that has questions."""
    from lumen.retrieval.retriever import Retriever  # imports numpy
    from lumen.retrieval.trials import tried

    retrievers = (Retriever(project.knowledge.values(), name, robot=project.robot) for name in project.languages)
    found = (tried(retriever, project.questions.values()) for retriever in retrievers)
    return tuple(trial for trial in found if trial)


def _explore(project: Project, options: argparse.Namespace) -> Explored:
    behavior = options.behavior or project.behavior
    if behavior not in project.behaviors:
        raise UsageError(f"no behaviour `{behavior}`: {did_you_mean(behavior, project.behaviors, 'behaviors/ has')}")
    names = [state.name for state in project.behaviors[behavior].states.values() if state.path]
    if options.home and options.home not in names:
        raise UsageError(f"no state `{options.home}` in `{behavior}`: {did_you_mean(options.home, names, 'it has')}")
    memory, home = KeptExplorations(project), options.home or ""
    if known := memory.recall(behavior, options.bound, home):
        return known
    with progress(at_most=True) as tell:
        found = explored(
            project,
            behavior,
            bound=options.bound,
            home=home,
            tell=lambda walked, waiting: tell(walked, options.bound, f"configurations explored, {waiting:,} waiting"),
        )
    memory.keep(found, options.bound, home)
    return found


def _untold(done: float, whole: float, name: str) -> None:
    """Ignore a report of progress."""


def _print(shown: str) -> None:
    print(shown.encode("utf-8", "replace").decode(), flush=True)


def _deliver(shown: str, output: Path | None) -> None:
    if output is None:
        _print(shown)
        return
    write_file(f"{shown}\n".encode("utf-8", "replace"), output)
    print(f"wrote {output}", file=sys.stderr)
