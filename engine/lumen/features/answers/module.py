"""The module `answers`: a language model on a short leash, asked where no passage answers.

answers.py        questions come in, sentences that may be said go out
model_settings.py what lumen.yaml says of the model
http_stream.py    a POST and what comes back, bounded in bytes and time
chat.py           the pieces of a chat completion, streamed or whole
prompt.py         what the model is told: passages and visitors' words are data
sentence_check.py which sentences may be said
embeddings.py     which passage means what was asked
meaning.py        features of passages by vectors
vectors.py        the seam of what makes vectors: server_vectors.py, packaged_vectors.py, folder_vectors.py
allowance.py      how many questions it is asked
"""

from lumen.features.answers.answers import Answers

__all__ = ["Answers"]
