"""How many questions a language model is asked: in an hour, and by one visitor."""

from collections import deque

HOUR = 3_600.0
"""[s]."""


class Allowance:
    """Counts questions; `hour` and `visitor` are the most that are asked."""

    def __init__(self, hour: int, visitor: int) -> None:
        self.hour, self.visitor = hour, visitor
        self._times: deque[float] = deque()
        self._visit, self._asked = 0, 0

    def refusal(self, visit: int, now: float) -> str:
        """Why another one is not asked at `now` [s], empty where it is; then it is counted."""
        while self._times and self._times[0] <= now - HOUR:
            self._times.popleft()
        if visit != self._visit:
            self._visit, self._asked = visit, 0
        if len(self._times) >= self.hour:
            return f"the language model has reached its limit of {self.hour} questions per hour"
        if self._asked >= self.visitor:
            return f"this visitor has reached the limit of {self.visitor} questions to the language model"
        self._times.append(now)
        self._asked += 1
        return ""
