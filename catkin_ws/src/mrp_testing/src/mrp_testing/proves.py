# SPDX-License-Identifier: BSD-3-Clause
"""A test quotes what it proves: a sentence of a page, word for word."""


def proves(*_sentences):
    """Mark a test as the proof of sentences of the pages, which it quotes.

    It changes nothing about the test. The build of the pages reads the quotes, and fails where a
    sentence and its quote differ.
    """
    return lambda test: test
