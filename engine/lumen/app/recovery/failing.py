"""People are told that an exhibition could not start, or was ended by an error."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from lumen.app.alerts.alert import Origin
from lumen.app.alerts.desk import AlertDesk
from lumen.app.recovery.run_directory import RunDirectory
from lumen.errors import LumenError, ProjectError, UsageError
from lumen.language.alerts import Alerts
from lumen.language.diagnostics import Severity
from lumen.loading.project import main_settings
from lumen.loading.settings import Settings


@contextmanager
def failures_told(
    root: Path, run_directory: RunDirectory, parts: Sequence[str], tell: Callable[[str], None]
) -> Iterator[None]:
    """Has people told of an error that ends what is done meanwhile, and waits until they are; the error goes on.

    A UsageError is for the person who typed it. `tell` hears who could not be reached.
    """
    try:
        yield
    except (UsageError, BrokenPipeError):  # the latter is that nobody reads what it prints
        raise
    except Exception as error:
        try:
            _tell(error, root, run_directory, parts, tell)
        except Exception as other:
            tell(f"no alert could be sent: {other!r}")
        raise


def _tell(
    error: Exception, root: Path, run_directory: RunDirectory, parts: Sequence[str], tell: Callable[[str], None]
) -> None:
    settings = main_settings(root, run_directory.robot)
    desk = AlertDesk(_alerts(settings, run_directory), _origin(settings, root, parts), root, tell)
    if isinstance(error, LumenError):
        desk("start", f"it could not start or continue: {_why(error)}")
    else:  # what a fault of ours says may hold anything
        desk("crashed", f"it ended because of a fault in Lumen ({type(error).__name__})")
    desk.close()


def _why(error: LumenError) -> str:
    """Of files the place and the code, and nothing of what they say."""
    if not isinstance(error, ProjectError):
        return str(error)
    found = [diagnostic for diagnostic in error.diagnostics if diagnostic.severity is Severity.ERROR]
    return (
        f"the project's files have errors, the first at {found[0].place}: {found[0].code}"
        if found
        else "the project's files have errors"
    )


def _alerts(settings: Settings | None, run_directory: RunDirectory) -> Alerts:
    """Who is to be told: as the files say, else the last good ones."""
    if settings and settings.alerts.to:
        return settings.alerts
    good = run_directory.last_good()
    return good.alerts if good else Alerts()


def _origin(settings: Settings | None, root: Path, parts: Sequence[str]) -> Origin:
    return Origin((settings and settings.name) or root.name, settings.robot if settings else "NAO", tuple(parts))
