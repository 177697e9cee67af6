"""The module `answers`: a strictly limited language model for questions that no passage answers.

answers.py        receives questions, limits their number, makes the prompt, publishes the permitted sentences
model_settings.py the module's settings in lumen.yaml
http_stream.py    a POST with a streamed response, limited in size and time
chat.py           reads chat completions, streamed or whole
sentence_check.py decides which sentences are permitted
embeddings.py     finds the passages nearest in meaning to a question; vectors from a package
meaning.py        features of passages by vectors
vectors.py        the interface of vector sources: embeddings.py, server_vectors.py, folder_vectors.py
"""

from lumen.features.answers.answers import Answers

__all__ = ["Answers"]
