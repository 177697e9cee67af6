from lumen.fuzzy import Controller as Controller
from lumen.interpreters.inference.evaluator import Evaluator as Evaluator
from lumen.interpreters.inference.explanation import Explanation as Explanation

__all__ = ["Controller", "Evaluator", "Explanation"]
