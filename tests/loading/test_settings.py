"""Settings that lumen.yaml lacks, or cannot hold because it is no map, have safe values."""

from pathlib import Path

from lumen.features.console.settings import ConsoleSettings
from lumen.features.show.settings import Show
from lumen.project.main_file import main_settings
from lumen.project.settings import Settings
from tests.tables import for_each


@for_each("main", [None, "[]", "name: Small", "console: {port: 8123}"])
def test_the_console_is_for_this_computer_alone_and_no_device_is_reached(main: str | None, tmp_path: Path) -> None:
    if main is not None:
        (tmp_path / "lumen.yaml").write_text(main, "utf-8")
    settings = main_settings(tmp_path) or Settings()
    assert (settings.section(ConsoleSettings).host, settings.section(Show)) == ("127.0.0.1", Show())
