"""`lumen lint`: print the faults in the files of projects, with their places."""

import argparse
from collections.abc import Mapping, Sequence

from lumen.cli.extras import LintExtra, of_extras, returned
from lumen.cli.model_option import configure_model, use_model
from lumen.cli.printing import show, verdict
from lumen.cli.render import finding_formats, render
from lumen.cli.terminal import coloured
from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.run.linting.findings import Findings
from lumen.run.linting.targets import FindingsOf, LintTarget, Wanted, lint, lint_targets
from lumen.upkeep.garbage import gc_paused


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen lint` to its parser."""
    add = parser.add_argument
    add("paths", nargs="*", metavar="PATH", help="projects, or files of a project (default: this folder or one above)")
    add("--format", choices=finding_formats(), default="text", help="output format (default: text)")
    add("--select", metavar="CODES", action="append", help="show only these codes, first letters of codes, or families")
    add("--ignore", metavar="CODES", action="append", help="do not show these")
    add(
        "--against",
        metavar="OLD",
        help="also report what a reload from OLD would refuse: a folder, a revision, or `live`",
    )
    of_extras("lint_options", lambda extra: extra.configure(parser), installed=False)
    add("--strict", action="store_true", help="count warnings as errors")
    add("--fix", action="store_true", help="make every repair that needs no decision")
    add("--diff", action="store_true", help="show what --fix would change, and change nothing")
    add("--watch", action="store_true", help="lint again whenever a file is saved, until Ctrl-C")
    add("--no-cache", action="store_true", help="check all files again, and store no results")
    add("--whole", action="store_true", help="check the whole project of each named file")
    configure_model(parser)
    add("--stdin-filename", metavar="FILE", help="with `-`: the file whose new content is read from standard input")
    of_extras("lint_options", lambda extra: extra.configure(parser), installed=True)


def run(options: argparse.Namespace) -> int:
    """Lint the projects; return 1 if there are errors (with --strict also warnings) or --diff has changes, else 0."""
    wanted = _wanted(options)
    _consistent(options)
    projects = lint_targets(options.paths, options.stdin_filename, whole=options.whole)
    use_model(options.model, (each.root for each in projects))
    judge = _judge(options.against, wanted, kept=not (options.no_cache or options.watch))
    if options.watch:
        from lumen.cli.watching import watch

        return watch(projects, judge, options.format)
    if options.diff:
        return _diff(projects, wanted)
    if options.fix:
        _fix(projects, wanted)
    found = [judge(what) for what in projects]

    def add(extra: LintExtra) -> None:
        found[:] = returned(extra.more(found, wanted, options), list, Findings)

    of_extras("lint_options", add)
    show(render(options.format, found, coloured=options.format in ("text", "concise") and coloured()))
    return verdict(found, strict=options.strict)


def _judge(against: str | None, wanted: Wanted, *, kept: bool) -> FindingsOf:
    """Return the function that lints a project and, if `against` is given, reports the problems of a reload from it.

    If `kept`, results of earlier runs are reused for files that have not changed; --watch keeps them in memory instead.
    """

    def judge(what: LintTarget, files: Mapping[str, bytes] | None = None) -> Findings:
        with gc_paused():
            found = lint(what, wanted, files, kept=kept)
        if against is None:
            return found
        from lumen.run.linting.reloading import compared

        return compared(found, against, wanted)

    return judge


def _wanted(options: argparse.Namespace) -> Wanted:
    """Return the filter of findings that --select and --ignore describe."""
    if options.select is None and not options.ignore:
        return lambda diagnostic: True
    from lumen.lint.selection import selected  # not at the top: it imports all codes, and so all rules

    chosen = selected(options.select) if options.select is not None else None
    left_out = selected(options.ignore or ())

    def wanted(diagnostic: Diagnostic) -> bool:
        return (chosen is None or diagnostic.code in chosen) and diagnostic.code not in left_out

    return wanted


def _consistent(options: argparse.Namespace) -> None:
    if options.fix and options.diff:
        raise UsageError("--fix changes the files, but --diff only shows the changes: choose one")
    if options.diff and options.against is not None:
        raise UsageError("--diff shows only what --fix would change: leave out --against")
    of_extras("lint_options", lambda extra: extra.check(options))
    if options.watch and (options.fix or options.diff or "-" in options.paths):
        raise UsageError("--watch can't be combined with --fix, --diff or `-`")
    if options.watch and options.format not in ("text", "concise"):
        raise UsageError("--watch prints text for people: choose --format text or concise")
    if "-" in options.paths and options.fix:
        raise UsageError("`-` has no file to repair: use --diff to see what would change")


def _diff(projects: Sequence[LintTarget], wanted: Wanted) -> int:
    from lumen.cli.fixing import diff, repair

    lines: list[str] = []
    for what in projects:
        before, after, _ = repair(what, wanted)
        lines += diff(what.root, before, after, coloured())
    if lines:
        show("\n".join(lines))
    return int(bool(lines))


def _fix(projects: Sequence[LintTarget], wanted: Wanted) -> None:
    from lumen.cli.fixing import repair, tell, write

    for what in projects:
        before, after, done = repair(what, wanted)
        write(what.root, before, after)
        tell(done, Findings((), after, str(what.root)))
