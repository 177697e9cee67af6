"""Sentences of visitors: folding of words, patterns, finding of phrases, and the rows of `hears`."""
