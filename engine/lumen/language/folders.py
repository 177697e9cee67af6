"""The folders of a project that parts of the language are named for."""

KNOWLEDGE_FOLDER = "knowledge"
QUESTIONS_FOLDER = "knowledge/questions"
SAYINGS_FOLDER = "behaviors/sayings"
FUNCTIONS_FOLDER = "functions"
