"""Findings of one cause are one; causes.yaml has cases of files."""

from lumen.language.diagnostics import Diagnostic, Place, gathered


def test_a_finding_that_two_readings_of_the_files_make_is_one_whatever_each_holds_for_its_cause() -> None:
    """Each of several robots reads the files, and another body may be the cause for one of them."""
    twice = [
        Diagnostic("too-fast", "too fast", Place("motions/wave.yaml", 3, 1), cause=f"c{robot}", root=f"r{robot}")
        for robot in ("Ana", "Ben")
    ]
    assert gathered(twice) == [twice[0]]
