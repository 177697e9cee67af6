"""The module `answers`: a strictly limited language model, for questions that no passage answers.

answers.py        receives questions, limits their number, makes the prompt, publishes the sentences that may be said
model_settings.py the model's settings in lumen.yaml
http_stream.py    a POST with a streamed answer, bounded in bytes and time
chat.py           the pieces of a chat completion, streamed or whole
sentence_check.py decides which sentences may be said
embeddings.py     finds the passage with the meaning of a question; vectors of a package
meaning.py        features of passages by vectors
vectors.py        the interface of sources of vectors: embeddings.py, server_vectors.py, folder_vectors.py
"""

from lumen.features.answers.answers import Answers

__all__ = ["Answers"]
