"""`make check` lists all that is out of order, and a check that looks at nothing has failed."""

import check
import pytest


def test_all_that_is_wrong_is_listed() -> None:
    found = check.wrong(lambda: [("a", "is loose"), ("b", ""), ("c", "is lost")], 3)
    assert found == ["a: is loose", "c: is lost"]


def test_a_check_that_looks_at_too_little_has_failed() -> None:
    assert check.wrong(lambda: [("a", "")], 2) == ["looked at 1 things, not at least 2: its pattern no longer matches"]


@pytest.mark.parametrize(("problem", "code"), [("", 0), ("is loose", 1)])
def test_what_is_wrong_is_printed_under_the_name_of_its_check(
    problem: str, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def pins_are_tight() -> list[tuple[str, str]]:
        return [("a.yml", problem)]

    monkeypatch.setattr(check, "CHECKS", {pins_are_tight: 1})
    assert check.main() == code
    assert capsys.readouterr().out == ("pins are tight:\n  a.yml: is loose\n" if problem else "")


def test_a_link_that_leads_nowhere_and_an_action_without_a_commit_are_found(
    tmp_path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "docs").mkdir()
    page = tmp_path / "docs/page.md"
    page.write_text("# One word\n[a](#one-word) [b](gone.md) [c](#two) [d](https://example.org)\n", encoding="utf-8")
    (tmp_path / "README.md").write_text("uses: a/b@v1\nuses: a/b@" + "0" * 40 + "\n", encoding="utf-8")
    for name, value in {"ROOT": tmp_path, "DOCS": tmp_path / "docs", "PAGES": [page], "WORKFLOWS": []}.items():
        monkeypatch.setattr(check, name, value)
    assert list(check.links_lead_to_files_and_headings()) == [("docs/page.md", "lead nowhere: gone.md, #two")]
    assert list(check.actions_are_named_by_their_commits()) == [
        ("README.md", "pin by the 40 digits of a commit: v1"),
        ("docs/page.md", ""),
    ]
