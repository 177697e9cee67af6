"""The words that come with Lumen are sound, and lint never presents them as a file to edit."""

from pathlib import Path

from lumen.lint import check_files
from lumen.lint.new_language import with_language
from lumen.lint.patterns import BAD_PATTERN, DEAD_SLOT, FOREIGN_PATTERN
from lumen.lint.speech import UNKNOWN_LANGUAGE
from lumen.lint.torn_texts import TORN_TEXT
from lumen.lint.translation import language_entries
from lumen.lint.unused import UNUSED_PHRASES
from lumen.project.building import draft
from lumen.project.common_words import COMMON_FILE, common_words
from lumen.project.files import read_files
from lumen.run.linting.targets import LintTarget

ROOT = Path(__file__).parent / "hearing"


def test_they_are_read_with_a_project_that_hears_and_are_no_file_of_it() -> None:
    files = read_files(ROOT)
    assert COMMON_FILE in files
    assert COMMON_FILE not in LintTarget(ROOT).files()
    project, _ = check_files(ROOT, LintTarget(ROOT).files())
    assert project
    assert COMMON_FILE not in project.documents
    assert "yes" in project.behaviors["talk"].phrases


def test_another_language_is_not_written_into_them() -> None:
    found = draft(read_files(ROOT))
    assert COMMON_FILE not in {entry.report.document.file for entry in language_entries(found)}
    written = with_language(found, read_files(ROOT), "de", "en")
    assert sorted(written) == sorted(
        ["behaviors/talk.yaml", "behaviors/words/visitors.yaml", "knowledge/height.yaml", "lumen.yaml"]
    )


def test_as_a_file_of_a_project_they_are_linted_and_have_no_faulty_pattern() -> None:
    own = read_files(ROOT) | {COMMON_FILE: common_words() + b"# ours\n"}
    found = {diagnostic.code for diagnostic in check_files(ROOT, own)[1] if diagnostic.place.file == COMMON_FILE}
    assert found >= {UNUSED_PHRASES, UNKNOWN_LANGUAGE}  # it has more words and languages than the project needs
    assert found.isdisjoint((BAD_PATTERN, DEAD_SLOT, FOREIGN_PATTERN, TORN_TEXT))
