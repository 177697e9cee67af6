"""Times as texts: for programs and for people."""

from datetime import time

import pytest

from lumen.language.iso_time import file_stamp, iso_time, local_time, time_of, time_of_day

AT = 1_795_370_400.25  # 2026-11-22T18:00:00.250Z


def test_a_time_is_written_in_utc() -> None:
    assert iso_time(AT) == "2026-11-22T18:00:00.250Z"
    assert iso_time(AT, "seconds") == "2026-11-22T18:00:00Z"
    assert iso_time(AT, "seconds", offset=True) == "2026-11-22T18:00:00+00:00"
    assert file_stamp(AT) == "2026-11-22T18-00-00Z"


@pytest.mark.parametrize("text", ["2026-11-22T18:00:00.250Z", "2026-11-22T19:00:00.250+01:00"])
def test_a_written_time_is_read(text: str) -> None:
    assert time_of(text) == AT


def test_a_text_without_an_offset_is_local() -> None:
    assert local_time(time_of("2026-11-22T18:00:00")) == "2026-11-22 18:00:00"


@pytest.mark.parametrize("text", ["", "noon", "2026-13-01T00:00:00Z"])
def test_what_is_no_time_is_one_kind_of_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"isoformat|month"):
        time_of(text)


@pytest.mark.parametrize(("text", "read"), [("9:03", time(9, 3)), ("14:03", time(14, 3)), ("9:03:20", time(9, 3, 20))])
def test_people_write_a_time_of_day_without_a_zero(text: str, read: time) -> None:
    assert time_of_day(text) == read
