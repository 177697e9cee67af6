"""A verdict as text on a terminal."""

from collections.abc import Iterator

from lumen.cli.printing import clock_time
from lumen.cli.terminal import paint
from lumen.retrieval.ranking import QuestionTrial, WrongAnswer
from lumen.run.coverage import Coverage
from lumen.run.exploring import Explored
from lumen.run.rehearsal import Rehearsal
from lumen.run.verdict import JudgedExample, JudgedSaying, Verdict

FINDING_KINDS = {
    "dead-end": "a dead end",
    "no-way-back": "no way back",
    "restless": "no rest",
    "property": "a property that does not hold",
}


def render(verdict: Verdict, *, coloured: bool = False) -> str:
    """Return a line for each story, then the conclusion."""
    stories = [story(rehearsal, coloured=coloured) for rehearsal in verdict.rehearsals]
    return "\n".join([*stories, *conclusion(verdict, coloured=coloured)])


def story(rehearsal: Rehearsal, *, coloured: bool = False) -> str:
    """Return a line with a story's result, length, name and title; after a failure also the cause and last events."""
    failed = rehearsal.failed
    sign = paint("FAILED", "bold", "red", on=coloured) if failed else paint("ok    ", "green", on=coloured)
    length = paint(f"{clock_time(rehearsal.time):>6}", "dim", on=coloured)
    title = f"{sign} {length}  {paint(rehearsal.story.name, 'bold', on=coloured)}: {rehearsal.story.title}"
    lines = [title]
    if failed:
        lines += [f"  {paint(str(rehearsal.place), 'bold', on=coloured)}: step {failed.step}: {failed.what}"]
        lines += ["  The last events:"] if rehearsal.trace else []
    return "\n".join([*lines, *(_line(*row, coloured) for row in rehearsal.trace)])


def conclusion(verdict: Verdict, *, coloured: bool = False) -> Iterator[str]:
    """Yield the lines after the stories: coverage, exploration, questions, sayings, examples, and the totals."""
    if verdict.coverage:
        yield from _coverage(verdict, verdict.coverage, coloured)
    if verdict.explored:
        yield from _explored(verdict.explored, coloured)
    for trial in verdict.trials:
        yield from _tried(trial, coloured)
    if verdict.sayings:
        yield from _sayings(verdict, coloured)
    if verdict.examples:
        yield from _examples(verdict, coloured)
    if verdict.rehearsals:
        lived = sum(r.time for r in verdict.rehearsals)
        tried = [count(len(verdict.rehearsals), "story", "stories")]
        tried += [count(len(verdict.sayings), "saying", "sayings")] if verdict.sayings else []
        tried += [count(len(verdict.examples), "example", "examples")] if verdict.examples else []
        sum_of = f"{_joined(tried)}, {verdict.all_failed} failed"
        colour = "green" if verdict.well else "red"
        time = f"{clock_time(lived)} of simulated time in {verdict.took:.1f} s"
        yield f"\n{paint(sum_of, 'bold', colour, on=coloured)}: {time}"


def _sayings(verdict: Verdict, coloured: bool) -> Iterator[str]:
    """Yield the share of sayings that the right row matches, then those that fail."""
    right, every = len(verdict.sayings) - len(verdict.misheard), len(verdict.sayings)
    share = f"sayings: {right:,} of {every:,} ({int(100 * right / every)} %)"  # rounded down: 100 % means all of them
    yield f"\n{paint(share, 'bold', 'red' if verdict.misheard else 'green', on=coloured)}"
    for one in verdict.misheard:
        yield f"  {paint(str(one.place), 'bold', on=coloured)}: {misheard(one)}"


def misheard(one: JudgedSaying) -> str:
    """Return one line about a saying that another row, or none, matched."""
    return f"“{one.tried.saying.text}” in `{one.tried.saying.state}`: {one.tried.wrong}"


def _examples(verdict: Verdict, coloured: bool) -> Iterator[str]:
    """Yield the share of examples of functions that hold, then those that fail."""
    right, every = len(verdict.examples) - len(verdict.refuted), len(verdict.examples)
    share = f"functions: {right:,} of {count(every, 'example', 'examples')}"
    yield f"\n{paint(share, 'bold', 'red' if verdict.refuted else 'green', on=coloured)}"
    for one in verdict.refuted:
        yield f"  {paint(str(one.place), 'bold', on=coloured)}: {refuted(one)}"


def refuted(one: JudgedExample) -> str:
    """Return one line about an example of a function that gave another value or an error."""
    return f"`{one.tried.call}`: {one.tried.wrong}"


def _tried(trial: QuestionTrial, coloured: bool) -> Iterator[str]:
    """Yield the share of a language's questions that are answered, and the questions that get a wrong answer."""
    asked = paint(f"{count(trial.asked, 'question', 'questions')} in `{trial.language}`", "bold", on=coloured)
    wrong = f"{trial.rates.wrong:.0%} of all get a wrong answer"
    yield f"\n{asked}: {trial.rates.recall:.0%} of those with an answer get it, and {wrong};"
    yield (
        f"  each tested with weights from the others: {trial.others.recall:.0%} and {trial.others.wrong:.0%};"
        f" an answer needs a probability of {trial.least:.0%}"
    )
    for each in trial.wrong:
        yield f"  “{each.question}” is answered by {each.passage}, but {_wanted(each)}"


def _wanted(each: WrongAnswer) -> str:
    return f"should be answered by {each.wanted}" if each.wanted else "no passage answers it"


def count(number: int, one: str, many: str) -> str:
    """Return a number with its noun: `1 story`, `2 stories`."""
    return f"{number:,} {one if number == 1 else many}"


def _joined(parts: list[str]) -> str:
    """Return the parts as a list in words: `a`, `a and b`, or `a, b and c`."""
    return " and ".join(part for part in (", ".join(parts[:-1]), parts[-1]) if part)


def _line(time: float, who: str, text: str, coloured: bool) -> str:
    minutes, tenths = divmod(int(time * 10 + 1e-6), 600)
    return f"    {paint(f'{minutes:2d}:{tenths / 10:04.1f}', 'dim', on=coloured)}  {who:<8} {text}"


def _coverage(verdict: Verdict, coverage: Coverage, coloured: bool) -> Iterator[str]:
    for gap in coverage.gaps():
        yield f"{paint(str(gap.place), 'bold', on=coloured)}: {gap.what}"
    *most, last = (f"{some} of {every} {what}" for what, (some, every) in coverage.counts.items())
    percent = paint(f"{coverage.percent:.0f} %", "bold", "red" if verdict.uncovered else "green", on=coloured)
    wanted = f", less than the required {verdict.wanted:g} %" if verdict.uncovered else ""
    yield f"\nCovered: {', '.join(most)} and {last}: {percent}{wanted}"


def _explored(explored: Explored, coloured: bool) -> Iterator[str]:
    for finding in explored.findings:
        kind = paint(FINDING_KINDS[finding.kind], "bold", "red", on=coloured)
        yield f"\n{paint(str(finding.place), 'bold', on=coloured)}: {kind}: {finding.message}"
        yield "\n".join(f"    {line}".rstrip() for line in finding.story.splitlines())
    size = count(explored.configurations, "configuration", "configurations")
    steps = count(explored.steps, "step", "steps")
    number = len(explored.findings)
    sum_of = paint(
        count(number, "finding", "findings") if number else "nothing found",
        *("bold", "red" if number else "green"),
        on=coloured,
    )
    if explored.unseen:
        yield "\nNot reached with the data that was tried:"
        yield from (f"  {gap.place}: {gap.what}" for gap in explored.unseen)
    reach = (
        "in every configuration" if explored.complete else f"in the {explored.configurations:,} configurations explored"
    )
    yield from (f"\n`{name}` holds {reach}" for name in explored.kept)
    when = " (kept from an earlier run of the same files)" if explored.known else ""
    yield f"\nExplored `{explored.behavior}`: {size}, {steps} in {explored.took:.1f} s{when}: {sum_of}" + (
        "" if explored.complete else f"; stopped at --bound with {explored.waiting:,} more to explore"
    )
