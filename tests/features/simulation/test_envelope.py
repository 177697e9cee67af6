"""The joints' targets never exceed the joints' limits and speeds, for any command."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.features.simulation.joint_envelope import JointEnvelope
from lumen.language.robots import Body
from lumen.motion.limits import coupled_range

DT = 0.01


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_commands_stay_inside_limits_coupled_limits_and_speeds(body: Body, data: st.DataObject) -> None:
    envelope = JointEnvelope(body)
    names = list(body.joints)
    last = np.array([body.postures["StandZero"][n] for n in names])
    goals = data.draw(st.lists(st.lists(st.floats(-7, 7), min_size=26, max_size=26), min_size=1, max_size=5))
    for goal in goals:
        for _ in range(40):
            command = envelope.step(last, np.array(goal), DT)
            assert (command >= envelope.low - 1e-9).all()
            assert (command <= envelope.high + 1e-9).all()
            assert (np.abs(command - last) <= envelope.speed * DT + 1e-9).all()
            for limit in body.coupled:
                low, high = coupled_range(limit, command[names.index(limit.on)])
                assert low - 1e-9 <= command[names.index(limit.joint)] <= high + 1e-9
            assert command[names.index("RHipYawPitch")] == command[names.index("LHipYawPitch")]
            last = command


def test_a_goal_inside_is_reached(body: Body) -> None:
    envelope = JointEnvelope(body)
    names = list(body.joints)
    command = np.array([body.postures["Stand"][n] for n in names])
    goal = np.array([body.postures["Crouch"][n] for n in names])
    for _ in range(200):
        command = envelope.step(command, goal, DT)
    assert np.abs(command - goal).max() < 2e-3
