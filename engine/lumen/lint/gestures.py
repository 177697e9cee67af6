"""Gestures that accompany speech: movements that are too fast, and tags that no text has."""

from lumen.language.diagnostics import did_you_mean
from lumen.language.gestures import GestureLibrary, merged
from lumen.language.robots import Body
from lumen.lint.effects import NO_EFFECT
from lumen.lint.lookups import first
from lumen.lint.motions import TOO_FAST, more_time
from lumen.motion.gestures import BEAT, GESTURE_SHARE, peak_speeds
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.project_folders import GESTURES_FOLDER


def check(draft: ProjectDraft) -> None:
    """Report gestures that are too fast for the robot, and tags without phrases."""
    tags = (BEAT, *merged(draft.gestures).phrases)
    for name, library in draft.gestures.items():
        report = draft.report(GESTURES_FOLDER, name)
        _tags(library, report, tags)
        if draft.body:
            _speeds(library, report, draft.body)


def _tags(library: GestureLibrary, report: DocumentReport, tags: tuple[str, ...]) -> None:
    for gesture in library.gestures:
        for i, tag in enumerate(gesture.tags):
            if tag not in tags and not report.broken(("phrases",)):
                path = first(report, (*gesture.where, "for", i), (*gesture.where, "for"))
                message = f"no text has the tag `{tag}`: there are no `phrases` for it"
                report(NO_EFFECT, path, message, did_you_mean(tag, tags, "available:"))


def _speeds(library: GestureLibrary, report: DocumentReport, body: Body) -> None:
    for gesture in library.gestures:
        excesses = {j: v / (GESTURE_SHARE * body.joints[j].speed) for j, v in peak_speeds(gesture).items()}
        joint = max(excesses, key=lambda name: excesses[name])
        if excesses[joint] > 1.0:
            message = (
                f"`{gesture.name}` would move `{joint}` at {excesses[joint]:.1f} times the speed limit of a gesture"
            )
            hint = f"give its longest movement {more_time(excesses[joint])}, or a smaller angle"
            report(TOO_FAST, gesture.where, message, hint, key=True)
