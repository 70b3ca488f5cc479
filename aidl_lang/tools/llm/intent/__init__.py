"""The intents of a conversation: what got lost is noticed, named, and put back if it fits."""

from aidl_lang.tools.llm.intent.inventory import Kind
from aidl_lang.tools.llm.intent.ledger import Ledger, Restored, request
from aidl_lang.tools.llm.intent.loss import Loss

__all__ = ["Kind", "Ledger", "Loss", "Restored", "request"]
