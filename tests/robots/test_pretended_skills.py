"""A robot with physics performs skills as a story says, without their code."""

import pytest

from lumen.errors import RobotFailedError
from lumen.feature import VerbRow
from lumen.language.commands import Do
from lumen.robot.skill_runner import SkillRunner

FOG = VerbRow("", result={"properties": {"litres": {"default": 0.1}, "left": {"default": 2}}}, takes="3s")
COMMAND = Do("fog", {}, row=FOG)


def test_a_pretended_skill_takes_its_time_and_returns_what_the_story_says() -> None:
    runner = SkillRunner()
    runner.set_ends({"fog": {"litres": 0.5}})
    call = runner.begin(COMMAND, 1.0)
    assert [call.advance(3.9), call.advance(4.0)] == [False, True]
    assert call.result == {"litres": 0.5, "left": 2}
    runner.set_ends({"fog": "hangs"})
    hanging = runner.begin(COMMAND, 1.0)
    assert not hanging.advance(1000.0)
    hanging.cancel()
    assert hanging.advance(1000.0)
    runner.set_ends({"fog": "fails"})
    with pytest.raises(RobotFailedError, match="fog fails in this story"):
        runner.begin(COMMAND, 1.0)
    runner.close()
