"""Hazards that keep any robot from walking."""

from lumen.robot.hazards import STOP_BUTTONS, danger


def test_nothing_is_in_the_way() -> None:
    assert danger({}, ()) == ""
    assert danger(dict.fromkeys(STOP_BUTTONS, False), (0.4, 2.55)) == ""


def test_the_nearest_thing_is_reported() -> None:
    assert danger({}, (2.55, 0.31)) == "something is 0.31 m ahead, nearer than 0.4 m"


def test_each_button_forbids_a_step() -> None:
    assert [danger({sensor: True}, ()) for sensor in STOP_BUTTONS] == [f"{n} is pressed" for n in STOP_BUTTONS.values()]
    assert danger({"FrontTactil": True}, ()) == ""
