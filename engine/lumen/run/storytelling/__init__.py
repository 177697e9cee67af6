"""A recorded visit as a story: what somebody did, played anew, and what the robot did then is what has to happen."""
