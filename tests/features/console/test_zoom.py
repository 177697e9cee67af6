"""The time line of Day can be zoomed: by the wheel, by two fingers, by keys and by buttons; times keep their place."""

from typing import Any

import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from tests.features.console.conftest import Shared
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("operating")]
SLIDER = ".line input[type=range]"
WINDOW = f"const one = document.querySelector('{SLIDER}'); return [Number(one.min), Number(one.max)]"
MOMENT = f"return Number(document.querySelector('{SLIDER}').value)"
TICKS = "return [...document.querySelectorAll('.hours li')].map((one) => one.textContent)"


@pytest.fixture
def day(shared: Shared, viewer: Viewer) -> Viewer:
    """The page of a day with a visit."""
    hosted, browser = shared.hosted(), shared.served().browser
    hosted.send("face", {"x": 160, "y": 120})
    until(lambda: browser.get("/api/day").data["visits"], HANG)
    viewer.open(shared.served().console.address, "robot/NAO/day", ready=SLIDER, mode="operator")
    return viewer


def window(viewer: Viewer) -> tuple[float, float]:
    begin, end = viewer.run(WINDOW)
    return begin, end


def length(viewer: Viewer) -> float:
    begin, end = window(viewer)
    return end - begin


def turn(viewer: Viewer, by: int, part: float) -> None:
    """Turn the wheel over the line, at this part of its width."""
    line = viewer.driver.find_element(By.CSS_SELECTOR, ".line svg")
    x = int((part - 0.5) * line.size["width"])
    ActionChains(viewer.driver).scroll_from_origin(ScrollOrigin.from_element(line, x, 0), 0, by).perform()


def at(viewer: Viewer, part: float) -> float:
    begin, end = window(viewer)
    return begin + part * (end - begin)


def test_buttons_zoom_around_the_moment_and_show_the_whole_day_again(day: Viewer) -> None:
    whole = window(day)
    assert day.text(".zoom [role=status]") == "The whole day is shown."
    moment = day.run(MOMENT)
    day.click(".zoom-in")
    until(lambda: length(day) == pytest.approx((whole[1] - whole[0]) / 2, abs=2000), HANG)
    begin, end = window(day)
    assert begin <= moment <= end
    assert day.run(MOMENT) == pytest.approx(moment, abs=1000)
    assert "to" in day.text(".zoom [role=status]")
    assert violations(day) == []
    for _ in range(12):
        day.lands(day.all(".zoom-in")[0], ".zoom-in")  # which does nothing when no more can be shown
    until(lambda: length(day) <= 32_000, HANG)
    assert day.run("return document.querySelector('.zoom-in').ariaDisabled") == "true"
    assert all(text.count(":") == 2 for text in day.run(TICKS))  # so near, times have seconds
    day.click(".zoom-out")
    until(lambda: length(day) == pytest.approx(60_000, abs=2000), HANG)
    day.click(".zoom-reset")
    until(lambda: window(day) == whole, HANG)
    assert len(day.all(SLIDER)) == 1


def test_the_wheel_keeps_the_time_under_the_pointer(day: Viewer) -> None:
    whole, before = window(day), at(day, 0.25)
    turn(day, -100, 0.25)
    until(lambda: length(day) == pytest.approx((whole[1] - whole[0]) / 2, abs=2000), HANG)
    assert at(day, 0.25) == pytest.approx(before, abs=10_000)
    turn(day, 100, 0.25)
    until(lambda: window(day) == whole, HANG)
    scrolled = day.run("return scrollY")
    turn(day, 300, 0.25)  # nothing is left to zoom out: the page is scrolled
    until(lambda: day.run("return scrollY") > scrolled, HANG)


def test_two_fingers_zoom_and_one_moves_the_line(day: Viewer) -> None:
    box: dict[str, Any] = day.run("return document.querySelector('.line svg').getBoundingClientRect().toJSON()")
    middle, high, wide = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, box["width"]
    before, whole = at(day, 0.5), length(day)

    def touch(kind: str, *places: float) -> None:
        points = [{"x": x, "y": high, "id": number} for number, x in enumerate(places)]
        day.command("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", middle - wide / 8, middle + wide / 8)
    for part in (7, 6, 5, 4):
        touch("touchMove", middle - wide / part, middle + wide / part)
    touch("touchEnd")
    until(lambda: length(day) == pytest.approx(whole / 2, rel=0.1), HANG)
    assert at(day, 0.5) == pytest.approx(before, abs=whole / 20)
    begin, _ = window(day)
    moment = day.run(MOMENT)
    drag = ActionChains(day.driver).move_to_element(day.all(".line svg")[0]).click_and_hold()
    drag.move_by_offset(-100, 0).move_by_offset(-100, 0).release().perform()
    until(lambda: window(day)[0] > begin, HANG)
    assert length(day) == pytest.approx(whole / 2, rel=0.1)
    assert day.run(MOMENT) == pytest.approx(moment, abs=whole / 2)


def test_the_keyboard_zooms_and_goes_beyond_the_window(day: Viewer) -> None:
    whole = window(day)
    day.run(f"document.querySelector('{SLIDER}').focus()")
    day.type("+")
    until(lambda: length(day) < whole[1] - whole[0], HANG)
    for _ in range(10):
        day.type("+")
    until(lambda: length(day) <= 32_000, HANG)
    begin, _ = window(day)
    day.type(Keys.HOME, Keys.ARROW_LEFT)
    until(lambda: window(day)[0] < begin, HANG)
    assert day.run(MOMENT) < begin + 1000
    day.type("-")
    until(lambda: length(day) == pytest.approx(60_000, abs=3000), HANG)
    day.type("0")
    until(lambda: window(day) == whole, HANG)


def test_go_to_a_time_moves_the_window(day: Viewer) -> None:
    whole = window(day)
    for _ in range(6):
        day.click(".zoom-in")
    until(lambda: length(day) < (whole[1] - whole[0]) / 40, HANG)
    long, (begin, end) = length(day), window(day)
    wanted = whole[0] + 60_000 if begin - whole[0] > 120_000 else whole[1] - 60_000
    text = day.run("return new Date(arguments[0]).toTimeString().slice(0, 5)", wanted)
    day.click(".go-to input")
    day.type(text, Keys.ENTER)
    until(lambda: not begin <= day.run(MOMENT) <= end, HANG)
    until(lambda: window(day)[0] <= day.run(MOMENT) <= window(day)[1], HANG)
    assert length(day) == pytest.approx(long, abs=2000)
