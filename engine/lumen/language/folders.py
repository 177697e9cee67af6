"""The folders of a project that parts of the language are named for."""

KNOWLEDGE_FOLDER = "knowledge"
QUESTIONS_FOLDER = "knowledge/questions"
SAYINGS_FOLDER = "behaviors/sayings"
FUNCTIONS_FOLDER = "functions"
DRIVERS_FOLDER = "drivers"
"""Robots of the project's own, as Python files: no part of its bundle, and read only to run one of them."""
