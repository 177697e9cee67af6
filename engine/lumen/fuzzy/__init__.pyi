from lumen.fuzzy.evaluator import Evaluator as Evaluator
from lumen.fuzzy.explanation import Explanation as Explanation
from lumen.standalone.controller import Controller as Controller

__all__ = ["Controller", "Evaluator", "Explanation"]
