"""Replies of a model that llguidance keeps to a grammar, token by token.

Run by the Python of the small model's folder. Standard input is JSON: `model` (a file), `grammar` (in Lark's
notation), `messages`, `seeds` and `max_tokens`; standard output a list of `text` and `finish_reason`, one for
each seed.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import llama_cpp
import llguidance.numpy as masks
import numpy as np
from llguidance import LLMatcher
from llguidance.llamacpp import lltokenizer_from_vocab


class Mask:
    """Leaves only the tokens that the grammar lets through. The first call comes behind the prompt."""

    def __init__(self, matcher: LLMatcher, size: int) -> None:
        self.matcher = matcher
        self.bits = masks.allocate_token_bitmask(1, size)
        self.is_behind_prompt = True

    def __call__(self, tokens: np.ndarray, scores: np.ndarray) -> np.ndarray:
        if not self.is_behind_prompt and not self.matcher.consume_token(int(tokens[-1])):
            raise ValueError(self.matcher.get_error())
        self.is_behind_prompt = False
        masks.fill_next_token_bitmask(self.matcher, self.bits)
        allowed = np.unpackbits(self.bits[0].view(np.uint8), bitorder="little")[: len(scores)]
        return np.where(allowed, scores, -np.inf).astype(scores.dtype)


def main() -> None:
    asked: dict[str, Any] = json.load(sys.stdin)
    model = llama_cpp.Llama(asked["model"], n_ctx=2048, n_threads=1, n_threads_batch=1, verbose=False)
    tokenizer = lltokenizer_from_vocab(model._model.vocab)
    matcher = LLMatcher(tokenizer, asked["grammar"])
    replies = []
    for seed in asked["seeds"]:
        done: Any = model.create_chat_completion(
            asked["messages"],
            seed=seed,
            temperature=1.0,
            max_tokens=asked["max_tokens"],
            logits_processor=llama_cpp.LogitsProcessorList([Mask(matcher.deep_copy(), model.n_vocab())]),
        )
        choice = done["choices"][0]
        replies.append({"text": choice["message"]["content"], "finish_reason": choice["finish_reason"]})
    json.dump(replies, sys.stdout)


main()
