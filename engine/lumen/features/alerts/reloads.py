"""The part that sends alerts about refused or rolled-back files."""

from collections.abc import Callable, Sequence

from lumen.features.alerts.desk import AlertDesk
from lumen.language.diagnostics import Severity
from lumen.language.events import Event
from lumen.run.parts.part import Part
from lumen.run.reload.reloader import Reloader
from lumen.run.reload.report import START, ReloadReport
from lumen.run.services import Services


class RefusalPart(Part):
    """Reports each refusal or rollback of files by a reloader.

    `tell` receives an alert's kind and text; about the files, the text contains only positions and codes.
    """

    patient = True

    def __init__(self, reloader: Reloader, tell: Callable[[str, str], None]) -> None:
        self._reloader, self._tell = reloader, tell
        self._last: ReloadReport | None = None

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Report a new refusal or rollback."""
        report = self._reloader.last
        if report is not None and report is not self._last:
            self._last = report
            if text := refusal(report):
                self._tell("refused", text)


def make(services: Services) -> RefusalPart:
    """Make the part that sends alerts about refused or rolled-back files."""
    return RefusalPart(services[Reloader], services[AlertDesk])


def refusal(report: ReloadReport) -> str:
    """Return the alert text for a report; empty if the report needs no alert."""
    if report.verdict == "rolled back":
        return "the saved files failed while they were in use: the previous files are active again"
    if report.verdict != "refused":
        return ""
    errors = [found for found in report.diagnostics if found.severity is Severity.ERROR]
    if report.validation and report.validation.objects:
        return "the saved files were refused: recorded visits would go differently; the exhibition continues unchanged"
    first = f": {errors[0].place} {errors[0].code}" if errors else ""
    more = f" and {len(errors) - 1} more" if len(errors) > 1 else ""
    what = "the last good files are active" if report.who == START else "the exhibition continues unchanged"
    return f"the saved files were refused{first}{more}; {what}"
