"""The shipped project and the names of the tour's states."""

GUIDE = (
    "idle", "greet", "ask_name", "how_are_you", "fine", "not_fine", "not_understood", "offer", "explain", "dance",
    "sing", "any_question", "answer", "photo", "goodbye",
)  # fmt: skip
SAFETY = ("fallen", "helpless", "stopped", "resting", "waking", "battery_low", "motors_hot", "brain_lost", "robot_lost")
